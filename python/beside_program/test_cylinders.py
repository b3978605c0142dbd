"""Model.with_cylinders against the program's --wrap-as-cylinder, on the shipped model with ellipsoids instead."""

import math
import os
import tempfile
import unittest

import numpy as np

import fisherhill as fh

from beside_program.as_the_program import ELBOW, SLOW, AsTheProgram

NAMES = ["TRI", "BIC_BRD"]
ANGLES = np.linspace(0.1, 2.2, 40)


def with_ellipsoid(text, name, semi_axes, rotation=None, quadrant=None):
    """The text of a model with an ellipsoid instead of that cylinder."""
    before, rest = text.split(f'<WrapCylinder name="{name}">')
    cylinder, after = rest.split("</WrapCylinder>", 1)
    lines = [line for line in cylinder.splitlines() if "<radius>" not in line and "<length>" not in line]
    for k, line in enumerate(lines):
        if rotation and "xyz_body_rotation" in line:
            lines[k] = f"<xyz_body_rotation>{rotation}</xyz_body_rotation>"
        if quadrant and "<quadrant>" in line:
            lines[k] = f"<quadrant>{quadrant}</quadrant>"
    lines.append(f"<dimensions>{semi_axes}</dimensions>")
    return f'{before}<WrapEllipsoid name="{name}">{chr(10).join(lines)}</WrapEllipsoid>{after}'


def rotated(axis):
    """Angles of TRI's frame, turned so that this axis lies where the cylinder's z does."""
    a, b, c = -0.14015, -0.00628319, 0.154985
    x = np.array([[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]])
    y = np.array([[math.cos(b), 0, math.sin(b)], [0, 1, 0], [-math.sin(b), 0, math.cos(b)]])
    z = np.array([[math.cos(c), -math.sin(c), 0], [math.sin(c), math.cos(c), 0], [0, 0, 1]])
    change = np.zeros((3, 3))
    for k in range(3):
        change[k, (axis + 1 + k) % 3] = 1
    r = x @ y @ z @ change
    angles = math.atan2(-r[1, 2], r[2, 2]), math.asin(r[0, 2]), math.atan2(-r[0, 1], r[0, 0])
    return " ".join(f"{angle:.17g}" for angle in angles)


class Cylinders(AsTheProgram):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def ellipsoids(self, *changes):
        """File and model."""
        with open(ELBOW, encoding="utf-8") as file:
            text = file.read()
        for change in changes:
            text = with_ellipsoid(text, *change)
        file = os.path.join(self.folder, "ellipsoids.osim")
        with open(file, "w", encoding="utf-8") as out:
            out.write(text)
        return file, fh.load_model(file)

    def test_lengths_are_those_of_the_option_whichever_axis_is_the_odd_one(self):
        # the last stands at the singularity of the angles once its axes are changed
        for semi_axes, rotation, quadrant in (("0.016 0.016 0.05", None, None), ("0.05 0.016 0.016", rotated(0), "-y"),
                                              ("0.016 0.05 0.016", rotated(1), "-z"), ("0.05 0.016 0.016", rotated(0), None),
                                              ("0.05 0.016 0.016", "0 0 0", "all")):
            _, model = self.ellipsoids(("TRI", semi_axes, rotation, quadrant), ("BIC_BRD", "0.015 0.015 0.1"))
            asked = fh.moment_arms(model, {"elbow_flexion": ANGLES}, wrap_as_cylinder=NAMES)
            found = fh.moment_arms(model.with_cylinders(NAMES), {"elbow_flexion": ANGLES})
            if rotation != "0 0 0":
                self.assertIn("TRI", sum(asked.touched["TRIlong"], []), semi_axes)
            self.assertEqual(found.touched, asked.touched)
            np.testing.assert_allclose(found.length, asked.length, rtol=0, atol=1e-15, err_msg=semi_axes)
            np.testing.assert_allclose(found.moment_arm["elbow_flexion"], asked.moment_arm["elbow_flexion"], rtol=0,
                                       atol=1e-14, err_msg=semi_axes)
            taut = fh.moment_arms(model, {"elbow_flexion": ANGLES})
            self.assertGreater(np.abs(taut.length - found.length).max(), 1e-6)

    def test_motions_and_estimates_are_those_of_the_program(self):
        file, model = self.ellipsoids(("TRI", "0.016 0.016 0.05"), ("BIC_BRD", "0.015 0.015 0.1"))
        trial = fh.load_trial(SLOW, model)
        cylinders = model.with_cylinders(NAMES)
        self.assertEqual(cylinders.remarks[len(model.remarks):],
                         [f"wrap object '{name}' is a cylinder in place of its ellipsoid, as asked" for name in NAMES])
        option = ("--wrap-as-cylinder", ",".join(NAMES))
        _, out = self.run_program("replay", file, SLOW, *option)
        with open(out / "states.sto", encoding="utf-8") as table:
            lines = table.read().split("endheader\n")[1].splitlines()
        column = lines[0].split("\t").index("/jointset/elbow/elbow_flexion/value")
        its = np.array([float(line.split("\t")[column]) for line in lines[1:]])
        np.testing.assert_allclose(fh.replay(cylinders, trial).q[:, 0], its, rtol=1e-12)
        self.assertGreater(np.abs(fh.replay(model, trial).q[:, 0] - its).max(), 1e-4)

        names = ["TRI.radius", "TRI.rotation.x", "hand.mass"]
        summary, _ = self.run_program("calibrate", file, SLOW, "--parameters", ",".join(names), "--step", "0.01", *option)
        found = fh.calibrate(cylinders, [trial], names, step=0.01)
        self.assertEqual(list(found.estimates), list(summary["estimates"]))
        for name, told in summary["estimates"].items():
            np.testing.assert_array_equal([found.estimates[name].value, found.estimates[name].sd],
                                          [told["value"], math.nan if told["sd"] is None else told["sd"]], name)
        summary, _ = self.run_program("sensitivity", file, SLOW, "--parameters", "*.radius,BRA.*", *option)
        told = {one["name"]: one["bound_joint"] for one in summary["parameters"]}
        found = fh.sensitivity(cylinders, [trial], ["*.radius", "BRA.*"])
        self.assertEqual(dict(zip(found.names, found.bound_joint)), told)

    def test_a_written_model_has_the_cylinders(self):
        _, model = self.ellipsoids(("TRI", "0.05 0.016 0.016", "0 0 0"))
        before = fh.moment_arms(model, {"elbow_flexion": ANGLES}).length
        cylinders = model.with_cylinders(["TRI"])
        file = os.path.join(self.folder, "cylinders.osim")
        cylinders.write(file)
        again, found = (fh.moment_arms(one, {"elbow_flexion": ANGLES}) for one in (fh.load_model(file), cylinders))
        np.testing.assert_array_equal(again.length, found.length)
        np.testing.assert_array_equal(fh.moment_arms(model, {"elbow_flexion": ANGLES}).length, before)  # as it was
        self.assertGreater(np.abs(found.length - before).max(), 1e-6)

    def test_what_cannot_be_a_cylinder_is_refused_as_the_program_does(self):
        _, model = self.ellipsoids(("TRI", "0.016 0.02 0.05"))
        for name in ("TRI", "ball"):
            lines = []
            for call in (lambda: model.with_cylinders([name]),
                         lambda: fh.moment_arms(model, {"elbow_flexion": [1.0]}, wrap_as_cylinder=[name])):
                with self.assertRaises(ValueError) as raised:
                    call()
                lines.append(str(raised.exception))
            self.assertEqual(lines[0], lines[1])
        cylinder = model.with_cylinders(["BIC_BRD"])  # is one
        self.assertEqual(cylinder.remarks, model.remarks)


del AsTheProgram  # has no tests of its own

if __name__ == "__main__":
    unittest.main()
