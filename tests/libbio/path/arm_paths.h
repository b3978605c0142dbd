#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "bio/path/path.h"
#include "bio/path/path_length.h"
#include "support/finite_difference.h"

namespace bio::fixtures {

using V = Vec3<double>;

inline Joint hinge(const std::string& name, const std::string& parent, const V& where,
                   const std::string& child, const V& axis, const std::string& coordinate) {
  Joint joint;
  joint.name = name;
  joint.kind = JointKind::custom;
  joint.parentBody = parent;
  joint.parentFrame.translation = where;
  joint.childBody = child;
  Coordinate c;
  c.name = coordinate;
  c.rangeMin = -0.2;
  c.rangeMax = 2.3;
  joint.coordinates = {c};
  joint.axes[0] = {coordinate, axis.normalized(), Function{1, LinearFunction{1, 0}}};
  return joint;
}

// Upper arm, ulna, radius: shoulder about z, elbow about a tilted z, forearm rotation about −y.
inline Model system() {
  Model model;
  for (const char* name : {"humerus", "ulna", "radius"}) {
    Body body;
    body.name = name;
    body.mass = 1;
    body.massCenter = {0, -0.1, 0};
    body.inertia = {0.01, 0.002, 0.01, 0, 0, 0};
    model.bodies.push_back(body);
  }
  model.joints = {
      hinge("shoulder", "ground", {0.1, 0.5, 0}, "humerus", {0, 0.1, 1}, "shoulder"),
      hinge("elbow", "humerus", {0.006, -0.29, -0.012}, "ulna", {0.05, 0.04, 1}, "flexion"),
      hinge("forearm", "ulna", {0, -0.01, 0.02}, "radius", {0, -1, 0.1}, "rotation")};
  WrapObject cylinder;
  cylinder.name = "cylinder";
  cylinder.body = "humerus";
  cylinder.frame.translation = {0.003, -0.292, -0.012};
  cylinder.frame.orientation = {-0.14, 0.05, 0.15};
  cylinder.radius = 0.016;
  cylinder.length = 0.1;
  WrapObject moved = cylinder;  // on the ulna: a frame that moves
  moved.name = "moved";
  moved.body = "ulna";
  moved.frame.translation = {0.012, -0.03, 0.002};
  moved.radius = 0.012;
  WrapObject sphere = cylinder;
  sphere.name = "sphere";
  sphere.shape = WrapShape::sphere;
  sphere.radius = 0.018;
  WrapObject ellipsoid = cylinder;
  ellipsoid.name = "ellipsoid";
  ellipsoid.shape = WrapShape::ellipsoid;
  ellipsoid.semiAxes = {0.016, 0.016, 0.05};
  WrapObject odd = ellipsoid;
  odd.name = "odd";
  odd.semiAxes = {0.016, 0.02, 0.05};
  WrapObject far = odd;
  far.name = "far";
  far.frame.translation = {0.3, 0.2, 0};
  model.wrapObjects = {cylinder, moved, sphere, ellipsoid, odd, far};
  return model;
}

inline PathPoint point(const std::string& body, const V& location) {
  PathPoint p;
  p.body = body;
  p.location = location;
  return p;
}

inline Muscle muscle(std::vector<PathPoint> points, std::vector<std::string> wraps = {}) {
  Muscle m;
  m.name = "test";
  m.path.points = std::move(points);
  for (const std::string& name : wraps) m.path.wraps.push_back({name, -1, -1});
  return m;
}

inline Muscle extensor(std::vector<std::string> wraps = {}) {
  return muscle(
      {point("humerus", {-0.006, -0.126, 0.004}), point("humerus", {-0.017, -0.267, -0.012}),
       point("ulna", {-0.022, 0.010, -0.001})},
      std::move(wraps));
}

inline Muscle flexor(std::vector<std::string> wraps = {}) {
  return muscle({point("ground", {0.12, 0.52, 0.01}), point("humerus", {0.02, -0.17, -0.006}),
                 point("radius", {0.004, -0.04, -0.01})},
                std::move(wraps));
}

// A path for N free coordinates, and what the tests ask of it.
template <int N>
class ArmPath {
 public:
  using Q = Eigen::Matrix<double, N, 1>;
  ArmPath(const Model& model, const Muscle& muscle, const std::vector<std::string>& asCylinder = {})
      : skeleton(model, {.freeCoordinates = names(), .lockedValues = {}}),
        path(model, skeleton, muscle, asCylinder),
        moved_(skeleton.numSegments()) {}

  LengthJet<N> at(const Q& q) {
    skeleton.motions<double, N>(q, moved_.data());
    return path.length<N>(q, moved_.data());
  }
  std::vector<V> points(const Q& q, double step = 0.1) {
    skeleton.motions<double, N>(q, moved_.data());
    return path.pathPoints<N>(q, moved_.data(), step);
  }
  // First and second derivatives against differences.
  void expectDerivatives(const Q& q) {
    const LengthJet<N> jet = at(q);
    for (int i = 0; i < N; ++i) {
      const auto moveTo = [&](double x) {
        Q moved = q;
        moved[i] = x;
        return moved;
      };
      const auto length = [&](double x) { return at(moveTo(x)).length; };
      EXPECT_NEAR(jet.dL_dq[i], support::centralDifference(length, q[i], 1e-4), 1e-11);
      for (int j = 0; j < N; ++j) {
        const auto slope = [&](double x) { return at(moveTo(x)).dL_dq[j]; };
        EXPECT_NEAR(jet.d2L_dq2(i, j), support::centralDifference(slope, q[i], 1e-4), 1e-10);
      }
    }
  }
  static std::vector<std::string> names() {
    if constexpr (N == 1) return {"flexion"};
    if constexpr (N == 2) return {"flexion", "rotation"};
    return {"shoulder", "flexion", "rotation"};
  }

  Skeleton skeleton;
  MusclePath path;

 private:
  std::vector<RigidMotion<double, N>> moved_;
};

}  // namespace bio::fixtures
