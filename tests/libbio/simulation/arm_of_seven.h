#pragma once

#include <numbers>

#include "bio/analysis/fit_paths.h"
#include "bio/simulation/simulate.h"
#include "support/elbow_model.h"

namespace bio::fixtures {

/// The shipped elbow's arm with shoulder, elbow, forearm and wrist free: seven coordinates, eight
/// muscles that lift and lower the forearm, springs that hold the others.
struct ArmOfSeven {
  static Model heldModel() {
    Model model = elbowModel();
    const auto hold = [&](const char* name, double stiffness, double rest, double viscosity) {
      model.springForces.push_back({std::string("hold_") + name, name, stiffness, rest, viscosity});
    };
    hold("elv_angle", 40, 0.5, 2);
    hold("shoulder_elv", 40, 0.9, 2);
    hold("shoulder_rot", 20, -0.4, 1);
    hold("pro_sup", 3, 0.2, 0.1);
    hold("deviation", 3, 0.1, 0.05);
    hold("flexion", 3, -0.1, 0.05);
    return model;
  }
  /// Polynomials of up to five coordinates in place of the paths of a long and a short flexor.
  static Model modelWithFunctions() {
    const Model model = heldModel();
    SkeletonOptions all;
    all.freeCoordinates = coordinates();
    return withFittedPaths(model, fitPaths(model, all, {}, {"BRD", "BIClong"}, {0.02, 4}));
  }
  static std::vector<std::string> coordinates() {
    return {"elbow_flexion", "shoulder_elv", "elv_angle", "shoulder_rot",
            "pro_sup",       "deviation",    "flexion"};
  }
  static ExcitationSignal lifting(const MusculoskeletalSystem& system, double duration) {
    std::vector<double> times;
    for (double t = 0; t < duration + 0.015; t += 0.01) times.push_back(t);
    Eigen::MatrixXd u(times.size(), system.numMuscles());
    for (Eigen::Index k = 0; k < u.rows(); ++k) {
      for (Eigen::Index i = 0; i < u.cols(); ++i) {
        const double phase = 0.4 * static_cast<double>(i);
        const double wave = std::sin(std::numbers::pi * times[static_cast<std::size_t>(k)] - phase);
        const bool flexes = system.muscles()[static_cast<std::size_t>(i)].name.starts_with("B");
        u(k, i) = 0.02 + (flexes ? 0.16 : 0.04) * wave * wave;
      }
    }
    return {times, u};
  }

  explicit ArmOfSeven(double duration = 1, std::vector<std::string> free = coordinates(),
                      bool asTree = false, Model given = heldModel())
      : model(std::move(given)),
        options{{std::move(free), {}, asTree}, {}, {}},
        system(model, options),
        excitation(lifting(system, duration)) {
    const std::map<std::string, double> from = {
        {"elbow_flexion", 0.7}, {"shoulder_elv", 0.8}, {"elv_angle", 0.5}, {"shoulder_rot", -0.3},
        {"pro_sup", 0.1},       {"deviation", 0.05},   {"flexion", -0.05}};
    Eigen::VectorXd q(system.skeleton().numCoordinates());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q[i] = from.at(system.skeleton().coordinates()[static_cast<std::size_t>(i)].name);
    }
    start = initialState(system, q, excitation, 0);
  }

  Model model;
  SystemOptions options;
  MusculoskeletalSystem system;
  ExcitationSignal excitation;
  SystemState start;
};

}  // namespace bio::fixtures
