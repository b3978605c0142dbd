#include "bio/analysis/driven_trial.h"

#include <cmath>
#include <set>

#include "bio/analysis/replay.h"
#include "bio/sensitivity/coupled_sensitivity.h"
#include "bio/tables/trial_table.h"
#include "info/dynamics/linear_table.h"

namespace bio {
namespace {

struct Course {
  std::string column;
  const Eigen::VectorXd* times;
  const Eigen::VectorXd* values;
};

/// All that a trial gives at times of its own; not constants, which stand in no file.
std::vector<Course> coursesOf(const Trial& trial) {
  std::vector<Course> courses;
  for (const auto* list : {&trial.measured, &trial.prescribed}) {
    for (const MeasuredChannel& motion : *list) {
      if (list == &trial.prescribed && motion.times.size() == 1) continue;
      courses.push_back({nameOf(motion.what), &motion.times, &motion.values});
    }
  }
  return courses;
}

}  // namespace

Table drivenTable(const Trial& trial, const MusculoskeletalSystem& system,
                  const EmgMapping& mapping) {
  const std::vector<std::string> muscles = muscleNames(system);
  const ExcitationSignal driven = drivenExcitation(excitationOf(trial, system), muscles, mapping);
  const double first = trial.times[0], last = trial.times[trial.times.size() - 1];
  std::set<double> times(trial.times.begin(), trial.times.end());
  const std::vector<Course> courses = coursesOf(trial);
  for (const Course& course : courses) times.insert(course.times->begin(), course.times->end());
  for (const double t : driven.times()) {
    if (t > first && t < last) times.insert(t);
  }
  Table table;
  table.name = "driven excitations";
  table.columns = {"time"};
  table.columns.insert(table.columns.end(), muscles.begin(), muscles.end());
  table.metadata.merge(headerOf(trial.conditions));
  const auto n = static_cast<Eigen::Index>(muscles.size());
  const auto measured = static_cast<Eigen::Index>(courses.size());
  const auto applied = static_cast<Eigen::Index>(trial.applied.size());
  table.values = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(times.size()),
                                           1 + n + measured + applied, std::nan(""));
  Eigen::Index row = 0;
  std::size_t hint = 0;
  for (const double t : times) {
    table.values(row, 0) = t;
    driven.at(t, hint, table.values.row(row).segment(1, n).transpose());
    for (Eigen::Index k = 0; k < applied; ++k) {
      const AppliedForce& push = trial.applied[static_cast<std::size_t>(k)];
      table.values(row, 1 + n + measured + k) =
          info::linearAt(trial.times, t).value(push.actuator.empty() ? push.values : push.control);
    }
    ++row;
  }
  for (Eigen::Index k = 0; k < measured; ++k) {
    const auto& [column, at, values] = courses[static_cast<std::size_t>(k)];
    table.columns.push_back(column);
    for (Eigen::Index i = 0; i < at->size(); ++i) {
      const auto place = std::distance(times.begin(), times.find((*at)[i]));
      table.values(place, 1 + n + k) = (*values)[i];
    }
  }
  for (const AppliedForce& push : trial.applied) {
    const int index = system.skeleton().indexOf(push.coordinate);
    if (!push.actuator.empty()) {
      table.columns.push_back(push.actuator);
      continue;
    }
    const bool turns = system.skeleton().coordinates()[static_cast<std::size_t>(index)].isRotation;
    table.columns.push_back(push.coordinate + (turns ? ".torque" : ".force"));
  }
  return table;
}

Trial drivenTrial(const Table& driven, const Trial& recorded, const Model& model) {
  TrialOptions options{.experimentalConditions = true};
  for (const MeasuredChannel& course : recorded.prescribed)
    if (course.times.size() > 1) options.prescribed.push_back(course.what.object);
  Trial trial = trialFrom(driven, recorded.file, model, options);
  trial.prescribed = recorded.prescribed;  // with those that are held
  return trial;
}

void addStarts(Model& model, const FittedTrial& fitted, const std::string& file,
               const std::string& sha256) {
  if (sha256.empty()) return;
  for (TrialStart start : fitted.starts) {
    start.file = file;
    start.sha256 = sha256;
    model.fitted.starts.push_back(std::move(start));
  }
}

std::optional<TrialReplay> completeReplay(const MusculoskeletalSystem& system, const Trial& trial,
                                          const SimulationOptions& simulation,
                                          const StartPoint& start) {
  try {
    TrialReplay replay =
        replayTrial(system, trial, simulation, {start, TrialBeginning::From::model});
    if (replay.motion.outcome == Outcome::completed) return replay;
  } catch (const std::exception&) {
    // it has no start, say
  }
  return std::nullopt;
}

}  // namespace bio
