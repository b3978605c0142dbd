#include "bio/discovery/planned_experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bio/discovery/end_of_limb.h"

namespace bio::discover {

namespace {

// Pushes in turn up and down, each a hump of half a sine.
Eigen::VectorXd pushes(const Eigen::VectorXd& times, double size) {
  constexpr double interval = 1, width = 0.2, first = 0.5;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(times.size());
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    const double since = times[i] - times[0] - first;
    if (since < 0) continue;
    const double turn = std::floor(since / interval), phase = (since - turn * interval) / width;
    if (phase >= 1) continue;
    const double sign = std::fmod(turn, 2) == 0 ? 1 : -1;
    force[i] = sign * size * std::sin(std::numbers::pi * phase);
  }
  return force;
}

Trial pushed(Trial trial, const std::string& coordinate, double size) {
  const Eigen::VectorXd force = pushes(trial.times, size);
  const auto known = std::find_if(trial.applied.begin(), trial.applied.end(),
                                  [&](const auto& one) { return one.coordinate == coordinate; });
  if (known != trial.applied.end())
    known->values += force;
  else
    trial.applied.push_back({coordinate, force});
  return trial;
}

}  // namespace

std::vector<PlannedExperiment> plannedExperiments(const Trial& trial,
                                                  const EncompassingModel& model) {
  const std::string file = std::filesystem::path(trial.file).filename().string();
  std::vector<PlannedExperiment> planned;
  planned.push_back({fmt::format("repeat {} unchanged", file), trial});
  for (const double mass : {0.1, 0.3, 1.0}) {
    if (model.movedBodies().empty()) break;
    Trial loaded = trial;
    loaded.conditions.massInHand += mass;
    planned.push_back({fmt::format("repeat {} with a known mass of {} kg {} (header line "
                                   "known_mass_in_hand_kg={})",
                                   file, loaded.conditions.massInHand, placeOfMass(model),
                                   loaded.conditions.massInHand),
                       loaded});
  }
  for (const MovingCoordinate& at : model.coordinates()) {
    const Coordinate& coordinate = at.coordinate;
    const auto& drives = model.drives();
    const bool isDriven = std::any_of(drives.begin(), drives.end(), [&](const Drive& drive) {
      return drive.command.coordinate == at.coordinate.name;
    });
    // a push in the column of the commands would pass through the drive
    if (isDriven || model.system().isPrescribed(at.index)) continue;
    const bool turns = coordinate.isRotation;
    for (const double size : {0.25, 0.5, 1.0}) {
      planned.push_back(
          {fmt::format(
               "repeat {} with recorded external pushes of {} {} lasting 0.2 s, alternately "
               "up and down, one per second (column {}.{})",
               file, size, turns ? "N·m" : "N", coordinate.name, turns ? "torque" : "force"),
           pushed(trial, coordinate.name, size)});
    }
  }
  return planned;
}

}  // namespace bio::discover
