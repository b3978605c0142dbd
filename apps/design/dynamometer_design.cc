#include "design/dynamometer_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bio/analysis/replay.h"
#include "bio/calibration/trial_predictor.h"
#include "bio/design/experiment_design.h"
#include "bio/tables/trial_table.h"
#include "info/estimation/monte_carlo.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/angle_unit.h"
#include "output/output_folder.h"
#include "output/result.h"

namespace app {
namespace {

using Eigen::Index;
using ExperimentKind = DynamometerExperiment::Kind;

constexpr double speedUp = 0.1;    // [s]
constexpr double longest = 20;     // [s]
constexpr double baseline = 0.01;  // excitation of what rests

/// The lists of the options in radians (or metres) and shares.
struct Choices {
  std::vector<double> angles, speeds, efforts;
};

double quantityOf(const std::string& text, bool turns, const char* option) {
  try {
    return turns ? parseAngle(text) : parseNumber(text);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", option, error.what()));
  }
}

/// Whether a turn of this length is long enough for its speed to be reached, and ends soon.
bool turnFits(double length, double speed) {
  return length >= speed * speedUp && length <= speed * longest;
}

/// Sorted, each once.
void makeDistinct(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

Choices choicesOf(const DynamometerOptions& options, const bio::Coordinate& coordinate) {
  Choices choices;
  const bool turns = coordinate.isRotation;
  for (const std::string& text : options.angles) {
    choices.angles.push_back(quantityOf(text, turns, "--angles"));
    const double angle = choices.angles.back();
    if (!(angle >= coordinate.rangeMin && angle <= coordinate.rangeMax)) {
      throw std::invalid_argument(fmt::format(
          "--angles: {} is outside the range of '{}', {:.4g} "
          "to {:.4g} {}",
          text, coordinate.name, coordinate.rangeMin, coordinate.rangeMax, turns ? "rad" : "m"));
    }
  }
  if (choices.angles.empty()) {  // four over the middle four fifths of the range
    const double width = coordinate.rangeMax - coordinate.rangeMin;
    for (int k = 0; k < 4; ++k) {
      choices.angles.push_back(coordinate.rangeMin + width * (0.1 + 0.8 * k / 3));
    }
  }
  makeDistinct(choices.angles);
  const double width = choices.angles.back() - choices.angles.front();
  for (const std::string& text : options.speeds) {
    choices.speeds.push_back(quantityOf(text, turns, "--speeds"));
    if (!(choices.speeds.back() > 0)) {
      throw std::invalid_argument(fmt::format("--speeds: {}, must be > 0", text));
    }
    if (!turnFits(width, choices.speeds.back())) {
      throw std::invalid_argument(fmt::format(
          "--speeds: {}: turns go from the first to the last of --angles and take from {} to {} s, "
          "these would take {:.3g} s",
          text, speedUp, longest, width / choices.speeds.back()));
    }
  }
  if (choices.speeds.empty()) {
    for (const double speed : {30.0, 120.0}) {
      const double given = turns ? speed / radian : speed / 1000;
      if (turnFits(width, given)) choices.speeds.push_back(given);
    }
  }
  for (const double percent : options.efforts) {
    if (!(percent > 100 * baseline && percent <= 100)) {
      throw std::invalid_argument(
          fmt::format("--efforts: {} % MVC, must be > {:g}, which muscles at rest have, and at "
                      "most 100",
                      percent, 100 * baseline));
    }
    choices.efforts.push_back(percent / 100);
  }
  makeDistinct(choices.speeds);
  makeDistinct(choices.efforts);
  return choices;
}

/// 0 to 1 with a straight rise and fall.
double pulseAt(double t, double begin, double end) {
  return std::clamp(std::min((t - begin) / contraction::ramp, (end - t) / contraction::ramp), 0.0,
                    1.0);
}

/// Where a turn of this length [rad] that fits is, t [s] after its begin: the speed rises and falls
/// as a squared sine.
double turnedAt(double t, double length, double speed) {
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

class Planner {
 public:
  Planner(const CommandContext& context, const bio::Model& model,
          const bio::MusculoskeletalSystem& arm, const DynamometerOptions& options, double rate,
          const SimulationOptions& simulation, const std::vector<std::string>& parameters,
          const std::vector<std::string>& nuisance)
      : context_(context),
        model_(model),
        arm_(arm),
        options_(options),
        rate_(rate),
        simulation_(simulation),
        coordinate_(arm.skeleton().coordinates().front()),
        catalogue_(model, arm, {arm.skeleton().defaultValues(), {}}),
        selection_(catalogue_.select(parameters)) {
    asked_ = selection_.size();
    if (nuisance.empty()) return;
    for (const std::size_t index : catalogue_.select(nuisance)) {
      if (std::find(selection_.begin(), selection_.end(), index) == selection_.end()) {
        selection_.push_back(index);
      }
    }
  }

  const bio::Coordinate& coordinate() const { return coordinate_; }

  DynamometerPlan plan() {
    std::vector<DynamometerExperiment> all = candidates();
    info::parallelFor(static_cast<int>(all.size()), context_.threads,
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
    const Choices choices = choicesOf(options_, coordinate_);
    std::vector<DynamometerExperiment> all;
    const auto groups = bio::flexorsAndExtensors(arm_, arm_.skeleton().defaultValues());
    for (const bio::MuscleGroup& group : groups) {
      for (const double effort : choices.efforts) {
        for (const double angle : choices.angles) {
          all.push_back({ExperimentKind::isometric, angle, angle, 0, group.name, effort, {}, {}});
        }
      }
    }
    const double low = choices.angles.front(), high = choices.angles.back();
    for (const double speed : choices.speeds) {
      for (const auto& [from, to] : {std::pair{low, high}, std::pair{high, low}}) {
        all.push_back({ExperimentKind::passive, from, to, speed, "", 0, {}, {}});
        for (const bio::MuscleGroup& group : groups) {
          for (const double effort : choices.efforts) {
            all.push_back(
                {ExperimentKind::isokinetic, from, to, speed, group.name, effort, {}, {}});
          }
        }
      }
    }
    for (DynamometerExperiment& one : all) one.trial = trialOf(one, groups);
    return all;
  }

  bio::Table trialOf(const DynamometerExperiment& one,
                     const std::vector<bio::MuscleGroup>& groups) const {
    const double length = std::abs(one.to - one.from);
    const double turning =
        one.kind == ExperimentKind::isometric ? contraction::hold : length / one.speed + speedUp;
    const double begin =
        contraction::rest + contraction::ramp + (one.kind == ExperimentKind::isometric ? 0 : 0.2);
    const double end = begin + turning + (one.kind == ExperimentKind::isometric ? 0 : 0.2);
    const double duration = end + contraction::ramp + contraction::after;
    bio::Table table;
    table.name = "dynamometer";
    table.columns = {"time"};
    for (const bio::SystemMuscle& muscle : arm_.muscles()) table.columns.push_back(muscle.name);
    table.columns.push_back(coordinate_.name + (coordinate_.isRotation ? "_deg" : ""));
    const auto rows = static_cast<Index>(std::floor(duration * rate_)) + 1;
    table.values.resize(rows, static_cast<Index>(table.columns.size()));
    const double unit = coordinate_.isRotation ? radian : 1;
    for (Index k = 0; k < rows; ++k) {
      const double t = static_cast<double>(k) / rate_;
      table.values(k, 0) = t;
      for (Index m = 1; m + 1 < table.values.cols(); ++m) {
        const std::string& muscle = table.columns[static_cast<std::size_t>(m)];
        const double effort = contracts(one, groups, muscle) ? one.effort : 0;
        table.values(k, m) = baseline + std::max(0.0, effort - baseline) *
                                            pulseAt(t, contraction::rest, end + contraction::ramp);
      }
      const double turned =
          one.kind == ExperimentKind::isometric ? 0 : turnedAt(t - begin, length, one.speed);
      table.values(k, table.values.cols() - 1) =
          unit * (one.from + (one.to > one.from ? turned : -turned));
    }
    return table;
  }

  static bool contracts(const DynamometerExperiment& one,
                        const std::vector<bio::MuscleGroup>& groups, const std::string& muscle) {
    for (const bio::MuscleGroup& group : groups) {
      if (group.name != one.group) continue;
      return std::find(group.muscles.begin(), group.muscles.end(), muscle) != group.muscles.end();
    }
    return false;
  }

  /// ΓᵀΓ/σ² of the moment.
  void inform(DynamometerExperiment& one) const {
    const bio::Trial trial =
        bio::trialFrom(one.trial, "dynamometer", model_, {.prescribed = {coordinate_.name}});
    bio::SimulationOptions simulation =
        simulationOptions(simulation_, trial.times[0], trial.duration());
    simulation.prescribed = bio::prescribedMotionOf(trial, arm_);
    const bio::TrialPredictor predictor(
        catalogue_, armOptions(simulation_), bio::excitationOf(trial, arm_),
        {{{bio::Observable::Kind::moment, coordinate_.name, 0}, trial.times}}, selection_,
        simulation);
    const Eigen::MatrixXd gamma = predictor.withSensitivities(catalogue_.values(selection_)).gamma;
    if (!gamma.allFinite()) return;
    one.fisher = gamma.transpose() * gamma / (options_.momentNoise * options_.momentNoise);
  }

  /// One after the other, each the one that adds most to what the ones before tell; none twice,
  /// since its error of the model would be the same again.
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
    for (int n = 0; n < options_.count && !all.empty(); ++n) {
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

  const CommandContext& context_;
  const bio::Model& model_;
  const bio::MusculoskeletalSystem& arm_;
  const DynamometerOptions& options_;
  double rate_;
  const SimulationOptions& simulation_;
  const bio::Coordinate& coordinate_;
  bio::ParameterCatalogue catalogue_;
  std::vector<std::size_t> selection_;  ///< what is asked for, then nuisance parameters
  std::size_t asked_ = 0;
};

/// What moves beside the dynamometer's coordinate, or what else is said of that.
void checkRoles(const DynamometerOptions& options, const SimulationOptions& simulation,
                const bio::Model& model) {
  if (!simulation.coordinates.empty()) {
    throw std::invalid_argument(
        "--coordinate cannot be combined with --dynamometer: nothing moves freely there");
  }
  for (const Assignment& lock : simulation.locks) {
    if (lock.name != options.coordinate) continue;
    throw std::invalid_argument(fmt::format(
        "--lock {}: is held and turned by the dynamometer, must not be locked", lock.name));
  }
  SimulationOptions others = simulation;
  others.prescribed = {options.coordinate};
  refusePrescribedByModel(others, model);
}

}  // namespace

void addDynamometerOptions(CLI::App& options, DynamometerOptions& dynamometer) {
  const std::string group = "Dynamometer";
  CLI::Option* const asked =
      options
          .add_option(
              "--dynamometer", dynamometer.coordinate,
              "instead of TRIAL: a dynamometer holds or turns this coordinate and measures its "
              "moment; rank isometric, isokinetic and passive experiments by what they tell of "
              "--parameters, with default priors")
          ->type_name("NAME")
          ->group(group);
  const auto list = [&](const char* name, auto& target, const char* text, const char* type) {
    options.add_option(name, target, text)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name(type)
        ->needs(asked)
        ->group(group);
  };
  list("--angles", dynamometer.angles,
       "positions to hold; turns go between the first and the last; default: four in the range",
       "20deg,60deg,…");
  list("--speeds", dynamometer.speeds,
       "speeds of turns, per second; default: 30deg,120deg, as far as they "
       "fit between the angles",
       "30deg,120deg,…");
  list("--efforts", dynamometer.efforts, "contractions of flexors and of extensors [% MVC]",
       "30,60,…");
  options.add_option("--experiments", dynamometer.count, "how many are wanted")
      ->check(CLI::Range(1, 100))
      ->capture_default_str()
      ->type_name("N")
      ->needs(asked)
      ->group(group);
  options.add_option("--moment-noise", dynamometer.momentNoise, "noise of a sample of the moment")
      ->capture_default_str()
      ->type_name("NM")
      ->needs(asked)
      ->group(group);
}

ExitStatus designOnDynamometer(const CommandContext& context, const std::string& modelFile,
                               const std::vector<std::string>& parameters,
                               const std::vector<std::string>& nuisance,
                               const DynamometerOptions& options, double rate,
                               const SimulationOptions& typed) {
  if (!(options.momentNoise > 0 && std::isfinite(options.momentNoise))) {
    throw std::invalid_argument(
        fmt::format("--moment-noise: {} N·m, must be > 0", options.momentNoise));
  }
  std::vector<std::string> names;
  for (int n = 1; n <= options.count; ++n) names.push_back(fmt::format("experiment_{}.csv", n));
  OutputFolder folder(context, names);
  Summary summary(context);
  const bio::Model model = readModel(modelFile, summary);
  checkRoles(options, typed, model);
  SimulationOptions simulation = typed;
  simulation.prescribed = {options.coordinate};
  const bio::MusculoskeletalSystem arm = movableSystem(model, modelFile, simulation, summary);
  Planner planner(context, model, arm, options, rate, simulation, parameters, nuisance);
  const bool turns = planner.coordinate().isRotation;
  const DynamometerPlan plan = planner.plan();
  for (std::size_t n = 0; n < plan.chosen.size(); ++n) {
    folder.writeFile(names[n], [&](const std::filesystem::path& path) {
      bio::writeTable(plan.chosen[n].trial, path);
    });
  }
  if (plan.failed > 0) {
    summary.warn(fmt::format("{} of {} experiments cannot be simulated and were left out",
                             plan.failed, plan.candidates));
  }
  tellDynamometer(plan, turns, summary);
  deliver(context, summary, dynamometerReport(plan, options, turns), folder);
  return ExitStatus::done;
}

}  // namespace app
