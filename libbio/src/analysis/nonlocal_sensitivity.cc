#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/analysis/sensitivity_study.h"

namespace bio {
namespace {

/// @throws std::invalid_argument for none
const ParameterCatalogue& catalogueOf(const std::vector<StudiedTrial>& trials) {
  if (trials.empty()) throw std::invalid_argument("trials: empty, must have at least one");
  return trials.front().catalogue;
}

}  // namespace

bool ProfileFinding::boundedBelow() const {
  return !profile.points.empty() && profile.points.front().cost > profile.threshold;
}

bool ProfileFinding::boundedAbove() const {
  return !profile.points.empty() && profile.points.back().cost > profile.threshold;
}

int GlobalFinding::undefined() const {
  return (morris ? morris->undefined : 0) + (sobol ? sobol->undefined : 0);
}

Eigen::Index indexInSelection(const std::vector<std::size_t>& selection,
                              const ParameterCatalogue& catalogue, const std::string& name) {
  const auto at = std::find(selection.begin(), selection.end(), catalogue.find(name));
  if (at == selection.end()) {
    throw std::invalid_argument(fmt::format("profile: {} is not one of the parameters", name));
  }
  return at - selection.begin();
}

ProfileFinding likelihoodProfile(const std::vector<StudiedTrial>& trials,
                                 const SensitivityQuestion& question, Eigen::Index held,
                                 const std::function<bool()>& goOn) {
  const ParameterCatalogue& catalogue = catalogueOf(trials);
  const std::vector<TrialPredictor> experiments = predictorsOf(trials, question);
  const info::Predictor predictor = joined(experiments);
  const auto parameters = catalogue.asEstimated(question.selection, true);
  const Eigen::VectorXd theta = catalogue.values(question.selection);
  const double noise = question.noise;
  if (!(noise > 0 && std::isfinite(noise))) {
    throw std::invalid_argument(fmt::format("noise = {}, must be > 0 and finite", noise));
  }
  const info::LeastSquares problem(
      predictor,
      {predictor.outputs(theta),
       info::OutputCovariance(Eigen::MatrixXd::Constant(1, 1, noise * noise))},
      parameters);
  info::EstimateOptions options;
  options.maxIterations = 30;
  options.decrementTolerance = 1e-6;
  if (goOn) options.progress = [&](const info::EstimateProgress&) { return goOn(); };
  const info::Estimate estimated = info::estimate(problem, options);
  const info::Parameter& parameter = parameters[static_cast<std::size_t>(held)];
  const double wide = 3 * std::sqrt(std::max(estimated.covariance(held, held), 0.0));
  std::vector<double> values;
  for (int k = -6; k <= 6; ++k) {
    const double value = theta[held] + wide * k / 6;
    if (value >= parameter.lower && value <= parameter.upper) values.push_back(value);
  }
  return {parameter, info::profileLikelihood(problem, estimated, held, values, options)};
}

GlobalFinding globalSensitivity(const std::vector<StudiedTrial>& trials,
                                const SensitivityQuestion& question, const GlobalQuestion& global) {
  const ParameterCatalogue& catalogue = catalogueOf(trials);
  if (question.selection.size() > mostGlobalParameters) {
    throw std::invalid_argument(
        fmt::format("parameters: {} for a global sensitivity, must be at most {}",
                    question.selection.size(), mostGlobalParameters));
  }
  const std::vector<TrialPredictor> experiments = predictorsOf(trials, question);
  const info::Predictor predictor = joined(experiments);
  const auto parameters = catalogue.asEstimated(question.selection, true);
  const info::CubeModel model = [&](const Eigen::VectorXd& unit) -> Eigen::VectorXd {
    Eigen::VectorXd theta(unit.size());
    for (Eigen::Index i = 0; i < unit.size(); ++i) {
      const info::Parameter& p = parameters[static_cast<std::size_t>(i)];
      const double wide = std::sqrt(3.0) * p.prior->sd;
      const double low = std::max(p.lower, p.start - wide);
      const double high = std::min(p.upper, p.start + wide);
      theta[i] = low + unit[i] * (high - low);
    }
    return global.unit * predictor.outputs(theta).row(0).transpose();
  };
  GlobalFinding finding;
  const auto count = static_cast<int>(question.selection.size());
  if (global.morris) finding.morris = info::morris(model, count, global.ensemble);
  if (global.sobol) finding.sobol = info::sobol(model, count, global.ensemble);
  return finding;
}

}  // namespace bio
