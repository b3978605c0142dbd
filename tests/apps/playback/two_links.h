#pragma once

#include <cmath>

#include "bio/model/model.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "bio/simulation/simulate.h"

namespace bio::fixtures {

inline constexpr double upperLength = 0.3;  // [m]

/// Two links that hang from the ground, each on a pin about z; without muscles.
inline Model twoLinks() {
  Model model;
  model.name = "two links";
  model.gravity = {0, -9.81, 0};
  const auto add = [&](const std::string& name, const std::string& parent, double down) {
    Body body;
    body.name = name;
    body.mass = 1;
    body.massCenter = {0, -0.12, 0};
    body.inertia = {0.01, 0.01, 0.01, 0, 0, 0};
    model.bodies.push_back(body);
    Joint joint;
    joint.name = name + "_pin";
    joint.kind = JointKind::pin;
    joint.parentBody = parent;
    joint.childBody = name;
    joint.parentFrame.translation = {0, -down, 0};
    Coordinate coordinate;
    coordinate.name = name + "_angle";
    coordinate.rangeMin = -3;
    coordinate.rangeMax = 3;
    joint.coordinates = {coordinate};
    model.joints.push_back(joint);
  };
  add("upper", "ground", 0);
  add("lower", "upper", upperLength);
  return model;
}

inline SystemOptions twoLinksFree() {
  return {{{"upper_angle", "lower_angle"}, {}}, {}, {}};
}

/// A course of both angles, a tenth of a second a row.
inline Trajectory twoLinksSwing(Eigen::Index rows) {
  Trajectory motion;
  motion.q.resize(2, rows);
  motion.qDot = Eigen::MatrixXd::Zero(2, rows);
  motion.activation.resize(0, rows);
  motion.fibreLength.resize(0, rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const double t = 0.1 * static_cast<double>(k);
    motion.time.push_back(t);
    motion.q.col(k) << 0.4 + t, std::sin(5 * t) - 0.2;
  }
  return motion;
}

}  // namespace bio::fixtures
