"""Small models of every class of joint and of muscle, as OpenSim 4 writes them: a link that one muscle moves."""

import re

INERTIA = "<mass>1</mass><mass_center>0 -0.15 0</mass_center><inertia>0.02 0.01 0.02 0 0 0</inertia>"
JOINTS = {  # class: names of its coordinates, what else it holds
    "PinJoint": (["rz"], ""),
    "SliderJoint": (["tx"], ""),
    "UniversalJoint": (["ux", "uy"], ""),
    "BallJoint": (["bx", "by", "bz"], ""),
    "GimbalJoint": (["gx", "gy", "gz"], ""),
    "PlanarJoint": (["pz", "px", "py"], ""),
    "FreeJoint": (["rx", "ry", "rz", "tx", "ty", "tz"], ""),
    "EllipsoidJoint": (["ex", "ey", "ez"], "<radii_x_y_z>0.05 0.08 0.06</radii_x_y_z>"),
    "ScapulothoracicJoint": (["abduction", "elevation", "upward", "winging"],
                             "<thoracic_ellipsoid_radii_x_y_z>0.07 0.15 0.07</thoracic_ellipsoid_radii_x_y_z>"
                             "<scapula_winging_axis_origin>0 0</scapula_winging_axis_origin>"
                             "<scapula_winging_axis_direction>0</scapula_winging_axis_direction>"),
    "CustomJoint": (["q"], "<SpatialTransform><TransformAxis name='rotation1'><coordinates>q</coordinates><axis>0 0 1</axis>"
                           "<LinearFunction name='function'><coefficients>1 0</coefficients></LinearFunction></TransformAxis>"
                           "</SpatialTransform>"),
}
LENGTHS = "<optimal_fiber_length>0.1</optimal_fiber_length><tendon_slack_length>0.1</tendon_slack_length>"
MUSCLES = {  # class: what else it holds
    "Thelen2003Muscle": "",
    "Millard2012EquilibriumMuscle": "",
    "Millard2012EquilibriumMuscle rigid": "<ignore_tendon_compliance>true</ignore_tendon_compliance>",
    "Millard2012AccelerationMuscle": "",
    "DeGrooteFregly2016Muscle": "",
    "DeGrooteFregly2016Muscle rigid": "<ignore_tendon_compliance>true</ignore_tendon_compliance>",
    "RigidTendonMuscle": "",
    "Schutte1993Muscle_Deprecated": "",
    "Delp1990Muscle_Deprecated": "",
    "McKibbenActuator": "",
}
WRAPS = {
    "WrapCylinder": "<radius>0.02</radius><length>0.3</length>",
    "WrapSphere": "<radius>0.02</radius>",
    "WrapEllipsoid": "<dimensions>0.02 0.03 0.04</dimensions>",
    "WrapTorus": "<inner_radius>0.01</inner_radius><outer_radius>0.04</outer_radius>",
}


def frame(name, parent):
    return (f"<PhysicalOffsetFrame name='{name}'><socket_parent>{parent}</socket_parent><translation>0 0 0</translation>"
            "<orientation>0 0 0</orientation></PhysicalOffsetFrame>")


def link(joint, name, parent, child, prefix=""):
    coordinates, more = JOINTS[joint]
    listed = "".join(f"<Coordinate name='{prefix}{c}'><default_value>0.1</default_value><range>-1 1</range></Coordinate>"
                     for c in coordinates)
    for c in coordinates:
        more = more.replace(f"<coordinates>{c}<", f"<coordinates>{prefix}{c}<")
    return (f"<{joint} name='{name}'><socket_parent_frame>{name}_p</socket_parent_frame>"
            f"<socket_child_frame>{name}_c</socket_child_frame><coordinates>{listed}</coordinates>"
            f"<frames>{frame(name + '_p', parent)}{frame(name + '_c', child)}</frames>{more}</{joint}>")


def muscle(kind, name, x, wrap):
    tag = kind.split()[0]
    wrapped = ("<PathWrapSet><objects><PathWrap name='pathwrap'><wrap_object>surface</wrap_object></PathWrap></objects>"
               "</PathWrapSet>" if wrap else "")
    points = "".join(f"<PathPoint name='p{i}'><socket_parent_frame>{body}</socket_parent_frame><location>{x} {y} 0</location>"
                     "</PathPoint>" for i, (body, y) in enumerate([("/ground", 0.1), ("/bodyset/link", -0.1)]))
    return (f"<{tag} name='{name}'><GeometryPath name='path'><PathPointSet><objects>{points}</objects></PathPointSet>{wrapped}"
            f"</GeometryPath><max_isometric_force>100</max_isometric_force>{LENGTHS}{MUSCLES[kind]}</{tag}>")


def model(joint="PinJoint", kind="Thelen2003Muscle", wrap=None, links=1):
    bodies = f"<Body name='link'>{INERTIA}</Body>"
    joints = link(joint, "joint", "/ground", "/bodyset/link")
    if links == 2:
        bodies += f"<Body name='second'>{INERTIA}</Body>"
        joints += link("PinJoint", "next", "/bodyset/link", "/bodyset/second", "second_")
    surface = (f"<{wrap} name='surface'>{WRAPS[wrap]}<translation>0 0 0</translation><xyz_body_rotation>0 0 0</xyz_body_rotation>"
               f"<quadrant>all</quadrant></{wrap}>") if wrap else ""
    ground = f"<Ground name='ground'><WrapObjectSet><objects>{surface}</objects></WrapObjectSet></Ground>"
    muscles = muscle(kind, "front", 0.03, wrap) + muscle(kind, "back", -0.03, None)
    return ("<?xml version='1.0' encoding='UTF-8'?><OpenSimDocument Version='40000'><Model name='small'>" + ground +
            f"<gravity>0 -9.81 0</gravity><BodySet name='bodyset'><objects>{bodies}</objects></BodySet>"
            f"<JointSet name='jointset'><objects>{joints}</objects></JointSet>"
            f"<ForceSet name='forceset'><objects>{muscles}</objects></ForceSet></Model></OpenSimDocument>\n")


def all_models():
    """Names and texts: each joint, each muscle and each surface once, and a chain of two."""
    made = {f"joint_{joint}": model(joint=joint) for joint in JOINTS}
    made.update({"muscle_" + kind.replace(" ", "_"): model(kind=kind) for kind in MUSCLES})
    made.update({f"wrap_{wrap}": model(wrap=wrap) for wrap in WRAPS})
    made["chain_of_two"] = model(links=2)
    made["no_muscles"] = re.sub("<ForceSet.*</ForceSet>", "", model())
    return made
