#pragma once

#include <string>

namespace osim_rules {

/// The hinge of tests/fuzz/seeds/osim/hinge4 as OpenSim 3 would say it: joints nested in their
/// child bodies, bodies and coordinates by name, a joint's place in its parent as
/// location_in_parent.
inline const std::string hingeOfOpenSim3 = R"(<?xml version="1.0" encoding="UTF-8"?>
<OpenSimDocument Version="30000">
<Model name="hinge">
<!-- a note that stays -->
<gravity>0 -9.81 0</gravity>
<BodySet><objects>
<Body name="ground"><mass>0</mass></Body>
<Body name="upper"><mass>2</mass><mass_center>0 -0.1 0</mass_center>
<inertia_xx>0.1</inertia_xx><inertia_yy>0.1</inertia_yy><inertia_zz>0.1</inertia_zz><inertia_xy>0</inertia_xy><inertia_xz>0</inertia_xz><inertia_yz>0</inertia_yz>
<Joint><WeldJoint name="base"><parent_body>ground</parent_body></WeldJoint></Joint>
<VisibleObject name=""><scale_factors>1 1 1</scale_factors></VisibleObject>
<WrapObjectSet><objects>
<WrapCylinder name="roll"><translation>0 -0.3 0</translation><quadrant>x</quadrant><radius>0.02</radius><length>0.1</length></WrapCylinder>
<WrapEllipsoid name="egg"><dimensions>0.02 0.03 0.04</dimensions></WrapEllipsoid>
</objects></WrapObjectSet></Body>
<Body name="lower"><mass>1</mass>
<Joint><CustomJoint name="elbow"><parent_body>upper</parent_body><location_in_parent>0 -0.3 0</location_in_parent>
<CoordinateSet><objects><Coordinate name="q"><default_value>0.5</default_value><range>0 2</range></Coordinate></objects></CoordinateSet>
<SpatialTransform><TransformAxis name="rotation1"><coordinates>q</coordinates><axis>0 0 1</axis><function><LinearFunction><coefficients>1 0</coefficients></LinearFunction></function></TransformAxis></SpatialTransform>
</CustomJoint></Joint></Body>
</objects></BodySet>
<ConstraintSet><objects/></ConstraintSet>
<ForceSet><objects>
<Schutte1993Muscle_Deprecated name="flexor">
<GeometryPath><PathPointSet><objects>
<PathPoint name="a"><location>0.01 0 0</location><body>upper</body></PathPoint>
<ConditionalPathPoint name="b"><location>0.02 -0.2 0</location><body>upper</body><range>0 1</range><coordinate>q</coordinate></ConditionalPathPoint>
<PathPoint name="c"><location>0.01 -0.1 0</location><body>lower</body></PathPoint>
</objects></PathPointSet>
<PathWrapSet><objects><PathWrap name="w"><wrap_object>roll</wrap_object><range>2 3</range></PathWrap></objects></PathWrapSet></GeometryPath>
<max_isometric_force>500</max_isometric_force><optimal_fiber_length>0.1</optimal_fiber_length><tendon_slack_length>0.2</tendon_slack_length><pennation_angle_at_optimal>0.1</pennation_angle_at_optimal>
<time_scale>0.1</time_scale><activation1>7.667</activation1><activation2>1.459854</activation2><damping>0.017</damping>
<SimmSpline name="active_force_length_curve"><x>0 0.5 1 1.5 2</x><y>0 0.3 1 0.3 0</y></SimmSpline>
</Schutte1993Muscle_Deprecated>
<CoordinateLimitForce name="stop"><coordinate>q</coordinate><upper_limit>90</upper_limit><lower_limit>-10</lower_limit><upper_stiffness>1</upper_stiffness><lower_stiffness>1</lower_stiffness><transition>5</transition></CoordinateLimitForce>
<SpringGeneralizedForce name="spring"><coordinate>q</coordinate><viscosity>0.1</viscosity></SpringGeneralizedForce>
<ExpressionBasedCoordinateForce name="push"><coordinate>q</coordinate><expression>-q</expression></ExpressionBasedCoordinateForce>
</objects></ForceSet>
</Model>
</OpenSimDocument>
)";

}  // namespace osim_rules
