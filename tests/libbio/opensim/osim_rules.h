#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "bio/opensim/osim_file.h"
#include "bio/tables/file_error.h"
#include "support/scratch_folder.h"

/// A small model as text, to be spoiled in one place and read.
namespace osim_rules {

using bio::FileError;
using bio::Model;
using bio::readOsim;

/// A hinge with one muscle, everything that the rules are about in as few lines as possible.
inline const std::string valid = R"(<?xml version="1.0" encoding="UTF-8"?>
<OpenSimDocument Version="40000">
<Model name="hinge">
<gravity>0 -9.81 0</gravity>
<BodySet name="bodyset"><objects>
<Body name="upper"><mass>2</mass><mass_center>0 -0.1 0</mass_center><inertia>0.1 0.1 0.1 0 0 0</inertia>
<WrapObjectSet name="wrapobjectset"><objects>
<WrapCylinder name="roll"><translation>0 -0.3 0</translation><quadrant>x</quadrant><radius>0.02</radius><length>0.1</length></WrapCylinder>
<WrapEllipsoid name="egg"><dimensions>0.02 0.03 0.04</dimensions></WrapEllipsoid>
</objects></WrapObjectSet></Body>
<Body name="lower"><mass>1</mass></Body>
</objects></BodySet>
<JointSet name="jointset"><objects>
<WeldJoint name="base"><socket_parent_frame>/ground</socket_parent_frame><socket_child_frame>/bodyset/upper</socket_child_frame></WeldJoint>
<CustomJoint name="elbow"><socket_parent_frame>upper_offset</socket_parent_frame><socket_child_frame>/bodyset/lower</socket_child_frame>
<coordinates><Coordinate name="q"><default_value>0.5</default_value><range>0 2</range></Coordinate></coordinates>
<frames><PhysicalOffsetFrame name="upper_offset"><socket_parent>/bodyset/upper</socket_parent><translation>0 -0.3 0</translation></PhysicalOffsetFrame></frames>
<SpatialTransform><TransformAxis name="rotation1"><coordinates>q</coordinates><axis>0 0 1</axis><LinearFunction name="function"><coefficients>1 0</coefficients></LinearFunction></TransformAxis></SpatialTransform>
</CustomJoint>
</objects></JointSet>
<ForceSet name="forceset"><objects>
<Schutte1993Muscle_Deprecated name="flexor">
<GeometryPath name="path"><PathPointSet><objects>
<PathPoint name="a"><socket_parent_frame>/bodyset/upper</socket_parent_frame><location>0.01 0 0</location></PathPoint>
<ConditionalPathPoint name="b"><socket_parent_frame>/bodyset/upper</socket_parent_frame><location>0.02 -0.2 0</location><socket_coordinate>/jointset/elbow/q</socket_coordinate><range>0 1</range></ConditionalPathPoint>
<PathPoint name="c"><socket_parent_frame>/bodyset/lower</socket_parent_frame><location>0.01 -0.1 0</location></PathPoint>
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
<ConstraintSet name="constraintset"><objects></objects></ConstraintSet>
</Model>
</OpenSimDocument>
)";

inline std::string replaced(std::string text, const std::string& old, const std::string& with) {
  const auto at = text.find(old);
  if (at == std::string::npos) throw std::logic_error("the model does not hold: " + old);
  return text.replace(at, old.size(), with);
}

class OsimRules : public testing::Test {
 protected:
  Model read(const std::string& text) const { return readOsim(folder_.file("m.osim", text)); }

  // The line that the reader complains with, without the folder.
  std::string messageOf(const std::string& text) const {
    try {
      read(text);
    } catch (const FileError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      return what.substr(folder_.path().string().size() + 1);
    }
    return "read without complaint";
  }
  std::string messageAfter(const std::string& old, const std::string& with) const {
    return messageOf(replaced(valid, old, with));
  }
  // What is said of a model that is read nevertheless.
  std::vector<std::string> warningsAfter(const std::string& old, const std::string& with) const {
    return read(replaced(valid, old, with)).warnings;
  }
  support::ScratchFolder folder_;
};

}  // namespace osim_rules
