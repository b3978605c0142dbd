#include <fmt/format.h>
#include <fmt/ranges.h>

#include <numbers>
#include <variant>

#include "arms.h"
#include "bio/analysis/replay.h"
#include "bio/calibration/trial_set.h"
#include "bio/parameters/parameter_information.h"
#include "docstrings.h"
#include "interruptible.h"

namespace python {
namespace {

py::object sensitivity(const bio::Model& model, const std::vector<bio::Trial>& trials,
                       const std::vector<std::string>& parameters, double noise,
                       const Names& freeCoordinates, const std::map<std::string, double>& lock,
                       const std::string& integrator, std::optional<double> step) {
  const SystemChoice choice = armChoice(model, trials, freeCoordinates, lock, integrator, step);
  if (trials.empty()) throw std::invalid_argument("trials: empty, must have at least one");
  if (choice.coordinates.empty()) {
    throw std::invalid_argument("no coordinate is free to be observed: all are prescribed");
  }
  std::vector<Eigen::MatrixXd> gammas;
  std::vector<Eigen::VectorXd> outputs, times;
  bio::ParameterInformation information;
  Eigen::VectorXd values;
  interruptible([&](const std::atomic<bool>& goOn) {
    const bio::MusculoskeletalSystem arm(model, choice.armOptions());
    const std::string coordinate = choice.coordinates.front();
    std::vector<std::size_t> selection;
    for (const bio::Trial& trial : trials) {
      mustBeOfTheModelAsItIs(trial);
      bio::SimulationOptions options = during(trial, choice.simulation());
      options.externalForce = bio::externalForceOf(trial, arm);
      options.prescribed = bio::prescribedMotionOf(trial, arm);
      options.progress = [&](double) { return goOn.load(); };
      const bio::ParameterCatalogue catalogue(model, arm,
                                              {bio::startCoordinates(trial, arm, {}), {}});
      selection = catalogue.select(parameters);
      values = catalogue.values(selection);
      const std::vector<double> observed = bio::observedTimes(trial, coordinate, options.step);
      times.push_back(Eigen::VectorXd::Map(observed.data(), std::ssize(observed)));
      const bio::TrialPredictor experiment(catalogue, choice.armOptions(),
                                           bio::excitationOf(trial, arm), coordinate, observed,
                                           selection, options);
      auto at = experiment.withSensitivities(values);
      if (!goOn) return;
      if (!at.outputs.allFinite()) {
        throw std::invalid_argument(trial.file +
                                    ": the simulation does not reach the end of the trial");
      }
      outputs.push_back(std::move(at.outputs));
      gammas.push_back(std::move(at.gamma));
      if (gammas.size() == trials.size()) {
        information = bio::informationAbout(catalogue, selection, gammas, noise);
      }
    }
  });
  std::vector<std::string> names, units;
  for (const info::Parameter& one : information.parameters) {
    names.push_back(one.name);
    units.push_back(one.unit);
  }
  return results("names"_a = names, "units"_a = units, "values"_a = values, "times"_a = times,
                 "outputs"_a = outputs, "gamma"_a = gammas, "fisher"_a = information.fisher,
                 "normalised_sensitivity"_a = information.normalisedSensitivity,
                 "bound_alone"_a = information.boundAlone, "bound_joint"_a = information.boundJoint,
                 "identifiable"_a = information.identifiable,
                 "correlation"_a = information.correlation, "sentences"_a = information.sentences);
}

/// One σ for all channels with the unit of the first, or one for each by name.
using Noise = std::variant<double, std::map<std::string, double>>;

std::vector<double> noiseOf(const bio::TrialSet& set, const Noise& noise) {
  std::vector<double> sd;
  const auto* named = std::get_if<std::map<std::string, double>>(&noise);
  if (!named && set.channels().size() > 1) {
    std::vector<std::string> names;
    for (const auto& channel : set.channels()) names.push_back("'" + channel.name + "'");
    throw std::invalid_argument(
        fmt::format("noise: must be given for each of {}", fmt::join(names, ", ")));
  }
  for (const auto& channel : set.channels()) {
    if (named && !named->contains(channel.name)) {
      throw std::invalid_argument(fmt::format("noise: must be given for '{}'", channel.name));
    }
    sd.push_back(named ? named->at(channel.name) : std::get<double>(noise));
  }
  return sd;
}

py::object costGradient(const bio::Model& model, const std::vector<bio::Trial>& trials,
                        const std::vector<std::string>& parameters,
                        const std::optional<Eigen::VectorXd>& values, const Noise& noise,
                        bool priors, bool ownStart, int threads, const Names& freeCoordinates,
                        const std::map<std::string, double>& lock, const std::string& integrator,
                        std::optional<double> step) {
  const SystemChoice choice = armChoice(model, trials, freeCoordinates, lock, integrator, step);
  for (const bio::Trial& trial : trials) mustBeOfTheModelAsItIs(trial);
  bio::TrialSetOptions options;
  options.parameters = parameters;
  options.ownStart = ownStart;
  options.simulation = choice.simulation();
  options.simulation.duration = 1;
  options.threads = threads;
  std::vector<std::string> names, units;
  Eigen::VectorXd at, atModel, known;
  bio::TrialSet::Cost cost;
  interruptible([&](const std::atomic<bool>&) {
    const bio::TrialSet set(model, choice.armOptions(), trials, options);
    known = set.known();
    atModel.resize(known.size());
    for (const info::Parameter& one : set.parameters()) {
      atModel[std::ssize(names)] = one.start;
      names.push_back(one.name);
      units.push_back(one.unit);
    }
    at = values.value_or(atModel);
    cost = set.leastSquares(at, noiseOf(set, noise));
  });
  if (priors) {
    const Eigen::VectorXd off = (at - atModel).cwiseQuotient(known);
    cost.value += off.squaredNorm() / 2;
    cost.gradient += off.cwiseQuotient(known);
  }
  std::vector<Eigen::MatrixXd> excitations;
  for (const bio::CostGradient& trial : cost.trials) {
    excitations.push_back(trial.excitation.transpose());
  }
  return results("names"_a = names, "units"_a = units, "values"_a = at, "cost"_a = cost.value,
                 "gradient"_a = cost.gradient, "excitation_gradient"_a = excitations);
}

py::list listParameters(const bio::Model& model, const Names& coordinate,
                        const std::map<std::string, double>& lock, const std::string& integrator,
                        std::optional<double> step) {
  const SystemChoice choice = armChoice(model, {}, coordinate, lock, integrator, step);
  const bio::MusculoskeletalSystem arm(model, choice.armOptions());
  const bio::ParameterCatalogue catalogue(model, arm, {arm.skeleton().defaultValues(), {}});
  py::list list;
  for (const bio::ModelParameter& p : catalogue.parameters()) {
    list.append(results("name"_a = p.name, "value"_a = p.value, "unit"_a = p.unit,
                        "meaning"_a = p.meaning, "lower"_a = p.lower, "upper"_a = p.upper,
                        "deviation"_a = p.sd, "is_group"_a = p.isGroup));
  }
  return list;
}

}  // namespace

void defineSensitivity(py::module_& module) {
  defineWithChoice(module, "list_parameters", &listParameters, docstrings::list_parameters,
                   "model"_a, py::kw_only());
  defineWithChoice(module, "sensitivity", &sensitivity, docstrings::sensitivity, "model"_a,
                   "trials"_a, "parameters"_a, py::kw_only(), "noise"_a = std::numbers::pi / 180);
  defineWithChoice(module, "cost_gradient", &costGradient, docstrings::cost_gradient, "model"_a,
                   "trials"_a, "parameters"_a, "values"_a = py::none(), py::kw_only(),
                   "noise"_a = Noise(std::numbers::pi / 180), "priors"_a = false,
                   "own_start"_a = false, "threads"_a = 1);
}

}  // namespace python
