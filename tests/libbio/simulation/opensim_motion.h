#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"
#include "support/numbers.h"

namespace bio::fixtures {

/// A motion of the elbow that OpenSim made: the table has a column `angle` and, of each muscle M,
/// M + fibre and M + force. It begins at rest, activations at the excitations, fibres in
/// equilibrium.
struct OpenSimMotion {
  std::string name;
  std::filesystem::path model, excitations, table;
  std::string angle, fibre, force;
  /// Of the class's own numbers, OpenSim's model had the defaults (and a least active force of 0
  /// where the class has one).
  bool atDefaults = false;
};

inline void takeDefaults(Model& model) {
  for (Muscle& muscle : model.muscles) {
    if (!muscle.hill) continue;
    std::visit(
        []<class Parameters>(Parameters& parameters) {
          Parameters fresh;
          for (std::size_t i = 0; i < muscles::common::count; ++i)
            Parameters::at(fresh, i) = Parameters::at(parameters, i);
          for (std::size_t i = 0; i < Parameters::properties.size(); ++i) {
            if (Parameters::properties[i].name == "ActiveForceLengthCurve/minimum_value")
              Parameters::at(fresh, i) = 0;
          }
          parameters = fresh;
        },
        *muscle.hill);
  }
}

struct MotionDifference {
  double angle_deg = 0;  ///< root mean square over the rows
  double fibre_m = 0;    ///< largest
  double force_N = 0;
};

inline MotionDifference differenceFrom(const OpenSimMotion& theirs, Integrator integrator,
                                       double step) {
  Model model = readOsim(theirs.model);
  if (theirs.atDefaults) takeDefaults(model);
  const MusculoskeletalSystem system(model, {{{"elbow_flexion"}, {}}, {}, {}});
  const Table motion = readTable(theirs.table);
  const Eigen::VectorXd time = timesOf(motion);
  const auto q = motion.values.col(columnIndex(motion, theirs.angle));
  const ExcitationSignal excitation = excitationOf(readTrial(theirs.excitations, model), system);
  SimulationOptions options;
  options.integrator = integrator;
  options.step = step;
  options.duration = time[time.size() - 1];
  const SystemState start = initialState(system, Eigen::VectorXd::Constant(1, q[0]), excitation, 0);
  const Trajectory ours = simulate(system, excitation, start, options);
  EXPECT_EQ(ours.outcome, Outcome::completed) << ours.why;
  const MuscleReport muscles = reportMuscles(system, ours);
  MotionDifference worst;
  double sum = 0;
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(std::lround(time[k] / step));
    sum += std::pow(ours.q(0, at) - q[k], 2);
    for (std::size_t i = 0; i < system.numMuscles(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const std::string& muscle = system.muscles()[i].name;
      const double fibre = motion.values(k, columnIndex(motion, muscle + theirs.fibre));
      const double force = motion.values(k, columnIndex(motion, muscle + theirs.force));
      worst.fibre_m = std::max(worst.fibre_m, std::abs(ours.fibreLength(row, at) - fibre));
      worst.force_N = std::max(worst.force_N, std::abs(muscles.tendonForce(row, at) - force));
    }
  }
  worst.angle_deg = std::sqrt(sum / static_cast<double>(q.size())) / support::degree;
  std::printf("%s: angle %.3g deg rms, fibre %.3g m, force %.3g N\n", theirs.name.c_str(),
              worst.angle_deg, worst.fibre_m, worst.force_N);
  return worst;
}

}  // namespace bio::fixtures
