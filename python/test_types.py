"""mypy --strict finds nothing wrong with the stubs, the tour and the examples of docs/python.md; and finds what is wrong.

Run from the top of the source tree. Without mypy (apt-get install mypy) there is nothing to do.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import fisherhill as fh

PACKAGE = pathlib.Path(fh.__file__).parent
# What the examples of docs/python.md take for granted.
PREAMBLE = """
import numpy as np
import fisherhill
model = fisherhill.load_model("models/elbow8.osim")
trial = fisherhill.load_trial("emg_data/curl_slow.sto", model)
"""


def mypy():
    """The command; Debian's mypy is one of Debian's Python, whichever Python runs this."""
    return shutil.which("mypy", path=f"/usr/bin:{os.environ.get('PATH', '')}")


@unittest.skipUnless(mypy(), "mypy is not installed (apt-get install mypy)")
class Types(unittest.TestCase):
    def said(self, files):
        """What mypy says of {name: text}, beside the package's stubs."""
        with tempfile.TemporaryDirectory() as folder:
            home = pathlib.Path(folder)
            (home / "fisherhill").mkdir()
            for file in (*PACKAGE.glob("*.pyi"), PACKAGE / "py.typed"):
                shutil.copy(file, home / "fisherhill" / file.name)
            (home / "mypy.ini").write_text(
                # what is not there, or has no types, is none of ours
                "[mypy]\nstrict = True\n[mypy-torch.*,jax.*,pandas.*]\nignore_missing_imports = True\nfollow_imports = skip\n",
                encoding="utf-8",
            )
            for name, text in files.items():
                (home / name).write_text(text, encoding="utf-8")
            stubs = [f"fisherhill/{file.name}" for file in sorted(PACKAGE.glob("*.pyi"))]
            done = subprocess.run(
                [mypy(), "--config-file", "mypy.ini", "--python-executable", sys.executable, *stubs, *files],
                cwd=home, capture_output=True, text=True, env={**os.environ, "MYPYPATH": str(home)},
            )
            self.assertEqual(done.stderr, "")
            return done.stdout

    def test_stubs_and_examples_are_right_and_mistakes_are_found(self):
        blocks = re.findall(r"^```python\n(.*?)^```", pathlib.Path("docs/python.md").read_text(encoding="utf-8"), re.M | re.S)
        self.assertGreater(len(blocks), 3)
        right = {f"block_{i}.py": PREAMBLE + text for i, text in enumerate(blocks)}
        right["tour.py"] = pathlib.Path("python/tour.py").read_text(encoding="utf-8")
        wrong = {"wrong.py": PREAMBLE + "fisherhill.replay(model, trial, step='long').q_dotted\nfisherhill.predict(trial, [model])\n"}
        lines = self.said(right | wrong).splitlines()
        self.assertEqual([line for line in lines if not line.startswith(("wrong.py:", "Found "))], [])
        found = [line for line in lines if line.startswith("wrong.py:")]
        for words in ('"step"', "q_dotted", "parameters"):
            self.assertTrue(any(words in line for line in found), (words, found))


if __name__ == "__main__":
    unittest.main()
