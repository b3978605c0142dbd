#pragma once

#include "bio/model/model.h"

namespace bio::fixtures {

inline Coordinate coordinate(const std::string& name, double value = 0) {
  Coordinate c;
  c.name = name;
  c.defaultValue = value;
  c.rangeMin = -3;
  c.rangeMax = 3;
  return c;
}

inline Body body(const std::string& name, double mass, const Eigen::Vector3d& center) {
  Body b;
  b.name = name;
  b.mass = mass;
  b.massCenter = center;
  b.inertia = {0.012 * mass, 0.003 * mass, 0.0125 * mass, -3e-4 * mass, 2e-4 * mass, 1e-3 * mass};
  return b;
}

/// Three links with every kind of joint motion: a pin, a custom joint with two coordinates and a
/// spline, a slider, oblique axes, offset frames, and a coordinate coupled to another.
inline Model threeLinkArm() {
  Model m;
  m.name = "three links";
  m.bodies = {body("upper", 2.0, {0.01, -0.14, -0.012}), body("fore", 1.1, {0.03, -0.12, 0.02}),
              body("hand", 0.5, {-0.003, -0.05, 0.001}), body("cap", 0.1, {0.01, 0.02, 0.0})};
  Joint shoulder;
  shoulder.name = "shoulder";
  shoulder.kind = JointKind::pin;
  shoulder.parentBody = "ground";
  shoulder.parentFrame = {{0.1, 0.2, -0.1}, {0.3, -0.2, 0.4}};
  shoulder.childBody = "upper";
  shoulder.childFrame = {{0.01, 0.02, 0.03}, {0.1, 0.2, -0.3}};
  shoulder.coordinates = {coordinate("lift", 0.3)};
  Joint elbow;
  elbow.name = "elbow";
  elbow.kind = JointKind::custom;
  elbow.parentBody = "upper";
  elbow.parentFrame = {{0.006, -0.29, -0.012}, {0, 0.1, 0}};
  elbow.childBody = "fore";
  elbow.coordinates = {coordinate("flex", 0.5), coordinate("turn", -0.2)};
  elbow.axes[0] = {"flex", {0.0494, 0.0366, 0.9981}, Function{1, LinearFunction{1, 0}}};
  elbow.axes[1] = {"turn",
                   {-0.017, 0.99, -0.12},
                   Function{0.9, SplineFunction{{-2, -1, 0, 1.2, 2}, {-1.8, -1.1, 0.1, 1, 2.2}}}};
  elbow.axes[2] = {"", {1, 0, 0}, Function{1, ConstantFunction{0.05}}};
  elbow.axes[3] = {
      "flex", {1, 0, 0}, Function{0.01, SplineFunction{{-2, -1, 0, 1, 2}, {1, 0.5, 0, 0.3, 1}}}};
  elbow.axes[4] = {"", {0, 1, 0}, Function{1, ConstantFunction{0.002}}};
  elbow.axes[5] = {"", {0, 0, 1}, Function{1, ConstantFunction{0}}};
  Joint wrist;
  wrist.name = "wrist";
  wrist.kind = JointKind::slider;
  wrist.parentBody = "fore";
  wrist.parentFrame = {{0.02, -0.24, 0.02}, {0.4, 0, 0.2}};
  wrist.childBody = "hand";
  wrist.coordinates = {coordinate("reach", 0.01)};
  Joint kneecap;
  kneecap.name = "kneecap";
  kneecap.kind = JointKind::pin;
  kneecap.parentBody = "upper";
  kneecap.parentFrame = {{0.0, -0.25, 0.03}, {0, 0, 0}};
  kneecap.childBody = "cap";
  kneecap.coordinates = {coordinate("follow", 0.9)};
  m.joints = {wrist, shoulder, elbow, kneecap};  // children before parents on purpose
  m.couplers = {{"cap_follows", "flex", "follow",
                 Function{1, SplineFunction{{-2, 0, 1, 2}, {-1, 0, 0.8, 1.1}}}}};
  return m;
}

}  // namespace bio::fixtures
