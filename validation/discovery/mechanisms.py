"""Machines without muscles for the scripts of validation: their models, their motions, and what discover says of them."""
import dataclasses
import json
import subprocess

GRAVITY = 9.81  # [m/s^2]


@dataclasses.dataclass
class Link:
    """A body that turns about z, or slides along x."""
    coordinate: str
    body: str
    mass: float  # [kg]
    centre: float  # of mass, below its joint [m]
    inertia: float = 0  # about that [kg m^2]
    length: float = 0  # to the next joint [m]
    damper: str = ""  # its name; empty: none
    viscosity: float = 0


def osim(name, links, slides=False, limit=6.3, gravity=GRAVITY):
    """A model of a chain that hangs from the ground, coordinates within ±limit."""
    kind = "SliderJoint" if slides else "PinJoint"
    bodies = joints = forces = ""
    parent, offset = "/ground", 0
    for link in links:
        bodies += (f'<Body name="{link.body}"><mass>{link.mass!r}</mass><mass_center>0 {-link.centre!r} 0</mass_center>'
                   f'<inertia>{link.inertia!r} {link.inertia!r} {link.inertia!r} 0 0 0</inertia></Body>\n')
        joints += (f'<{kind} name="{link.coordinate}_joint"><socket_parent_frame>end</socket_parent_frame><socket_child_frame>/bodyset/{link.body}</socket_child_frame>'
                   f'<frames><PhysicalOffsetFrame name="end"><socket_parent>{parent}</socket_parent><translation>0 {-offset!r} 0</translation></PhysicalOffsetFrame></frames>'
                   f'<coordinates><Coordinate name="{link.coordinate}"><default_value>0</default_value><range>{-limit!r} {limit!r}</range></Coordinate></coordinates></{kind}>\n')
        if link.damper:
            forces += (f'<SpringGeneralizedForce name="{link.damper}"><coordinate>{link.coordinate}</coordinate><stiffness>0</stiffness><rest_length>0</rest_length>'
                       f'<viscosity>{link.viscosity!r}</viscosity></SpringGeneralizedForce>\n')
        parent, offset = f"/bodyset/{link.body}", link.length
    return (f'<?xml version="1.0" encoding="UTF-8"?>\n<OpenSimDocument Version="40000"><Model name="{name}"><gravity>0 {-gravity!r} 0</gravity>\n'
            f'<BodySet><objects>\n{bodies}</objects></BodySet>\n<JointSet><objects>\n{joints}</objects></JointSet>\n<ForceSet><objects>\n{forces}</objects></ForceSet>\n'
            '</Model></OpenSimDocument>\n')


def rk4(slope, t, y, h):
    """y at t + h, of y' = slope(t, y)."""
    k1 = slope(t, y)
    k2 = slope(t + h / 2, [a + h / 2 * b for a, b in zip(y, k1)])
    k3 = slope(t + h / 2, [a + h / 2 * b for a, b in zip(y, k2)])
    k4 = slope(t + h, [a + h * b for a, b in zip(y, k3)])
    return [a + h / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in zip(y, k1, k2, k3, k4)]


def verdict(program, folder, *further, model="model.osim"):
    """Of a model on t0.csv, t1.csv and, held out, t2.csv, in steps of 5 ms, by one thread."""
    command = [program, "discover", model, "t0.csv", "t1.csv", "--hold-out", "t2.csv", *further, "--step", "0.005", "--threads", "1", "--out", "out", "--force"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{folder}: {done.stderr.strip()}")
    return json.loads((folder / "out/verdict.json").read_text())
