#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <variant>

#include "arguments/columns.h"
#include "bio/analysis/replay.h"
#include "bio/analysis/sensitivity_study.h"
#include "bio/design/design_setup.h"
#include "bio/design/separating_design.h"
#include "bio/model/units.h"
#include "docstrings.h"
#include "interruptible.h"
#include "systems.h"
#include "trials/trials.h"

namespace python {
namespace {

/// One number for all free coordinates, or by name.
using OneOrNamed = std::variant<double, std::map<std::string, double>>;
using Range = std::variant<std::monostate, std::pair<double, double>,
                           std::map<std::string, std::pair<double, double>>>;

template <class Value, class Given>
std::map<std::string, Value> byName(const Given& given) {
  if (const auto* one = std::get_if<Value>(&given)) return {{"", *one}};
  if (const auto* all = std::get_if<std::map<std::string, Value>>(&given)) return *all;
  return {};
}

/// The inputs that a search may change, within which limits, and what it observes.
struct SearchInputs {
  std::map<std::string, double> observe;  ///< name and noise; empty: the free coordinates
  double noise;                           ///< of these
  OneOrNamed torque;
  double torqueRate;
  std::vector<std::string> excite;
  double excitationMax, excitationRate;
  Range range;
  OneOrNamed speed;

  bio::DesignLimits limits(const bio::MusculoskeletalSystem& system) const {
    bio::DesignLimits limits;
    limits.torqueRate = torqueRate;
    limits.largestExcitation = excitationMax;
    limits.excitationRate = excitationRate;
    bio::GivenLimits given;
    given.range = byName<std::pair<double, double>>(range);
    given.torque = byName<double>(torque);
    // what is not named has the default
    for (const auto& [name, value] : byName<double>(speed)) given.speed[name] = value;
    return bio::withCoordinates(limits, system, given);
  }

  std::vector<bio::ChannelCandidate> observed(const bio::Model& model,
                                              const bio::MusculoskeletalSystem& system) const {
    if (!observe.empty()) {
      return bio::observedChannels({observe.begin(), observe.end()}, model, system);
    }
    return bio::freeCoordinates(system, noise, noise);
  }
};

double periodOf(double rate) {
  if (rate > 0 && std::isfinite(rate)) return 1 / rate;
  throw std::invalid_argument(fmt::format("rate = {} Hz, must be > 0", rate));
}

bio::DesignSearchSettings settingsOf(int candidates, int generations, int iterations,
                                     std::uint64_t seed, int threads, const std::atomic<bool>& goOn,
                                     std::atomic<double>& done) {
  return {candidates, generations, iterations, seed, threads, noting(goOn, done)};
}

/// Course of a search; the first value is that of the trial itself.
Eigen::VectorXd courseOf(double before, const std::vector<double>& found) {
  Eigen::VectorXd all(std::ssize(found) + 1);
  all << before, Eigen::VectorXd::Map(found.data(), std::ssize(found));
  return all;
}

/// A vector where there is one column.
py::object flat(const Eigen::MatrixXd& values) {
  if (values.cols() == 1) return py::cast(Eigen::VectorXd(values.col(0)));
  return py::cast(values);
}

/// A number where there is one.
template <class List, class Number>
py::object each(const List& list, const Number& number) {
  if (list.size() == 1) return py::cast(number(list.front()));
  Eigen::VectorXd values(std::ssize(list));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values[i] = number(list[static_cast<std::size_t>(i)]);
  }
  return py::cast(values);
}

std::vector<std::string> namesOf(const std::vector<bio::ChannelCandidate>& observed) {
  std::vector<std::string> names;
  for (const bio::ChannelCandidate& candidate : observed) names.push_back(nameOf(candidate.what));
  return names;
}

std::vector<std::string> namesOf(const std::vector<bio::CoordinateLimits>& limits) {
  std::vector<std::string> names;
  for (const bio::CoordinateLimits& limit : limits) names.push_back(limit.coordinate);
  return names;
}

/// How a planned trial is read again.
bio::Trial readAgain(const bio::Table& table, const bio::Trial& trial, const bio::Model& model) {
  bio::TrialOptions options{.experimentalConditions = true};
  for (const bio::MeasuredChannel& course : trial.prescribed) {
    if (course.times.size() > 1) options.prescribed.push_back(course.what.object);
    if (course.times.size() == 1) options.held[course.what.object] = course.values[0];
  }
  return trialOf(table, "designed experiment", model, options);
}

py::object monteCarloOf(const std::optional<info::MonteCarloResult>& found) {
  if (!found) return py::none();
  return results(
      "mean"_a = found->mean, "sd"_a = Eigen::VectorXd(found->covariance.diagonal().cwiseSqrt()),
      "bound"_a = Eigen::VectorXd(found->bound.diagonal().cwiseSqrt()),
      "converged"_a = found->converged, "trials"_a = static_cast<int>(found->trials.size()));
}

py::object largestTorques(const bio::DesignInputs& inputs, const bio::Trial& trial) {
  return each(inputs.limits().coordinates, [&](const bio::CoordinateLimits& limits) {
    return inputs.largestTorque(trial, limits.coordinate);
  });
}

py::object largestTorqueRates(const bio::DesignInputs& inputs, const bio::Trial& trial) {
  return each(inputs.limits().coordinates, [&](const bio::CoordinateLimits& limits) {
    return inputs.largestTorqueRate(trial, limits.coordinate);
  });
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
  const bio::Table table = bio::plannedTable(search.system(), e.trial);
  const bio::DesignInputs& inputs = search.inputs();
  const auto& limits = inputs.limits().coordinates;
  const auto ofRange = [&](double bio::MotionRange::*number) {
    return each(e.ranges, [&](const bio::MotionRange& range) { return range.*number; });
  };
  return tableResult(
      "DesignResult", "improved"_a = found.improved, "names"_a = names, "units"_a = units,
      "values"_a = catalogue.values(all), "of_interest"_a = ofInterest,
      "prior_sd"_a = question.priorSd, "bound_before"_a = found.before.bound,
      "bound_after"_a = e.bound, "columns"_a = columnsOf(table),
      "trial"_a = readAgain(table, e.trial, model), "times"_a = e.measuredTimes,
      "observed"_a = namesOf(question.observed), "predicted"_a = flat(e.measured),
      "predicted_before"_a = flat(found.before.measured),
      "surprise"_a = flat(search.allowanceAt(e)), "bound_over_time"_a = search.boundOverTime(e),
      "bound_over_time_before"_a = search.boundOverTime(found.before),
      "coordinates"_a = namesOf(limits), "lowest"_a = ofRange(&bio::MotionRange::lowest),
      "highest"_a = ofRange(&bio::MotionRange::highest),
      "surprised_lowest"_a = ofRange(&bio::MotionRange::surprisedLowest),
      "surprised_highest"_a = ofRange(&bio::MotionRange::surprisedHighest),
      "largest_speed"_a = ofRange(&bio::MotionRange::fastest),
      "largest_torque"_a = largestTorques(inputs, e.trial),
      "largest_torque_rate"_a = largestTorqueRates(inputs, e.trial),
      "largest_excitation_rate"_a = inputs.largestExcitationRate(e.trial),
      "costs"_a = courseOf(found.costBefore, found.costs), "found_at"_a = found.foundAt,
      "simulations"_a = found.runs, "impossible_simulations"_a = found.impossible,
      "monte_carlo"_a = monteCarloOf(monteCarlo));
}

py::object design(const bio::Model& model, const bio::Trial& trial,
                  const std::vector<std::string>& parameters,
                  const std::vector<std::string>& nuisance, bool priors,
                  const std::map<std::string, double>& prior, const std::string& criterion,
                  const std::map<std::string, double>& observe, double noise, double rate,
                  const OneOrNamed& torque, double torqueRate,
                  const std::vector<std::string>& excite, double excitationMax,
                  double excitationRate, const Range& range, const OneOrNamed& speed,
                  double robustness, double knots, int candidates, int generations, int iterations,
                  int monteCarlo, std::uint64_t seed, int threads,
                  const std::map<std::string, double>& initial, const py::object& progress,
                  const Names& coordinate, const std::map<std::string, double>& lock,
                  const std::string& integrator, std::optional<double> step) {
  const SystemChoice choice = systemChoice(model, {trial}, coordinate, lock, integrator, step);
  mustBeOfTheModelAsItIs(trial);
  if (monteCarlo < 0 || (monteCarlo > 0 && !nuisance.empty())) {
    throw std::invalid_argument(
        fmt::format("monte_carlo = {}, must be ≥ 0, and 0 with nuisance parameters", monteCarlo));
  }
  const SearchInputs inputs{observe,       noise,          torque, torqueRate, excite,
                            excitationMax, excitationRate, range,  speed};
  bio::DesignQuestion question;
  question.period = periodOf(rate);
  question.criterion = bio::optimalityNamed(criterion);
  std::optional<bio::MusculoskeletalSystem> system;
  std::optional<bio::ParameterCatalogue> catalogue;
  std::optional<bio::ExperimentDesign> search;
  std::optional<info::MonteCarloResult> repeated;
  bio::DesignResult found;
  interruptible({progress, "design"}, [&](const auto& goOn, auto& done) {
    system.emplace(model, choice.systemOptions());
    const Eigen::VectorXd start = bio::beginningOf(trial, model, *system, initial).point.q;
    catalogue.emplace(model, *system, bio::StartPoint{start, {}});
    question.observed = inputs.observed(model, *system);
    bio::DesignLimits limits = inputs.limits(*system);
    limits.robustness = robustness;
    const bio::SimulationOptions simulation = during(trial, choice.simulation());
    search.emplace(*system, *catalogue, catalogue->nominal(), trial, simulation,
                   bio::designQuestion(*catalogue, {parameters, nuisance, priors, prior}, question),
                   limits, bio::muscleGroups(*system, start, excite), knots);
    found =
        search->search(settingsOf(candidates, generations, iterations, seed, threads, goOn, done));
    if (monteCarlo == 0 || found.stopped) return;
    info::MonteCarloOptions repetitions;
    repetitions.trials = monteCarlo;
    repetitions.seed = seed;
    repetitions.threads = threads;
    repetitions.progress = [&](int, int) { return goOn.load(); };
    repeated = bio::simulatedRepetitions(*search, found.after, *catalogue, choice.systemOptions(),
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
  const bio::Table table = bio::plannedTable(search.system(), e.trial);
  const bio::DesignInputs& inputs = search.inputs();
  const auto ofRange = [&](double bio::MotionExtremes::*number) {
    return each(e.ranges, [&](const auto& range) { return range.*number; });
  };
  std::vector<double> nats;
  for (const double cost : found.costs) nats.push_back(-cost);
  const std::vector<double>& times = search.inputs().measuredTimes();
  return results("improved"_a = found.improved,
                 "effects"_a = std::vector<std::string>{question.first, question.second},
                 "size"_a = both(question.firstSize, question.secondSize),
                 "unit"_a = both(search.unitOfFirst(), search.unitOfSecond()),
                 "nats_before"_a = both(before.firstOverSecond, before.secondOverFirst),
                 "nats_after"_a = both(after.firstOverSecond, after.secondOverFirst),
                 "bound_before"_a = both(before.firstDeviation, before.secondDeviation),
                 "bound_after"_a = both(after.firstDeviation, after.secondDeviation),
                 "columns"_a = columnsOf(table), "trial"_a = readAgain(table, e.trial, model),
                 "times"_a = Eigen::VectorXd(Eigen::VectorXd::Map(times.data(), std::ssize(times))),
                 "observed"_a = namesOf(question.observed), "predicted"_a = flat(e.base),
                 "predicted_with"_a = both(flat(e.first), flat(e.second)),
                 "coordinates"_a = namesOf(inputs.limits().coordinates),
                 "lowest"_a = ofRange(&bio::MotionExtremes::lowest),
                 "highest"_a = ofRange(&bio::MotionExtremes::highest),
                 "largest_speed"_a = ofRange(&bio::MotionExtremes::fastest),
                 "largest_torque"_a = largestTorques(inputs, e.trial),
                 "largest_torque_rate"_a = largestTorqueRates(inputs, e.trial),
                 "largest_excitation_rate"_a = inputs.largestExcitationRate(e.trial),
                 "nats"_a = courseOf(before.least(), nats), "found_at"_a = found.foundAt,
                 "simulations"_a = found.runs, "impossible_simulations"_a = found.impossible);
}

py::object separate(const bio::Model& model, const bio::Trial& trial, const std::string& first,
                    const std::string& second, const std::map<std::string, double>& size,
                    const std::map<std::string, double>& observe, double noise, double rate,
                    const OneOrNamed& torque, double torqueRate,
                    const std::vector<std::string>& excite, double excitationMax,
                    double excitationRate, const Range& range, const OneOrNamed& speed,
                    double knots, int candidates, int generations, std::uint64_t seed, int threads,
                    const std::map<std::string, double>& initial, const py::object& progress,
                    const Names& coordinate, const std::map<std::string, double>& lock,
                    const std::string& integrator, std::optional<double> step) {
  const SystemChoice choice = systemChoice(model, {trial}, coordinate, lock, integrator, step);
  const SearchInputs inputs{observe,       noise,          torque, torqueRate, excite,
                            excitationMax, excitationRate, range,  speed};
  bio::discover::SeparationQuestion question;
  question.first = first;
  question.second = second;
  question.period = periodOf(rate);
  question = bio::discover::withSizes(question, size);
  std::optional<bio::discover::SeparatingDesign> search;
  bio::discover::SeparatingResult found;
  interruptible({progress, "separate"}, [&](const auto& goOn, auto& done) {
    const bio::MusculoskeletalSystem system(model, choice.systemOptions());
    const Eigen::VectorXd start = bio::startCoordinates(trial, system, initial);
    for (Eigen::Index i = 0; i < start.size(); ++i) {
      question.start[system.skeleton().coordinates()[static_cast<std::size_t>(i)].name] = start[i];
    }
    question.observed = inputs.observed(model, system);
    bio::discover::MusculoskeletalProblemOptions options;
    options.simulation = during(trial, choice.simulation());
    search.emplace(model, choice.systemOptions(), trial, options, question, inputs.limits(system),
                   bio::muscleGroups(system, system.skeleton().defaultValues(), excite), knots);
    found = search->search(settingsOf(candidates, generations, 0, seed, threads, goOn, done));
  });
  return separated(*search, found, model);
}

}  // namespace

void defineDesign(py::module_& module) {
  using Given = std::map<std::string, double>;
  using List = std::vector<std::string>;
  defineWithChoice(
      module, "design", &design, docstrings::design, "model"_a, "trial"_a, "parameters"_a,
      py::kw_only(), "nuisance"_a = List(), "priors"_a = false, "prior"_a = Given(),
      "criterion"_a = "E", "observe"_a = Given(), "noise"_a = 0.5 * bio::radiansPerDegree,
      "rate"_a = 100.0, "torque"_a = 10.0, "torque_rate"_a = 50.0, "excite"_a = List(),
      "excitation_max"_a = 0.5, "excitation_rate"_a = 2.0, "range"_a = py::none(),
      "speed"_a = 500 * bio::radiansPerDegree, "surprise"_a = 0.5, "knots"_a = 0.3,
      "candidates"_a = 100, "generations"_a = 100, "iterations"_a = 10, "monte_carlo"_a = 0,
      "seed"_a = 1, "threads"_a = 1, "initial"_a = Given(), "progress"_a = false);
  defineWithChoice(module, "separate", &separate, docstrings::separate, "model"_a, "trial"_a,
                   "first"_a, "second"_a, py::kw_only(), "size"_a = Given(), "observe"_a = Given(),
                   "noise"_a = 0.5 * bio::radiansPerDegree, "rate"_a = 100.0, "torque"_a = 10.0,
                   "torque_rate"_a = 50.0, "excite"_a = List(), "excitation_max"_a = 0.5,
                   "excitation_rate"_a = 2.0, "range"_a = py::none(),
                   "speed"_a = 500 * bio::radiansPerDegree, "knots"_a = 0.3, "candidates"_a = 100,
                   "generations"_a = 100, "seed"_a = 1, "threads"_a = 1, "initial"_a = Given(),
                   "progress"_a = false);
}

}  // namespace python
