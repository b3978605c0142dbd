#pragma once

#include <cmath>
#include <string>

#include "libbio/simulation/arm_of_seven.h"

// The arm of seven coordinates with forces of all kinds on its bodies.
namespace bio::fixtures {

/// Numbers of time that are no spline's knots by accident.
inline BodyLoad load(const std::string& name, const std::string& body,
                     const std::string& forceFrame, const std::string& pointFrame,
                     const Eigen::Vector3d& point) {
  BodyLoad result;
  result.name = name;
  result.body = body;
  result.forceFrame = forceFrame;
  result.pointFrame = pointFrame;
  for (int k = 0; k < 12; ++k) {
    const double t = 0.1 * k;
    result.times.push_back(t);
    result.rows.push_back({4 * std::sin(3 * t), 3 - 2 * t, std::cos(5 * t), point[0] + 0.01 * t,
                           point[1], point[2] - 0.01 * t, 0.3, -0.4 * std::sin(2 * t), 0.2 * t});
  }
  return result;
}

inline Model withLoads() {
  Model model = ArmOfSeven::heldModel();
  model.externalLoads = {load("push", "hand", "ground", "ground", {0.1, -0.3, 0.2}),
                         load("strap", "radius", "humerus", "radius", {0.01, -0.1, 0.02}),
                         load("rod", "ulna", "hand", "humerus", {0.02, -0.3, 0})};
  return model;
}

inline Model withSprings() {
  Model model = ArmOfSeven::heldModel();
  model.pointSprings = {{"band",
                         {"ground", "hand"},
                         {Eigen::Vector3d(0.3, -0.1, 0.1), Eigen::Vector3d(0, -0.05, 0.01)},
                         40,
                         0.1},
                        {"cord",
                         {"humerus", "radius"},
                         {Eigen::Vector3d(0.03, -0.1, 0), Eigen::Vector3d(0, -0.15, 0)},
                         25,
                         0}};
  BushingForce sleeve;
  sleeve.name = "sleeve";
  sleeve.body = {"humerus", "ulna"};
  sleeve.frame[0] = {{0.01, -0.28, 0}, {0.1, -0.2, 0.3}};
  sleeve.frame[1] = {{0, 0.01, 0.005}, {-0.2, 0.1, 0.4}};
  sleeve.rotationalStiffness = {0.5, 0.8, 1.1};
  sleeve.translationalStiffness = {200, 300, 250};
  sleeve.rotationalDamping = {0.02, 0.03, 0.04};
  sleeve.translationalDamping = {3, 2, 1};
  model.bushings = {sleeve};
  return model;
}

inline Model withElasticPaths() {
  Model model = ArmOfSeven::heldModel();
  const Path brachialis = findMuscle(model, "BRA").path;
  const Path triceps = findMuscle(model, "TRIlong").path;  // over its cylinder
  const auto elastic = [](const std::string& name, ElasticPathKind kind, const Path& path) {
    ElasticPath made;
    made.name = name;
    made.kind = kind;
    made.path = path;
    return made;
  };
  ElasticPath ligament = elastic("ligament", ElasticPathKind::ligament, brachialis);
  ligament.restLength = 0.1;
  ligament.scale = 20;
  ligament.curve = Function{1, SplineFunction{{0.9, 1, 1.2, 1.5, 2}, {-0.1, 0, 0.3, 1, 2.5}}};
  ElasticPath spring = elastic("spring", ElasticPathKind::spring, triceps);
  spring.restLength = 0.2;
  spring.scale = 90;
  spring.damping = 0.1;
  ElasticPath strap = elastic("strap", ElasticPathKind::blankevoort1991, brachialis);
  strap.restLength = 0.11;
  strap.scale = 30;
  strap.transitionStrain = 0.06;
  strap.damping = 2;
  model.elasticPaths = {ligament, spring, strap};
  return model;
}

inline Model withAll() {
  Model model = withLoads();
  model.pointSprings = withSprings().pointSprings;
  model.bushings = withSprings().bushings;
  model.elasticPaths = withElasticPaths().elasticPaths;
  return model;
}

/// A motor on the elbow, with its control over time.
inline Model withMotor(Model model) {
  model.actuators = {{"motor", "elbow_flexion", 1.5}};
  return model;
}
inline ExternalForce motorForce(int coordinates) {
  ExternalForce::Control control{"motor", 0, 1.5, {}, Eigen::VectorXd(8)};
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(8, coordinates);
  for (Eigen::Index k = 0; k < 8; ++k) {
    control.times.push_back(0.06 * static_cast<double>(k));
    control.values[k] = std::sin(1.0 + static_cast<double>(k));
    values(k, 0) = control.optimalForce * control.values[k];
  }
  return {control.times, values, {control}};
}

}  // namespace bio::fixtures
