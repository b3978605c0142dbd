#include "bio/analysis/driven_trial.h"

#include <cmath>
#include <set>

#include "bio/analysis/replay.h"
#include "bio/sensitivity/coupled_sensitivity.h"

namespace bio {

Table drivenTable(const Trial& trial, const MusculoskeletalSystem& arm, const EmgMapping& mapping) {
  const std::vector<std::string> muscles = muscleNames(arm);
  const ExcitationSignal driven = drivenExcitation(excitationOf(trial, arm), muscles, mapping);
  const double first = trial.times[0], last = trial.times[trial.times.size() - 1];
  std::set<double> times(trial.times.begin(), trial.times.end());
  for (const MeasuredMotion& motion : trial.measured) {
    times.insert(motion.times.begin(), motion.times.end());
  }
  for (const double t : driven.times()) {
    if (t > first && t < last) times.insert(t);
  }
  Table table;
  table.name = "driven excitations";
  table.columns = {"time"};
  table.columns.insert(table.columns.end(), muscles.begin(), muscles.end());
  table.metadata.merge(headerOf(trial.known));
  const auto n = static_cast<Eigen::Index>(muscles.size());
  const auto measured = static_cast<Eigen::Index>(trial.measured.size());
  const auto applied = static_cast<Eigen::Index>(trial.applied.size());
  table.values = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(times.size()),
                                           1 + n + measured + applied, std::nan(""));
  const ExternalForce external = externalForceOf(trial, arm);
  Eigen::Index row = 0;
  std::size_t hint = 0;
  for (const double t : times) {
    table.values(row, 0) = t;
    driven.at(t, hint, table.values.row(row).segment(1, n).transpose());
    for (Eigen::Index k = 0; k < applied; ++k) {
      const auto& coordinate = trial.applied[static_cast<std::size_t>(k)].coordinate;
      table.values(row, 1 + n + measured + k) =
          external.at(t).value[arm.skeleton().indexOf(coordinate)];
    }
    ++row;
  }
  for (Eigen::Index k = 0; k < measured; ++k) {
    const MeasuredMotion& motion = trial.measured[static_cast<std::size_t>(k)];
    table.columns.push_back(motion.coordinate);
    for (Eigen::Index i = 0; i < motion.times.size(); ++i) {
      const auto place = std::distance(times.begin(), times.find(motion.times[i]));
      table.values(place, 1 + n + k) = motion.values[i];
    }
  }
  for (const AppliedForce& push : trial.applied) {
    const int index = arm.skeleton().indexOf(push.coordinate);
    const bool turns = arm.skeleton().coordinates()[static_cast<std::size_t>(index)].isRotation;
    table.columns.push_back(push.coordinate + (turns ? ".torque" : ".force"));
  }
  return table;
}

}  // namespace bio
