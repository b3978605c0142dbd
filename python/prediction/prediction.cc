#include <fmt/format.h>

#include "bio/analysis/output_gradient.h"
#include "docstrings.h"
#include "info/parallel_for.h"
#include "interruptible.h"
#include "prediction/studies.h"

namespace python {
namespace {

/// What predict() simulates of every trial.
struct Predicted {
  std::vector<Eigen::VectorXd> outputs;
  std::vector<bio::CostGradient> gradients;  ///< empty without weights
};

void mustFit(const std::optional<std::vector<Eigen::VectorXd>>& weights, std::size_t trials) {
  if (!weights || weights->size() == trials) return;
  throw std::invalid_argument(
      fmt::format("weights: {} arrays, must be {}, one for each trial", weights->size(), trials));
}

Predicted predicted(const Studies& studies, const Eigen::VectorXd& theta,
                    const std::optional<std::vector<Eigen::VectorXd>>& weights, int threads) {
  const std::size_t count = studies.trials.size();
  Predicted found{std::vector<Eigen::VectorXd>(count), {}};
  if (weights) found.gradients.resize(count);
  info::parallelFor(static_cast<int>(count), threads, [&](int i) {
    const auto t = static_cast<std::size_t>(i);
    const bio::StudiedTrial& trial = studies.trials[t];
    if (!weights) {
      found.outputs[t] = predictorOf(trial, studies.question).outputs(theta);
      return;
    }
    bio::OutputGradient one = bio::gradientOfOutputs(trial, studies.question, theta, (*weights)[t]);
    found.outputs[t] = std::move(one.outputs);
    found.gradients[t] = std::move(one.sum);
  });
  return found;
}

py::object predict(const bio::Model& model, const std::vector<bio::Trial>& trials,
                   const std::vector<std::string>& parameters,
                   const std::optional<Eigen::VectorXd>& values,
                   const std::optional<std::vector<Eigen::VectorXd>>& weights,
                   const std::vector<std::string>& observe, int threads,
                   const std::map<std::string, double>& initial, const Names& coordinate,
                   const std::map<std::string, double>& lock, const std::string& integrator,
                   std::optional<double> step) {
  const Choosing chosen{initial, coordinate, lock, integrator, step};
  Studies studies = begun(model, trials, chosen);
  if (observe.empty()) mustHaveFreeCoordinate(studies, ", observe must name what is measured");
  mustFit(weights, trials.size());
  Eigen::VectorXd theta;
  Predicted found;
  interruptible([&](const std::atomic<bool>& goOn) {
    prepare(studies, model, trials, chosen, goOn);
    std::vector<std::pair<std::string, double>> channels;
    for (const std::string& name : observe) channels.emplace_back(name, 1.0);
    studies.question.observed = bio::observedChannels(channels, model, *studies.system);
    studies.question.selection = studies.catalogue().select(parameters);
    theta = values.value_or(studies.catalogue().values(studies.question.selection));
    if (theta.size() != std::ssize(studies.question.selection)) {
      throw std::invalid_argument(fmt::format("{} values for {} parameters, must be as many",
                                              theta.size(), studies.question.selection.size()));
    }
    found = predicted(studies, theta, weights, threads);
  });
  std::vector<std::string> names, units, observed;
  for (const std::size_t index : studies.question.selection) {
    names.push_back(studies.catalogue().parameters()[index].name);
    units.push_back(studies.catalogue().parameters()[index].unit);
  }
  for (const auto& one : studies.question.observed) observed.push_back(bio::nameOf(one.what));
  if (observed.empty()) observed.push_back(studies.question.coordinate);
  std::vector<Eigen::VectorXd> times;
  for (const bio::StudiedTrial& trial : studies.trials)
    times.push_back(Eigen::VectorXd::Map(trial.times.data(), std::ssize(trial.times)));
  py::object gradient = py::none(), excitationGradient = py::none();
  if (weights) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(theta.size());
    py::list excitations;
    for (const bio::CostGradient& one : found.gradients) {
      sum += one.gradient;
      excitations.append(Eigen::MatrixXd(one.excitation.transpose()));
    }
    gradient = py::cast(sum);
    excitationGradient = excitations;
  }
  return tableResult("PredictionResult", "names"_a = names, "units"_a = units, "values"_a = theta,
                     "observed"_a = observed, "times"_a = times, "outputs"_a = found.outputs,
                     "gradient"_a = gradient, "excitation_gradient"_a = excitationGradient,
                     "muscles"_a = bio::muscleNames(*studies.system));
}

}  // namespace

void definePrediction(py::module_& module) {
  defineWithChoice(module, "predict", &predict, docstrings::predict, "model"_a, "trials"_a,
                   "parameters"_a, "values"_a = py::none(), py::kw_only(), "weights"_a = py::none(),
                   "observe"_a = std::vector<std::string>(), "threads"_a = 1,
                   "initial"_a = std::map<std::string, double>());
}

}  // namespace python
