#include <fmt/format.h>
#include <fmt/ranges.h>

#include <variant>

#include "bio/analysis/replay.h"
#include "bio/calibration/trial_set.h"
#include "bio/model/units.h"
#include "bio/simulation/integrator_names.h"
#include "docstrings.h"
#include "interruptible.h"
#include "prediction/studies.h"
#include "systems.h"

namespace python {
namespace {

py::list gainsOf(const std::vector<bio::ChannelGain>& gains, const bio::Model& model) {
  py::list list;
  for (const bio::ChannelGain& gain : gains) {
    list.append(results("channel"_a = bio::nameOf(gain.channel.what), "noise"_a = gain.channel.sd,
                        "unit"_a = bio::unitOf(gain.channel.what, model),
                        "information"_a = gain.information, "parameter"_a = gain.parameter,
                        "bound_before"_a = gain.before, "bound_after"_a = gain.after));
  }
  return list;
}

py::object sensitivity(const bio::Model& model, const std::vector<bio::Trial>& trials,
                       const std::vector<std::string>& parameters, double noise,
                       const std::map<std::string, double>& observe, bool furtherChannels,
                       const std::map<std::string, double>& initial, const Names& coordinate,
                       const std::map<std::string, double>& lock, const std::string& integrator,
                       std::optional<double> step) {
  const Choosing chosen{initial, coordinate, lock, integrator, step};
  Studies studies = begun(model, trials, chosen);
  if (observe.empty()) mustHaveFreeCoordinate(studies, ", observe must name what is measured");
  bio::LocalSensitivity found;
  std::vector<bio::ChannelGain> gains;
  interruptible([&](const std::atomic<bool>& goOn) {
    prepare(studies, model, trials, chosen, goOn);
    bio::SensitivityQuestion& question = studies.question;
    question.noise = noise;
    question.observed =
        bio::observedChannels({observe.begin(), observe.end()}, model, *studies.system);
    question.selection = studies.catalogue().select(parameters);
    found = bio::localSensitivity(studies.trials, question);
    if (furtherChannels) {
      gains = bio::furtherGains(studies.trials, *studies.system, question, found.information);
    }
  });
  const bio::ParameterInformation& information = found.information;
  std::vector<std::string> names, units, observed;
  Eigen::VectorXd priorSd(std::ssize(information.parameters));
  for (const info::Parameter& parameter : information.parameters) {
    priorSd[std::ssize(names)] = parameter.prior->sd;
    names.push_back(parameter.name);
    units.push_back(parameter.unit);
  }
  for (const auto& one : studies.question.observed) observed.push_back(bio::nameOf(one.what));
  if (observed.empty()) observed.push_back(studies.question.coordinate);
  std::vector<Eigen::VectorXd> outputs, times;
  std::vector<Eigen::MatrixXd> gammas;
  for (std::size_t i = 0; i < found.trials.size(); ++i) {
    const std::vector<double>& at = studies.trials[i].times;
    times.push_back(Eigen::VectorXd::Map(at.data(), std::ssize(at)));
    outputs.push_back(std::move(found.trials[i].outputs));
    gammas.push_back(std::move(found.trials[i].gamma));
  }
  return tableResult(
      "SensitivityResult", "names"_a = names, "units"_a = units,
      "values"_a = studies.catalogue().values(studies.question.selection), "prior_sd"_a = priorSd,
      "observed"_a = observed, "times"_a = times, "outputs"_a = outputs, "gamma"_a = gammas,
      "fisher"_a = information.fisher,
      "normalised_sensitivity"_a = information.normalisedSensitivity,
      "bound_alone"_a = information.boundAlone, "bound_joint"_a = information.boundJoint,
      "identifiable"_a = information.identifiable, "correlation"_a = information.correlation,
      "determined_combinations"_a = static_cast<int>(information.determinedCombinations),
      "sentences"_a = information.sentences, "further_channels"_a = gainsOf(gains, model));
}

py::object parameterSweep(const bio::Model& model, const bio::Trial& trial,
                          const std::string& parameter, const std::vector<double>& values,
                          const std::map<std::string, double>& initial, const Names& coordinate,
                          const std::map<std::string, double>& lock, const std::string& integrator,
                          std::optional<double> step) {
  const Choosing chosen{initial, coordinate, lock, integrator, step};
  Studies studies = begun(model, {trial}, chosen);
  mustHaveFreeCoordinate(studies, "");
  std::optional<bio::Sweep> found;
  interruptible([&](const std::atomic<bool>& goOn) {
    prepare(studies, model, {trial}, chosen, goOn);
    found = bio::parameterSweep(studies.trials.front(), studies.question.system,
                                studies.catalogue().find(parameter), values);
  });
  std::vector<Eigen::VectorXd> motions;
  std::vector<std::string> outcomes;
  Eigen::VectorXd rms(std::ssize(found->runs)), largest(std::ssize(found->runs));
  for (const bio::SweepRun& run : found->runs) {
    rms[std::ssize(motions)] = run.rms;
    largest[std::ssize(motions)] = run.largest;
    motions.emplace_back(run.motion.q.row(0).transpose());
    outcomes.emplace_back(bio::name(run.motion.outcome));
  }
  const bio::Trajectory& nominal = found->nominal;
  return tableResult(
      "ParameterSweepResult", "parameter"_a = found->parameter.name,
      "unit"_a = found->parameter.unit, "model_value"_a = found->parameter.value,
      "time"_a =
          Eigen::VectorXd(Eigen::VectorXd::Map(nominal.time.data(), std::ssize(nominal.time))),
      "nominal"_a = Eigen::VectorXd(nominal.q.row(0).transpose()),
      "values"_a = Eigen::VectorXd(Eigen::VectorXd::Map(values.data(), std::ssize(values))),
      "motions"_a = motions, "outcome"_a = outcomes, "rms_change"_a = rms,
      "max_change"_a = largest);
}

py::object profileLikelihood(const bio::Model& model, const std::vector<bio::Trial>& trials,
                             const std::vector<std::string>& parameters, const std::string& profile,
                             double noise, const std::map<std::string, double>& initial,
                             const Names& coordinate, const std::map<std::string, double>& lock,
                             const std::string& integrator, std::optional<double> step) {
  const Choosing chosen{initial, coordinate, lock, integrator, step};
  Studies studies = begun(model, trials, chosen);
  mustHaveFreeCoordinate(studies, "");
  std::vector<std::string> names;
  bio::ProfileFinding found;
  interruptible([&](const std::atomic<bool>& goOn) {
    prepare(studies, model, trials, chosen, goOn);
    bio::SensitivityQuestion& question = studies.question;
    question.noise = noise;
    question.selection = studies.catalogue().select(parameters);
    for (const std::size_t index : question.selection) {
      names.push_back(studies.catalogue().parameters()[index].name);
    }
    found = bio::likelihoodProfile(
        studies.trials, question,
        bio::indexInSelection(question.selection, studies.catalogue(), profile),
        [&] { return goOn.load(); });
  });
  const auto& points = found.profile.points;
  Eigen::VectorXd values(std::ssize(points)), costs(std::ssize(points));
  Eigen::MatrixXd best(std::ssize(points), std::ssize(names));
  std::vector<bool> converged;
  for (const info::ProfilePoint& point : points) {
    const auto k = std::ssize(converged);
    values[k] = point.value;
    costs[k] = point.cost;
    best.row(k) = point.parameters.transpose();
    converged.push_back(point.converged);
  }
  return tableResult("ProfileLikelihoodResult", "parameter"_a = found.parameter.name,
                     "unit"_a = found.parameter.unit, "values"_a = values, "costs"_a = costs,
                     "threshold"_a = found.profile.threshold,
                     "bounded_below"_a = found.boundedBelow(),
                     "bounded_above"_a = found.boundedAbove(), "names"_a = names,
                     "parameters"_a = best, "converged"_a = converged);
}

py::object globalSensitivity(const bio::Model& model, const std::vector<bio::Trial>& trials,
                             const std::vector<std::string>& parameters, const std::string& method,
                             int samples, std::uint64_t seed, int threads,
                             const std::map<std::string, double>& initial,
                             const py::object& progress, const Names& coordinate,
                             const std::map<std::string, double>& lock,
                             const std::string& integrator, std::optional<double> step) {
  if (method != "morris" && method != "sobol" && method != "both") {
    throw std::invalid_argument(fmt::format("method '{}', must be morris, sobol or both", method));
  }
  const Choosing chosen{initial, coordinate, lock, integrator, step};
  Studies studies = begun(model, trials, chosen);
  mustHaveFreeCoordinate(studies, "");
  bio::GlobalQuestion global{.morris = method != "sobol", .sobol = method != "morris"};
  global.ensemble.samples = samples;
  global.ensemble.seed = seed;
  global.ensemble.threads = threads;
  std::vector<std::string> names;
  bio::GlobalFinding found;
  interruptible({progress, "global_sensitivity"}, [&](const auto& goOn, auto& done) {
    prepare(studies, model, trials, chosen, goOn);
    studies.question.selection = studies.catalogue().select(parameters);
    for (const std::size_t index : studies.question.selection) {
      names.push_back(studies.catalogue().parameters()[index].name);
    }
    global.ensemble.progress = [&](int finished, int runs) {
      return noting(goOn, done)(static_cast<double>(finished) / runs);
    };
    found = bio::globalSensitivity(studies.trials, studies.question, global);
  });
  py::object morris = py::none(), sobol = py::none();
  if (found.morris) {
    morris = results("mean_absolute"_a = found.morris->meanAbsolute, "sd"_a = found.morris->sd,
                     "runs"_a = found.morris->runs, "undefined"_a = found.morris->undefined);
  }
  if (found.sobol) {
    sobol = results("first"_a = found.sobol->first, "first_sd"_a = found.sobol->firstDeviation,
                    "total"_a = found.sobol->total, "total_sd"_a = found.sobol->totalSd,
                    "variance"_a = found.sobol->variance, "runs"_a = found.sobol->runs,
                    "undefined"_a = found.sobol->undefined);
  }
  return tableResult("GlobalSensitivityResult", "names"_a = names, "morris"_a = morris,
                     "sobol"_a = sobol);
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
  const SystemChoice choice = systemChoice(model, trials, freeCoordinates, lock, integrator, step);
  for (const bio::Trial& trial : trials) mustBeOfTheModelAsItIs(trial);
  bio::TrialSetOptions options;
  options.parameters = parameters;
  options.ownStart = ownStart;
  options.simulation = choice.simulation();
  options.simulation.duration = 1;
  options.threads = threads;
  std::vector<std::string> names, units, muscles;
  Eigen::VectorXd at, atModel, priorSds;
  bio::TrialSet::Cost cost;
  interruptible([&](const std::atomic<bool>&) {
    const bio::TrialSet set(model, choice.systemOptions(), trials, options);
    priorSds = set.priorSds();
    muscles = bio::muscleNames(set.system());
    atModel.resize(priorSds.size());
    for (const info::Parameter& parameter : set.parameters()) {
      atModel[std::ssize(names)] = parameter.start;
      names.push_back(parameter.name);
      units.push_back(parameter.unit);
    }
    at = values.value_or(atModel);
    cost = set.leastSquares(at, noiseOf(set, noise));
  });
  if (priors) {
    const Eigen::VectorXd off = (at - atModel).cwiseQuotient(priorSds);
    cost.value += off.squaredNorm() / 2;
    cost.gradient += off.cwiseQuotient(priorSds);
  }
  std::vector<Eigen::MatrixXd> excitations;
  for (const bio::CostGradient& trial : cost.trials) {
    excitations.push_back(trial.excitation.transpose());
  }
  return tableResult("CostGradientResult", "names"_a = names, "units"_a = units, "values"_a = at,
                     "cost"_a = cost.value, "gradient"_a = cost.gradient,
                     "excitation_gradient"_a = excitations, "muscles"_a = muscles);
}

py::object listParameters(const bio::Model& model, const Names& coordinate,
                          const std::map<std::string, double>& lock, const std::string& integrator,
                          std::optional<double> step) {
  const SystemChoice choice = systemChoice(model, {}, coordinate, lock, integrator, step);
  const bio::MusculoskeletalSystem system(model, choice.systemOptions());
  const bio::ParameterCatalogue catalogue(model, system, {system.skeleton().defaultValues(), {}});
  py::list list;
  for (const bio::ModelParameter& p : catalogue.parameters()) {
    list.append(results("name"_a = p.name, "value"_a = p.value, "unit"_a = p.unit,
                        "meaning"_a = p.meaning, "lower"_a = p.lower, "upper"_a = p.upper,
                        "deviation"_a = p.sd, "is_group"_a = p.isGroup));
  }
  return tableOfRows(list);
}

}  // namespace

void defineSensitivity(py::module_& module) {
  defineWithChoice(module, "list_parameters", &listParameters, docstrings::list_parameters,
                   "model"_a, py::kw_only());
  defineWithChoice(module, "sensitivity", &sensitivity, docstrings::sensitivity, "model"_a,
                   "trials"_a, "parameters"_a, py::kw_only(), "noise"_a = bio::radiansPerDegree,
                   "observe"_a = std::map<std::string, double>(), "further_channels"_a = false,
                   "initial"_a = std::map<std::string, double>());
  defineWithChoice(module, "parameter_sweep", &parameterSweep, docstrings::parameter_sweep,
                   "model"_a, "trial"_a, "parameter"_a, "values"_a, py::kw_only(),
                   "initial"_a = std::map<std::string, double>());
  defineWithChoice(module, "profile_likelihood", &profileLikelihood, docstrings::profile_likelihood,
                   "model"_a, "trials"_a, "parameters"_a, "profile"_a, py::kw_only(),
                   "noise"_a = bio::radiansPerDegree,
                   "initial"_a = std::map<std::string, double>());
  defineWithChoice(module, "global_sensitivity", &globalSensitivity, docstrings::global_sensitivity,
                   "model"_a, "trials"_a, "parameters"_a, py::kw_only(), "method"_a = "both",
                   "samples"_a = 64, "seed"_a = 1, "threads"_a = 1,
                   "initial"_a = std::map<std::string, double>(), "progress"_a = false);
  defineWithChoice(module, "cost_gradient", &costGradient, docstrings::cost_gradient, "model"_a,
                   "trials"_a, "parameters"_a, "values"_a = py::none(), py::kw_only(),
                   "noise"_a = Noise(bio::radiansPerDegree), "priors"_a = false,
                   "own_start"_a = false, "threads"_a = 1);
}

}  // namespace python
