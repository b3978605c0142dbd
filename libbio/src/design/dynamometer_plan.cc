#include "bio/design/dynamometer_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "bio/analysis/replay.h"
#include "bio/calibration/trial_predictor.h"
#include "bio/design/experiment_design.h"
#include "bio/tables/trial.h"
#include "bio/tables/trial_table.h"
#include "info/estimation/monte_carlo.h"

namespace bio {
namespace {

using Eigen::Index;
using ExperimentKind = DynamometerExperiment::Kind;

constexpr double degreesPerRadian = 180 / std::numbers::pi;

/// 0 to 1 with a straight rise and fall.
double contractionAt(double t, double begin, double end) {
  return std::clamp(std::min((t - begin) / dynamometer::ramp, (end - t) / dynamometer::ramp), 0.0,
                    1.0);
}

/// Where a turn of this length [rad] that fits is, t [s] after its begin: the speed rises and falls
/// as a squared sine.
double turnedAt(double t, double length, double speed) {
  const double whole = length / speed + dynamometer::speedUp;  // [s]
  const auto risen = [](double s) {                            // ∫ sin²(π s/2) of 0 … 1
    const double x = std::clamp(s, 0.0, 1.0);
    return x / 2 - std::sin(std::numbers::pi * x) / (2 * std::numbers::pi);
  };
  if (t <= 0) return 0;
  if (t >= whole) return length;
  if (t < dynamometer::speedUp)
    return speed * dynamometer::speedUp * risen(t / dynamometer::speedUp);
  if (t > whole - dynamometer::speedUp)
    return length - speed * dynamometer::speedUp * risen((whole - t) / dynamometer::speedUp);
  return speed * (t - dynamometer::speedUp / 2);
}

class DynamometerPlanner {
 public:
  DynamometerPlanner(const Model& model, const MusculoskeletalSystem& arm,
                     const SystemOptions& options, const SimulationOptions& simulation,
                     const DynamometerQuestion& question)
      : model_(model),
        arm_(arm),
        options_(options),
        simulation_(simulation),
        question_(question),
        coordinate_(findCoordinate(model, question.coordinate)),
        catalogue_(model, arm, {arm.skeleton().defaultValues(), {}}),
        selection_(catalogue_.select(question.parameters)),
        asked_(selection_.size()) {
    if (question.nuisance.empty()) return;
    for (const std::size_t index : catalogue_.select(question.nuisance)) {
      if (std::find(selection_.begin(), selection_.end(), index) == selection_.end()) {
        selection_.push_back(index);
      }
    }
  }

  DynamometerPlan plan() {
    std::vector<DynamometerExperiment> all = candidates();
    info::parallelFor(static_cast<int>(all.size()), question_.threads,
                      [&](int i) { inform(all[static_cast<std::size_t>(i)]); });
    DynamometerPlan plan;
    plan.candidates = all.size();
    const auto isDead = [](const DynamometerExperiment& one) { return one.fisher.size() == 0; };
    plan.failed = static_cast<std::size_t>(std::count_if(all.begin(), all.end(), isDead));
    std::erase_if(all, isDead);
    if (all.empty()) throw std::runtime_error("none of the experiments can be simulated");
    for (std::size_t i = 0; i < asked_; ++i) {
      plan.parameters.push_back(catalogue_.parameters()[selection_[i]]);
    }
    choose(std::move(all), plan);
    return plan;
  }

 private:
  std::vector<DynamometerExperiment> candidates() const {
    std::vector<DynamometerExperiment> all;
    const auto groups = flexorsAndExtensors(arm_, arm_.skeleton().defaultValues());
    for (const MuscleGroup& group : groups) {
      for (const double effort : question_.efforts) {
        for (const double position : question_.positions) {
          all.push_back(
              {ExperimentKind::isometric, position, position, 0, group.name, effort, {}, {}});
        }
      }
    }
    const double low = question_.positions.front(), high = question_.positions.back();
    for (const double speed : question_.speeds) {
      for (const auto& [from, to] : {std::pair{low, high}, std::pair{high, low}}) {
        all.push_back({ExperimentKind::passive, from, to, speed, "", 0, {}, {}});
        for (const MuscleGroup& group : groups) {
          for (const double effort : question_.efforts) {
            all.push_back(
                {ExperimentKind::isokinetic, from, to, speed, group.name, effort, {}, {}});
          }
        }
      }
    }
    for (DynamometerExperiment& one : all) one.trial = trialOf(one, groups);
    return all;
  }

  Table trialOf(const DynamometerExperiment& one, const std::vector<MuscleGroup>& groups) const {
    const double length = std::abs(one.to - one.from);
    const double turning = one.kind == ExperimentKind::isometric
                               ? dynamometer::hold
                               : length / one.speed + dynamometer::speedUp;
    const double begin =
        dynamometer::rest + dynamometer::ramp + (one.kind == ExperimentKind::isometric ? 0 : 0.2);
    const double end = begin + turning + (one.kind == ExperimentKind::isometric ? 0 : 0.2);
    const double duration = end + dynamometer::ramp + dynamometer::after;
    Table table;
    table.name = "dynamometer";
    table.columns = {"time"};
    for (const SystemMuscle& muscle : arm_.muscles()) table.columns.push_back(muscle.name);
    table.columns.push_back(coordinate_.name + (coordinate_.isRotation ? "_deg" : ""));
    const auto rows = static_cast<Index>(std::floor(duration * question_.rate)) + 1;
    table.values.resize(rows, static_cast<Index>(table.columns.size()));
    const double unit = coordinate_.isRotation ? degreesPerRadian : 1;
    for (Index k = 0; k < rows; ++k) {
      const double t = static_cast<double>(k) / question_.rate;
      table.values(k, 0) = t;
      for (Index m = 1; m + 1 < table.values.cols(); ++m) {
        const std::string& muscle = table.columns[static_cast<std::size_t>(m)];
        const double effort = contracts(one, groups, muscle) ? one.effort : 0;
        table.values(k, m) = dynamometer::excitationAtRest +
                             std::max(0.0, effort - dynamometer::excitationAtRest) *
                                 contractionAt(t, dynamometer::rest, end + dynamometer::ramp);
      }
      const double turned =
          one.kind == ExperimentKind::isometric ? 0 : turnedAt(t - begin, length, one.speed);
      table.values(k, table.values.cols() - 1) =
          unit * (one.from + (one.to > one.from ? turned : -turned));
    }
    return table;
  }

  static bool contracts(const DynamometerExperiment& one, const std::vector<MuscleGroup>& groups,
                        const std::string& muscle) {
    for (const MuscleGroup& group : groups) {
      if (group.name != one.group) continue;
      return std::find(group.muscles.begin(), group.muscles.end(), muscle) != group.muscles.end();
    }
    return false;
  }

  /// ΓᵀΓ/σ² of the moment.
  void inform(DynamometerExperiment& one) const {
    const Trial trial =
        trialFrom(one.trial, "dynamometer", model_, {.prescribed = {coordinate_.name}});
    SimulationOptions simulation = simulation_;
    simulation.startTime = trial.times[0];
    simulation.duration = trial.duration();
    simulation.prescribed = prescribedMotionOf(trial, arm_);
    const TrialPredictor predictor(catalogue_, options_, excitationOf(trial, arm_),
                                   {{{Observable::Kind::moment, coordinate_.name, 0}, trial.times}},
                                   selection_, simulation);
    const Eigen::MatrixXd gamma = predictor.withSensitivities(catalogue_.values(selection_)).gamma;
    if (!gamma.allFinite()) return;
    one.fisher = gamma.transpose() * gamma / (question_.noise * question_.noise);
  }

  void choose(std::vector<DynamometerExperiment> all, DynamometerPlan& plan) const {
    const auto p = static_cast<Index>(selection_.size());
    const auto asked = static_cast<Index>(plan.parameters.size());
    Eigen::VectorXd sd(p);
    for (Index i = 0; i < p; ++i) {
      sd[i] = catalogue_.parameters()[selection_[static_cast<std::size_t>(i)]].sd;
    }
    // in units of prior deviations I + Λ is S I S + 1; covariance of what is asked for
    const auto covariance = [&](const Eigen::MatrixXd& fisher) -> Eigen::MatrixXd {
      Eigen::MatrixXd A = sd.asDiagonal() * fisher * sd.asDiagonal();
      A.diagonal().array() += 1;
      return A.llt().solve(Eigen::MatrixXd::Identity(p, p)).topLeftCorner(asked, asked);
    };
    const auto logDeterminant = [&](const Eigen::MatrixXd& fisher) {
      return 2 * covariance(fisher).llt().matrixLLT().diagonal().array().log().sum();
    };
    Eigen::MatrixXd known = Eigen::MatrixXd::Zero(p, p);
    for (int n = 0; n < question_.count && !all.empty(); ++n) {
      const double now = logDeterminant(known);
      auto best = all.begin();
      double most = -1;
      for (auto one = all.begin(); one != all.end(); ++one) {
        const double gain = (now - logDeterminant(known + one->fisher)) / 2;
        if (gain <= most) continue;
        most = gain;
        best = one;
      }
      known += best->fisher;
      plan.information.push_back(most);
      plan.bounds.emplace_back(sd.head(asked).array() *
                               covariance(known).diagonal().array().sqrt());
      plan.chosen.push_back(std::move(*best));
      all.erase(best);
    }
  }

  const Model& model_;
  const MusculoskeletalSystem& arm_;
  const SystemOptions& options_;
  const SimulationOptions& simulation_;
  const DynamometerQuestion& question_;
  const Coordinate& coordinate_;
  ParameterCatalogue catalogue_;
  std::vector<std::size_t> selection_;  ///< what is asked for, then nuisance parameters
  std::size_t asked_;
};

void checkQuestion(const DynamometerQuestion& question) {
  const auto require = [](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument(fmt::format("dynamometer: {}", rule));
  };
  const auto& at = question.positions;
  require(
      !at.empty() && std::adjacent_find(at.begin(), at.end(), std::greater_equal<>()) == at.end(),
      "positions must rise, at least one");
  for (const double speed : question.speeds) {
    require(speed > 0 && dynamometer::turnFits(at.back() - at.front(), speed),
            "speeds must be > 0 and fit between the positions");
  }
  for (const double effort : question.efforts) {
    require(effort > dynamometer::excitationAtRest && effort <= 1,
            "efforts must be above rest and at most 1");
  }
  require(question.noise > 0 && question.rate > 0 && question.count > 0,
          "noise, rate and count must be > 0");
}

}  // namespace

DynamometerPlan planOnDynamometer(const Model& model, const MusculoskeletalSystem& arm,
                                  const SystemOptions& options, const SimulationOptions& simulation,
                                  const DynamometerQuestion& question) {
  checkQuestion(question);
  return DynamometerPlanner(model, arm, options, simulation, question).plan();
}

}  // namespace bio
