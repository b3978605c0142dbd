#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "arguments/columns.h"
#include "arms.h"
#include "bio/analysis/replay.h"
#include "bio/design/design_setup.h"
#include "bio/design/separating_design.h"
#include "docstrings.h"
#include "interruptible.h"

namespace python {
namespace {

constexpr double degree = std::numbers::pi / 180;

using Range = std::optional<std::pair<double, double>>;

/// Inputs that a search may change, and their limits.
struct SearchInputs {
  double torque, torqueRate;
  std::vector<std::string> excite;
  double excitationMax, excitationRate;
  Range range;
  double speed;

  bio::DesignLimits limits(const bio::Coordinate& coordinate) const {
    bio::DesignLimits limits;
    limits.torque = torque;
    limits.torqueRate = torqueRate;
    limits.largestExcitation = excitationMax;
    limits.excitationRate = excitationRate;
    limits.speed = speed;
    return bio::withinRange(limits, coordinate, range);
  }
};

/// Free coordinates alone.
SystemChoice freeChoice(const bio::Model& model, const bio::Trial& trial, const Names& coordinate,
                        const std::map<std::string, double>& lock, const std::string& integrator,
                        std::optional<double> step) {
  SystemChoice choice = armChoice(model, {trial}, coordinate, lock, integrator, step);
  if (!choice.prescribed.empty()) {
    throw std::invalid_argument(
        fmt::format("'{}' is prescribed, which a design does not take: lock it or make it free",
                    choice.prescribed.front()));
  }
  return choice;
}

double periodOf(double rate) {
  if (rate > 0 && std::isfinite(rate)) return 1 / rate;
  throw std::invalid_argument(fmt::format("rate = {} Hz, must be > 0", rate));
}

bio::DesignSearchSettings settingsOf(int candidates, int generations, int iterations,
                                     std::uint64_t seed, int threads,
                                     const std::atomic<bool>& goOn) {
  return {candidates, generations, iterations, seed, threads, [&](double) { return goOn.load(); }};
}

/// Course of a search; the first value is that of the trial itself.
Eigen::VectorXd courseOf(double before, const std::vector<double>& found) {
  Eigen::VectorXd all(std::ssize(found) + 1);
  all << before, Eigen::VectorXd::Map(found.data(), std::ssize(found));
  return all;
}

py::object monteCarloOf(const std::optional<info::MonteCarloResult>& found) {
  if (!found) return py::none();
  return results(
      "mean"_a = found->mean, "sd"_a = Eigen::VectorXd(found->covariance.diagonal().cwiseSqrt()),
      "bound"_a = Eigen::VectorXd(found->bound.diagonal().cwiseSqrt()),
      "converged"_a = found->converged, "trials"_a = static_cast<int>(found->trials.size()));
}

py::object designed(const bio::ExperimentDesign& search, const bio::DesignResult& found,
                    const bio::ParameterCatalogue& catalogue, const bio::Model& model,
                    const std::optional<info::MonteCarloResult>& monteCarlo) {
  const bio::DesignQuestion& question = search.question();
  std::vector<std::string> names, units;
  std::vector<bool> ofInterest;
  std::vector<std::size_t> all = question.parameters;
  all.insert(all.end(), question.nuisance.begin(), question.nuisance.end());
  for (const std::size_t index : all) {
    ofInterest.push_back(names.size() < question.parameters.size());
    names.push_back(catalogue.parameters()[index].name);
    units.push_back(catalogue.parameters()[index].unit);
  }
  const bio::DesignedExperiment& e = found.after;
  const bio::Table table = bio::designTable(search.arm(), e, question.coordinate);
  return results(
      "improved"_a = found.improved, "names"_a = names, "units"_a = units,
      "values"_a = catalogue.values(all), "of_interest"_a = ofInterest,
      "prior_sd"_a = question.priorSd, "bound_before"_a = found.before.bound,
      "bound_after"_a = e.bound, "columns"_a = columnsOf(table),
      "trial"_a = trialOf(table, "designed experiment", model, {}), "times"_a = e.measuredTimes,
      "predicted"_a = e.measured, "predicted_before"_a = found.before.measured,
      "surprise"_a = search.surpriseAt(e), "bound_over_time"_a = search.boundOverTime(e),
      "bound_over_time_before"_a = search.boundOverTime(found.before), "lowest"_a = e.lowest,
      "highest"_a = e.highest, "surprised_lowest"_a = e.surprisedLowest,
      "surprised_highest"_a = e.surprisedHighest, "largest_speed"_a = e.fastest,
      "largest_torque"_a = e.largestTorque, "largest_torque_rate"_a = e.largestTorqueRate,
      "largest_excitation_rate"_a = e.largestExcitationRate,
      "costs"_a = courseOf(found.costBefore, found.costs), "found_at"_a = found.foundAt,
      "simulations"_a = found.runs, "impossible_simulations"_a = found.impossible,
      "monte_carlo"_a = monteCarloOf(monteCarlo));
}

py::object design(const bio::Model& model, const bio::Trial& trial,
                  const std::vector<std::string>& parameters,
                  const std::vector<std::string>& nuisance, bool priors,
                  const std::map<std::string, double>& prior, const std::string& criterion,
                  double noise, double rate, double torque, double torqueRate,
                  const std::vector<std::string>& excite, double excitationMax,
                  double excitationRate, const Range& range, double speed, double surprise,
                  double knots, int candidates, int generations, int iterations, int monteCarlo,
                  std::uint64_t seed, int threads, const std::map<std::string, double>& initial,
                  const Names& coordinate, const std::map<std::string, double>& lock,
                  const std::string& integrator, std::optional<double> step) {
  const SystemChoice choice = freeChoice(model, trial, coordinate, lock, integrator, step);
  mustBeOfTheModelAsItIs(trial);
  if (monteCarlo < 0 || (monteCarlo > 0 && !nuisance.empty())) {
    throw std::invalid_argument(
        fmt::format("monte_carlo = {}, must be ≥ 0, and 0 with nuisance parameters", monteCarlo));
  }
  const SearchInputs inputs{torque,         torqueRate, excite, excitationMax,
                            excitationRate, range,      speed};
  bio::DesignQuestion question;
  question.noise = noise;
  question.period = periodOf(rate);
  question.criterion = bio::optimalityNamed(criterion);
  std::optional<bio::MusculoskeletalSystem> arm;
  std::optional<bio::ParameterCatalogue> catalogue;
  std::optional<bio::ExperimentDesign> search;
  std::optional<info::MonteCarloResult> repeated;
  bio::DesignResult found;
  interruptible([&](const std::atomic<bool>& goOn) {
    arm.emplace(model, choice.armOptions());
    const Eigen::VectorXd start = bio::beginningOf(trial, model, *arm, initial).point.q;
    catalogue.emplace(model, *arm, bio::StartPoint{start, {}});
    const bio::Coordinate& measured = arm->skeleton().coordinates().front();
    question.coordinate = measured.name;
    bio::DesignLimits limits = inputs.limits(measured);
    limits.surprise = surprise;
    const bio::SimulationOptions simulation = during(trial, choice.simulation());
    search.emplace(*arm, *catalogue, catalogue->nominal(), trial, simulation,
                   bio::designQuestion(*catalogue, {parameters, nuisance, priors, prior}, question),
                   limits, bio::muscleGroups(*arm, start, excite), knots);
    found = search->search(settingsOf(candidates, generations, iterations, seed, threads, goOn));
    if (monteCarlo == 0 || found.stopped) return;
    info::MonteCarloOptions repetitions;
    repetitions.trials = monteCarlo;
    repetitions.seed = seed;
    repetitions.threads = threads;
    repetitions.progress = [&](int, int) { return goOn.load(); };
    repeated = bio::simulatedRepetitions(*search, found.after, *catalogue, choice.armOptions(),
                                         simulation, repetitions);
  });
  return designed(*search, found, *catalogue, model, repeated);
}

py::object separated(const bio::discover::SeparatingDesign& search,
                     const bio::discover::SeparatingResult& found, const bio::Model& model) {
  const auto& question = search.question();
  const auto both = [&](const auto& first, const auto& second) {
    py::dict values;
    values[question.first.c_str()] = first;
    values[question.second.c_str()] = second;
    return values;
  };
  const auto& before = found.before.tells;
  const auto& after = found.after.tells;
  const bio::discover::SeparatingExperiment& e = found.after;
  const bio::Table table = bio::discover::separatingTable(search, e);
  const std::vector<double>& times = search.inputs().measuredTimes();
  return results(
      "improved"_a = found.improved,
      "effects"_a = std::vector<std::string>{question.first, question.second},
      "size"_a = both(question.firstSize, question.secondSize),
      "unit"_a = both(search.unitOfFirst(), search.unitOfSecond()),
      "nats_before"_a = both(before.firstOverSecond, before.secondOverFirst),
      "nats_after"_a = both(after.firstOverSecond, after.secondOverFirst),
      "bound_before"_a = both(before.firstDeviation, before.secondDeviation),
      "bound_after"_a = both(after.firstDeviation, after.secondDeviation),
      "columns"_a = columnsOf(table),
      "trial"_a = trialOf(table, "designed experiment", model, {.experimentalConditions = true}),
      "times"_a = Eigen::VectorXd(Eigen::VectorXd::Map(times.data(), std::ssize(times))),
      "predicted"_a = e.base, "predicted_with"_a = both(e.first, e.second), "lowest"_a = e.lowest,
      "highest"_a = e.highest, "largest_speed"_a = e.fastest,
      "largest_torque"_a = search.inputs().torqueOf(e.trial).cwiseAbs().maxCoeff(),
      "largest_torque_rate"_a = search.inputs().largestTorqueRate(e.trial),
      "largest_excitation_rate"_a = search.inputs().largestExcitationRate(e.trial),
      "nats"_a = courseOf(before.least(), found.nats), "found_at"_a = found.foundAt,
      "simulations"_a = found.runs, "impossible_simulations"_a = found.impossible);
}

py::object separate(const bio::Model& model, const bio::Trial& trial, const std::string& first,
                    const std::string& second, const std::map<std::string, double>& size,
                    double noise, double rate, double torque, double torqueRate,
                    const std::vector<std::string>& excite, double excitationMax,
                    double excitationRate, const Range& range, double speed, double knots,
                    int candidates, int generations, std::uint64_t seed, int threads,
                    const std::map<std::string, double>& initial, const Names& coordinate,
                    const std::map<std::string, double>& lock, const std::string& integrator,
                    std::optional<double> step) {
  const SystemChoice choice = freeChoice(model, trial, coordinate, lock, integrator, step);
  const SearchInputs inputs{torque,         torqueRate, excite, excitationMax,
                            excitationRate, range,      speed};
  bio::discover::SeparationQuestion question;
  question.first = first;
  question.second = second;
  question.noise = noise;
  question.period = periodOf(rate);
  question = bio::discover::withSizes(question, size);
  std::optional<bio::discover::SeparatingDesign> search;
  bio::discover::SeparatingResult found;
  interruptible([&](const std::atomic<bool>& goOn) {
    const bio::MusculoskeletalSystem arm(model, choice.armOptions());
    const bio::Coordinate& measured = arm.skeleton().coordinates().front();
    question.start = bio::startCoordinates(trial, arm, initial)[0];
    bio::discover::MusculoskeletalProblemOptions options;
    options.simulation = during(trial, choice.simulation());
    search.emplace(model, choice.armOptions(), measured.name, trial, options, question,
                   inputs.limits(measured),
                   bio::muscleGroups(arm, arm.skeleton().defaultValues(), excite), knots);
    found = search->search(settingsOf(candidates, generations, 0, seed, threads, goOn));
  });
  return separated(*search, found, model);
}

}  // namespace

void defineDesign(py::module_& module) {
  using Given = std::map<std::string, double>;
  using List = std::vector<std::string>;
  defineWithChoice(module, "design", &design, docstrings::design, "model"_a, "trial"_a,
                   "parameters"_a, py::kw_only(), "nuisance"_a = List(), "priors"_a = false,
                   "prior"_a = Given(), "criterion"_a = "E", "noise"_a = 0.5 * degree,
                   "rate"_a = 100.0, "torque"_a = 10.0, "torque_rate"_a = 50.0, "excite"_a = List(),
                   "excitation_max"_a = 0.5, "excitation_rate"_a = 2.0, "range"_a = py::none(),
                   "speed"_a = 500 * degree, "surprise"_a = 0.5, "knots"_a = 0.3,
                   "candidates"_a = 100, "generations"_a = 100, "iterations"_a = 10,
                   "monte_carlo"_a = 0, "seed"_a = 1, "threads"_a = 1, "initial"_a = Given());
  defineWithChoice(module, "separate", &separate, docstrings::separate, "model"_a, "trial"_a,
                   "first"_a, "second"_a, py::kw_only(), "size"_a = Given(),
                   "noise"_a = 0.5 * degree, "rate"_a = 100.0, "torque"_a = 10.0,
                   "torque_rate"_a = 50.0, "excite"_a = List(), "excitation_max"_a = 0.5,
                   "excitation_rate"_a = 2.0, "range"_a = py::none(), "speed"_a = 500 * degree,
                   "knots"_a = 0.3, "candidates"_a = 100, "generations"_a = 100, "seed"_a = 1,
                   "threads"_a = 1, "initial"_a = Given());
}

}  // namespace python
