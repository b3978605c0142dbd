#include "design/dynamometer_trials.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bio/design/experiment_design.h"
#include "bio/model/units.h"

namespace bio {
namespace {

using Eigen::Index;
using ExperimentKind = DynamometerExperiment::Kind;

constexpr double settling = 0.2;  ///< between a contraction and a turn [s]

/// 0 to 1 with a straight rise and fall.
double contractionAt(double t, double begin, double end) {
  return std::clamp(std::min((t - begin) / dynamometer::ramp, (end - t) / dynamometer::ramp), 0.0,
                    1.0);
}

/// Where a turn of this length [rad] is, t [s] after its begin: the speed rises and falls as a
/// squared sine within `speedUp` [s], which is at most length/speed.
double turnedAt(double t, double length, double speed, double speedUp) {
  const double whole = length / speed + speedUp;  // [s]
  const auto risen = [](double s) {               // ∫ sin²(π s/2) of 0 … 1
    const double x = std::clamp(s, 0.0, 1.0);
    return x / 2 - std::sin(std::numbers::pi * x) / (2 * std::numbers::pi);
  };
  if (t <= 0) return 0;
  if (t >= whole) return length;
  if (t < speedUp) return speed * speedUp * risen(t / speedUp);
  if (t > whole - speedUp) return length - speed * speedUp * risen((whole - t) / speedUp);
  return speed * (t - speedUp / 2);
}

/// Times of an experiment [s].
struct DynamometerCourse {
  double begin = 0;       ///< of the turn, or of what is held
  double speedUp = 0;     ///< of the turn
  double contracted = 0;  ///< end of the contraction
  double duration = 0;
};

DynamometerCourse courseOf(const DynamometerExperiment& experiment) {
  const double length = std::abs(experiment.to - experiment.from);
  double before = 0, moves = dynamometer::hold, behind = 0;
  DynamometerCourse course;
  if (experiment.kind == ExperimentKind::release) {
    before = dynamometer::beforeRelease;
    moves = dynamometer::releaseTime(length, experiment.speed);
    course.speedUp = moves / 2;
    behind = dynamometer::afterRelease;
  } else if (experiment.kind != ExperimentKind::isometric) {
    before = behind = settling;
    course.speedUp = dynamometer::speedUp;
    moves = length / experiment.speed + course.speedUp;
  }
  course.begin = dynamometer::rest + dynamometer::ramp + before;
  course.contracted = course.begin + moves + behind + dynamometer::ramp;
  course.duration = course.contracted + dynamometer::after;
  return course;
}

}  // namespace

DynamometerTrials::DynamometerTrials(const MusculoskeletalSystem& system,
                                     const Coordinate& coordinate,
                                     const DynamometerQuestion& question)
    : system_(system),
      coordinate_(coordinate),
      question_(question),
      groups_(flexorsAndExtensors(system, system.skeleton().defaultValues())) {}

bool DynamometerTrials::considers(ExperimentKind kind) const {
  return std::find(question_.kinds.begin(), question_.kinds.end(), kind) != question_.kinds.end();
}

DynamometerTrials::List DynamometerTrials::all() const {
  List list;
  for (const MuscleGroup& group : groups_) {
    for (const double effort : question_.efforts) addContractions(group, effort, list);
  }
  addTurns(list);
  for (DynamometerExperiment& experiment : list.experiments) experiment.trial = trialOf(experiment);
  return list;
}

void DynamometerTrials::addContractions(const MuscleGroup& group, double effort, List& list) const {
  const double shortens = group.name == "flexors" ? 1 : -1;
  for (const double at : question_.positions) {
    DynamometerExperiment experiment{ExperimentKind::isometric, at, at};
    experiment.group = group.name;
    experiment.effort = effort;
    if (considers(experiment.kind)) list.experiments.push_back(experiment);
    experiment.kind = ExperimentKind::isotonic;
    for (const double load : question_.loads) {
      if (!considers(experiment.kind)) break;
      experiment.load = load;
      list.experiments.push_back(experiment);
    }
    experiment.kind = ExperimentKind::release;
    experiment.load = 0;
    experiment.speed = question_.releaseSpeed;
    for (const double length : question_.releases) {
      if (!considers(experiment.kind)) break;
      experiment.to = at + shortens * length;
      if (experiment.to >= coordinate_.rangeMin && experiment.to <= coordinate_.rangeMax) {
        list.experiments.push_back(experiment);
      } else {
        ++list.outside;
      }
    }
  }
}

void DynamometerTrials::addTurns(List& list) const {
  const double low = question_.positions.front(), high = question_.positions.back();
  for (const double speed : question_.speeds) {
    for (const auto& [from, to] : {std::pair{low, high}, std::pair{high, low}}) {
      DynamometerExperiment experiment{ExperimentKind::passive, from, to, speed};
      if (considers(experiment.kind)) list.experiments.push_back(experiment);
      experiment.kind = ExperimentKind::isokinetic;
      if (!considers(experiment.kind)) continue;
      for (const MuscleGroup& group : groups_) {
        for (const double effort : question_.efforts) {
          experiment.group = group.name;
          experiment.effort = effort;
          list.experiments.push_back(experiment);
        }
      }
    }
  }
}

std::string DynamometerTrials::coordinateColumn() const {
  return coordinate_.name + (coordinate_.isRotation ? "_deg" : "");
}

double DynamometerTrials::unit() const {
  return coordinate_.isRotation ? degreesPerRadian : 1;
}

Table DynamometerTrials::trialOf(const DynamometerExperiment& experiment) const {
  const bool isFree = experiment.kind == ExperimentKind::isotonic;
  const DynamometerCourse course = isFree ? DynamometerCourse{} : courseOf(experiment);
  const double duration = isFree ? dynamometer::longestIsotonic : course.duration;
  Table table;
  table.name = "dynamometer";
  table.columns = {"time"};
  for (const SystemMuscle& muscle : system_.muscles()) table.columns.push_back(muscle.name);
  if (isFree) {
    table.columns.push_back(coordinate_.name + (coordinate_.isRotation ? ".torque" : ".force"));
  }
  table.columns.push_back(coordinateColumn());
  const auto rows = static_cast<Index>(std::floor(duration * question_.rate + 1e-9)) + 1;
  table.values.setZero(rows, static_cast<Index>(table.columns.size()));
  std::vector<double> raised;  // of each muscle, above rest
  for (const SystemMuscle& muscle : system_.muscles()) {
    const double effort = contracts(experiment, muscle.name) ? experiment.effort : 0;
    raised.push_back(std::max(0.0, effort - dynamometer::excitationAtRest));
  }
  const double sign = experiment.to > experiment.from ? 1 : -1;
  for (Index k = 0; k < rows; ++k) {
    const double t = static_cast<double>(k) / question_.rate;
    const double contraction = isFree ? 1 : contractionAt(t, dynamometer::rest, course.contracted);
    table.values(k, 0) = t;
    for (std::size_t m = 0; m < raised.size(); ++m) {
      table.values(k, static_cast<Index>(m) + 1) =
          dynamometer::excitationAtRest + raised[m] * contraction;
    }
    const double turned =
        experiment.to == experiment.from
            ? 0
            : turnedAt(t - course.begin, std::abs(experiment.to - experiment.from),
                       experiment.speed, course.speedUp);
    table.values(k, table.values.cols() - 1) = unit() * (experiment.from + sign * turned);
  }
  return table;
}

bool DynamometerTrials::contracts(const DynamometerExperiment& experiment,
                                  const std::string& muscle) const {
  for (const MuscleGroup& group : groups_) {
    if (group.name != experiment.group) continue;
    return std::find(group.muscles.begin(), group.muscles.end(), muscle) != group.muscles.end();
  }
  return false;
}

}  // namespace bio
