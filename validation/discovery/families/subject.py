"""A person who differs from a model, and what may be hidden in the person or in the records; read by make_sets.py.

Standard deviations of the logarithm, of every muscle: maximum isometric force 12 %, optimal fibre length 3 %, tendon slack length 1 %; beyond 2.5 deviations
drawn again.
"""
import math
import xml.etree.ElementTree as ET

TOLERANCES = {"max_isometric_force": 0.12, "optimal_fiber_length": 0.03, "tendon_slack_length": 0.01}


def within(draw, deviation):
    while True:
        z = draw.gauss(0, 1)
        if abs(z) <= 2.5:
            return math.exp(deviation * z)


class Subject:
    """A model's elements, to be changed and written."""

    def __init__(self, path):
        self.tree = ET.parse(path)
        self.root = self.tree.getroot()

    def scale(self, name, what, factor):
        """A number of a muscle."""
        number = next(e for e in self.root.iter() if e.get("name") == name and e.find(what) is not None).find(what)
        number.text = repr(float(number.text) * factor)

    def depart(self, draw, muscles):
        for name in muscles:
            for what, deviation in TOLERANCES.items():
                self.scale(name, what, within(draw, deviation))

    def push(self, kind, coordinate, **numbers):
        """A force on a coordinate."""
        forces = self.root.find(".//ForceSet/objects")
        force = ET.SubElement(forces, kind, name=f"hidden{len(forces)}")
        ET.SubElement(force, "coordinate").text = coordinate
        for name, value in numbers.items():
            ET.SubElement(force, name).text = str(value)

    def formula(self, coordinate, text):
        self.push("ExpressionBasedCoordinateForce", coordinate, expression=text)

    def load(self, body, mass, place):
        """A point mass at a place [m] of a body; place None: at the mass centre of the body. The inertia is about the mass centre."""
        element = next(e for e in self.root.iter("Body") if e.get("name") == body)
        own = float(element.findtext("mass"))
        centre = [float(x) for x in element.findtext("mass_center").split()]
        place = centre if place is None else place
        away = [p - c for p, c in zip(place, centre)]
        reduced, square = own * mass / (own + mass), sum(a * a for a in away)
        inertia = [float(x) for x in element.findtext("inertia").split()]
        pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
        inertia = [x + reduced * ((square if i == j else 0) - away[i] * away[j]) for x, (i, j) in zip(inertia, pairs)]
        element.find("mass").text = repr(own + mass)
        element.find("mass_center").text = " ".join(repr(c + mass / (own + mass) * a) for c, a in zip(centre, away))
        element.find("inertia").text = " ".join(map(repr, inertia))

    def tilt(self, angle):
        """Gravity turned about the ground's z by an angle [rad]."""
        gravity = self.root.find(".//gravity")
        x, y, z = (float(word) for word in gravity.text.split())
        gravity.text = f"{x * math.cos(angle) - y * math.sin(angle)!r} {x * math.sin(angle) + y * math.cos(angle)!r} {z!r}"

    def write(self, path):
        self.tree.write(path, encoding="UTF-8", xml_declaration=True)


class Hidden:
    """One thing that is hidden: what a label says of it, how it changes the subject, what muscles receive and what is recorded.

    like: ids that are left out of the catalogue together with it, since they make nearly the same."""

    def __init__(self, kind, amplitude=0.0, unit="", readings=(), equivalents=(), like=(), subject=None, delay=0.0, swapped=(), recorded=None):
        self.label = {"id": kind, "amplitude": amplitude, "unit": unit, "equivalents": list(equivalents),
                      "readings": [{"name": name, "value": value} for name, value in readings]}
        self.subject = subject or (lambda person: None)
        self.delay, self.swapped, self.recorded, self.like = delay, swapped, recorded or {}, list(like)


def either_way(draw, lowest, highest):
    return draw.choice((-1, 1)) * draw.uniform(lowest, highest)


def of_coordinate(world, coordinate, kind, draw):
    """What belongs to one joint. World.size tells how a torque compares with one of an elbow."""
    size = world.size[coordinate]
    of = f"{coordinate}." if len(world.coordinates) > 1 else ""
    if kind == "visc":
        b = size * draw.uniform(0.15, 0.6)
        return Hidden(of + kind, b, "N m s", [("viscosity", b)], like=[of + "powerdamp"],
                      subject=lambda person: person.push("SpringGeneralizedForce", coordinate, stiffness=0, rest_length=0, viscosity=b))
    if kind == "coulomb":
        tau = size * draw.uniform(0.3, 1)
        return Hidden(of + kind, tau, "N m", [("torque", tau)], like=[of + "stribeck"],
                      subject=lambda person: person.formula(coordinate, f"-{tau!r}*tanh(qdot/0.05)"))
    if kind == "stiffness":
        k, low, high = size * draw.uniform(0.5, 2), *world.coordinates[coordinate]
        rest = math.radians(draw.uniform(low, high))
        return Hidden(of + kind, k, "N m", [("stiffness", k)],
                      subject=lambda person: person.push("SpringGeneralizedForce", coordinate, stiffness=k, rest_length=rest, viscosity=0))
    if kind == "bias":
        b = either_way(draw, 3, 8)
        return Hidden(of + kind, math.radians(b), "rad", [("value", math.radians(b))], recorded={coordinate: lambda q: q + b})
    raise ValueError(kind)


def of_model(world, kind, draw):
    """What belongs to the limb, a muscle or its electrode."""
    if kind == "payload":
        mass = world.heavy * draw.uniform(0.2, 0.7)
        return Hidden(kind, mass, "kg", [("mass", mass)], ["mass"], subject=lambda person: person.load(world.tip, mass, None))
    if kind == "delay":
        delay = draw.uniform(0.03, 0.08)
        return Hidden(kind, delay, "s", [("time", delay)], ["clock"] if len(world.coordinates) == 1 else [],
                      [f"{q}.clock" for q in world.coordinates], delay=delay)
    if kind == "tilt":
        angle = either_way(draw, 0.1, 0.25)
        return Hidden(kind, angle, "rad", [], ["handforce"], subject=lambda person: person.tilt(angle))
    if kind == "swap":
        one, other = draw.choice(world.swaps)
        return Hidden(f"swap_{one}_{other}", 0, "", [], [f"swap_{other}_{one}"], swapped=(one, other))
    if kind == "strength":
        name, heads = draw.choice(list(world.strong.items()))
        factor = math.exp(either_way(draw, 0.4, 0.7))
        return Hidden(f"Fmax_{name}", math.log(factor), "", [("factor", factor)], [f"gain_{name}"],
                      subject=lambda person: [person.scale(head, "max_isometric_force", factor) for head in heads])
    raise ValueError(kind)


OF_MOMENT = ("lever_weight", "lever_inertia", "gain", "moment_bias", "lag")


def of_moment(coordinate, kind, draw):
    """What a dynamometer adds to the moment [N m] that it records: (moment, angle [deg], acceleration [rad/s^2])."""
    if kind == "lever_weight":
        w = draw.uniform(1.5, 5)
        return Hidden(kind, w, "N m", [("torque", w)],
                      recorded={coordinate: lambda m, q, bend: [x + w * math.cos(math.radians(a - 20)) for x, a in zip(m, q)]})
    if kind == "lever_inertia":
        inertia = draw.uniform(0.08, 0.3)
        return Hidden(kind, inertia, "", [("inertia", inertia)], recorded={coordinate: lambda m, q, bend: [x - inertia * b for x, b in zip(m, bend)]})
    if kind == "gain":
        gain = draw.uniform(0.15, 0.3)
        return Hidden(kind, gain, "", [("value", gain)], recorded={coordinate: lambda m, q, bend: [(1 + gain) * x for x in m]})
    if kind == "moment_bias":
        bias = either_way(draw, 1, 2.5)
        return Hidden("bias", bias, "N m", [("value", bias)], like=["const"], recorded={coordinate: lambda m, q, bend: [x + bias for x in m]})
    if kind == "lag":
        lag = draw.uniform(0.03, 0.08)

        def lagging(moment, q, bend):
            shown = moment[:1]
            for m in moment[1:]:
                shown.append(m + (shown[-1] - m) * math.exp(-0.01 / lag))
            return shown
        return Hidden(kind, lag, "s", [("value", lag)], recorded={coordinate: lagging})
    raise ValueError(kind)


def out_of_catalogue(world, draw):
    coordinate = draw.choice(list(world.coordinates))
    size = world.size[coordinate]
    if draw.random() < 0.5:
        a = size * draw.uniform(0.6, 1.2)
        return Hidden(f"{coordinate}.corrugation", a, "N m", subject=lambda person: person.formula(coordinate, f"-{a!r}*sin(6*q)"))
    b = size * draw.uniform(0.2, 0.5)
    return Hidden(f"{coordinate}.angledamping", b, "N m s", subject=lambda person: person.formula(coordinate, f"-{b!r}*q^2*qdot"))
