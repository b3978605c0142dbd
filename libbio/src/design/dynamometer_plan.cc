#include "bio/design/dynamometer_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>

#include "bio/analysis/replay.h"
#include "bio/observation/trial_predictor.h"
#include "bio/tables/trial.h"
#include "bio/tables/trial_table.h"
#include "design/dynamometer_trials.h"
#include "info/parallel_for.h"

namespace bio {
namespace {

using Eigen::Index;

/// To three digits, as it is told to the person who sets the dynamometer.
double roundedTorque(double torque) {
  if (torque == 0) return 0;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(torque))) - 2);
  return std::round(torque / unit) * unit;
}

/// Observed series of one coordinate.
std::vector<ObservedSeries> measuredSeries(std::initializer_list<Observable::Kind> kinds,
                                           const std::string& coordinate,
                                           const Eigen::VectorXd& times) {
  std::vector<ObservedSeries> series(kinds.size());
  std::size_t i = 0;
  for (const Observable::Kind kind : kinds) {
    series[i].what.kind = kind;
    series[i].what.object = coordinate;
    series[i++].times = times;
  }
  return series;
}

/// Why a candidate is not ranked.
enum class Suitability { suitable, unsuitable, cannotBeSimulated };

class DynamometerPlanner {
 public:
  DynamometerPlanner(const Model& model, const MusculoskeletalSystem& system,
                     const SystemOptions& options, const SimulationOptions& simulation,
                     const DynamometerQuestion& question)
      : model_(model),
        system_(system),
        options_(options),
        simulation_(simulation),
        question_(question),
        coordinate_(findCoordinate(model, question.coordinate)),
        trials_(system, coordinate_, question),
        held_(startsOf(system)),
        catalogue_(held_.begin()->second),
        selection_(catalogue_.select(question.parameters)),
        asked_(selection_.size()) {
    if (!question.nuisance.empty()) {
      for (const std::size_t index : catalogue_.select(question.nuisance)) {
        if (std::find(selection_.begin(), selection_.end(), index) == selection_.end()) {
          selection_.push_back(index);
        }
      }
    }
    for (const std::size_t index : selection_) {
      sd_.conservativeResize(sd_.size() + 1);
      sd_[sd_.size() - 1] = catalogue_.parameters()[index].sd;
    }
  }

  DynamometerPlan plan() {
    DynamometerTrials::List list = trials_.all();
    std::vector<DynamometerExperiment>& all = list.experiments;
    if (std::any_of(all.begin(), all.end(), [](const auto& one) { return one.measuresAngle(); })) {
      letGo();
    }
    std::vector<Suitability> suits(all.size());
    info::parallelFor(static_cast<int>(all.size()), question_.threads, [&](int i) {
      const auto n = static_cast<std::size_t>(i);
      suits[n] = all[n].measuresAngle() ? informIsotonic(all[n]) : inform(all[n]);
    });
    DynamometerPlan plan;
    const auto count = [&](Suitability what) {
      return static_cast<std::size_t>(std::count(suits.begin(), suits.end(), what));
    };
    plan.candidates = all.size() + list.outside;
    plan.failed = count(Suitability::cannotBeSimulated);
    plan.unsuitable = list.outside + count(Suitability::unsuitable);
    std::erase_if(
        all, [](const DynamometerExperiment& experiment) { return experiment.fisher.size() == 0; });
    if (all.empty()) {
      throw std::runtime_error(plan.failed > 0
                                   ? "none of the experiments can be simulated"
                                   : "none of the experiments stays in the coordinate's range");
    }
    for (std::size_t i = 0; i < asked_; ++i) {
      plan.parameters.push_back(catalogue_.parameters()[selection_[i]]);
    }
    choose(std::move(all), plan);
    return plan;
  }

 private:
  /// Compiles the system with a free joint, and what starts at each of the positions.
  void letGo() {
    freeOptions_ = options_;
    std::erase(freeOptions_.prescribed, coordinate_.name);
    try {
      free_ = std::make_unique<MusculoskeletalSystem>(model_, freeOptions_);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("isotonic contractions: '{}' must be free: {}",
                                              coordinate_.name, error.what()));
    }
    letGo_ = startsOf(*free_);
  }

  /// Catalogue of a start at each of the positions.
  std::map<double, ParameterCatalogue> startsOf(const MusculoskeletalSystem& system) const {
    std::map<double, ParameterCatalogue> starts;
    const int index = system.skeleton().indexOf(coordinate_.name);
    for (const double position : question_.positions) {
      Eigen::VectorXd q = system.skeleton().defaultValues();
      q[index] = position;
      starts.emplace(position, ParameterCatalogue(model_, system, {q, {}}));
    }
    return starts;
  }

  /// ΓᵀΓ/σ² of the moment.
  Suitability inform(DynamometerExperiment& experiment) const {
    const Trial trial =
        trialFrom(experiment.trial, "dynamometer", model_, {.prescribed = {coordinate_.name}});
    const RecordedTrial recorded = recordedTrial(trial, system_, simulation_);
    const TrialPredictor predictor(
        held_.at(experiment.from), options_, recorded.excitation,
        measuredSeries({Observable::Kind::moment}, coordinate_.name, trial.times), selection_,
        recorded.simulation);
    const Eigen::MatrixXd gamma = predictor.withSensitivities(catalogue_.values(selection_)).gamma;
    if (!gamma.allFinite()) return Suitability::cannotBeSimulated;
    experiment.fisher = gamma.transpose() * gamma / (question_.noise * question_.noise);
    return Suitability::suitable;
  }

  /// The generalised force that holds the joint where an isotonic contraction begins; NaN where
  /// that cannot be simulated.
  double holdingForce(const DynamometerExperiment& experiment) const {
    const Trial trial =
        trialFrom(experiment.trial, "dynamometer", model_, {.prescribed = {coordinate_.name}});
    SimulationOptions simulation = simulation_;
    simulation.startTime = trial.times[0];
    simulation.duration = simulation.step;
    simulation.prescribed.add(system_.prescribed().front(), {trial.times[0]}, {experiment.from});
    try {
      const Trajectory held = simulateSetting(system_, held_.at(experiment.from).nominal(),
                                              excitationOf(trial, system_), simulation);
      return held.reaction(system_.prescribed().front(), 0);
    } catch (const std::exception&) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  }

  /// ΓᵀΓ/σ² of the coordinate; cuts the trial where the joint would leave its range.
  Suitability informIsotonic(DynamometerExperiment& experiment) const {
    const double holding = holdingForce(experiment);
    if (!std::isfinite(holding)) return Suitability::cannotBeSimulated;
    // the muscles have to move the joint in their direction, against the torque
    if (!(experiment.group == "flexors" ? holding < 0 : holding > 0))
      return Suitability::unsuitable;
    experiment.torque = roundedTorque(experiment.load * holding);
    Table& table = experiment.trial;
    const Index last = table.values.cols() - 1;
    table.values.col(last - 1).setConstant(experiment.torque);
    table.values.col(last).tail(table.values.rows() - 1).setConstant(std::nan(""));

    const ParameterCatalogue& catalogue = letGo_.at(experiment.from);
    std::vector<std::size_t> selection;
    for (const std::size_t index : selection_) {
      selection.push_back(catalogue.find(catalogue_.parameters()[index].name));
    }
    const Trial trial = trialFrom(table, "dynamometer", model_);
    const RecordedTrial recorded = recordedTrial(trial, *free_, simulation_);
    const TrialPredictor predictor(
        catalogue, freeOptions_, recorded.excitation,
        measuredSeries({Observable::Kind::coordinate, Observable::Kind::speed}, coordinate_.name,
                       trial.times),
        std::move(selection), recorded.simulation);
    const TrialPredictor::Linearised at =
        predictor.withSensitivities(predictor.catalogue().values(predictor.selection()));
    const Index rows = rowsInRange(at, trial.times.size());
    if (rows == 0) return Suitability::cannotBeSimulated;
    if (!(trial.times[rows - 1] - trial.times[0] >= dynamometer::shortestIsotonic)) {
      return Suitability::unsuitable;
    }
    table.values.conservativeResize(rows, Eigen::NoChange);
    table.values.col(last) = trials_.unit() * at.outputs.head(rows);
    experiment.to = at.outputs[rows - 1];
    const Eigen::MatrixXd gamma = at.gamma.topRows(rows);
    experiment.fisher = gamma.transpose() * gamma / (question_.angleNoise * question_.angleNoise);
    return Suitability::suitable;
  }

  /// How many rows there are before the joint leaves its range or is too fast, had the parameters
  /// asked for errors of their usual size; 0 if there is no motion.
  /// @param at  coordinates, then their speeds
  Index rowsInRange(const TrialPredictor::Linearised& at, Index rows) const {
    const auto asked = static_cast<Index>(asked_);
    Index k = 0;
    for (; k < rows; ++k) {
      const double q = at.outputs[k], speed = at.outputs[rows + k];
      const double allowance =
          question_.robustness *
          at.gamma.row(k).head(asked).cwiseProduct(sd_.head(asked).transpose()).norm();
      const bool isFine = q - allowance >= coordinate_.rangeMin &&
                          q + allowance <= coordinate_.rangeMax &&
                          std::abs(speed) <= question_.fastest;
      if (!isFine) break;
    }
    return k;
  }

  void choose(std::vector<DynamometerExperiment> all, DynamometerPlan& plan) const {
    const auto p = static_cast<Index>(selection_.size());
    const auto asked = static_cast<Index>(plan.parameters.size());
    // in units of prior deviations I + Λ is S I S + 1; covariance of what is asked for
    const auto covariance = [&](const Eigen::MatrixXd& fisher) -> Eigen::MatrixXd {
      Eigen::MatrixXd A = sd_.asDiagonal() * fisher * sd_.asDiagonal();
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
      plan.bounds.emplace_back(sd_.head(asked).array() *
                               covariance(known).diagonal().array().sqrt());
      plan.chosen.push_back(std::move(*best));
      all.erase(best);
    }
  }

  const Model& model_;
  const MusculoskeletalSystem& system_;
  const SystemOptions& options_;
  const SimulationOptions& simulation_;
  const DynamometerQuestion& question_;
  const Coordinate& coordinate_;
  DynamometerTrials trials_;
  std::map<double, ParameterCatalogue> held_;  ///< by position
  const ParameterCatalogue& catalogue_;        ///< one of them, for names and values
  std::vector<std::size_t> selection_;         ///< what is asked for, then nuisance parameters
  std::size_t asked_;
  Eigen::VectorXd sd_;  ///< of the selection's default priors
  // where the joint is let go
  SystemOptions freeOptions_ = {};
  std::unique_ptr<MusculoskeletalSystem> free_ = nullptr;
  std::map<double, ParameterCatalogue> letGo_ = {};  ///< by position
};

void checkQuestion(const DynamometerQuestion& question) {
  const auto require = [](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument(fmt::format("dynamometer: {}", rule));
  };
  require(!question.parameters.empty(), "no parameter is given");
  require(question.noise > 0 && question.angleNoise > 0 && question.rate > 0 && question.count > 0,
          "noise, rate and count must be > 0");
  require(question.rate <= 1e5, "rate must be at most 1e5 samples per second");
  require(question.robustness >= 0 && question.fastest > 0,
          "surprise must be at least 0 and the largest speed > 0");
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
  for (const double length : question.releases) {
    require(length > 0 && question.releaseSpeed > 0 &&
                dynamometer::releaseIsSampled(length, question.releaseSpeed, question.rate),
            "releases must be > 0 and last at least 8 samples");
  }
  for (const double load : question.loads) {
    require(load > 0 && load < 1, "loads must be above 0 and below 1");
  }
}

}  // namespace

DynamometerPlan planOnDynamometer(const Model& model, const MusculoskeletalSystem& system,
                                  const SystemOptions& options, const SimulationOptions& simulation,
                                  const DynamometerQuestion& question) {
  checkQuestion(question);
  return DynamometerPlanner(model, system, options, simulation, question).plan();
}

}  // namespace bio
