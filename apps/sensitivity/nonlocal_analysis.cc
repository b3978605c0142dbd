#include "sensitivity/nonlocal_analysis.h"

#include <algorithm>
#include <cmath>

#include "output/progress_bar.h"

namespace app {

ProfileFinding likelihoodProfile(const std::vector<bio::TrialPredictor>& experiments,
                                 const bio::ParameterCatalogue& catalogue,
                                 const std::vector<std::size_t>& selection, Eigen::Index held,
                                 double noise) {
  const info::Predictor predictor = bio::joined(experiments);
  const auto parameters = catalogue.asEstimated(selection, true);
  const Eigen::VectorXd theta = catalogue.values(selection);
  const info::LeastSquares problem(
      predictor,
      {predictor.outputs(theta),
       info::OutputCovariance(Eigen::MatrixXd::Constant(1, 1, noise * noise))},
      parameters);
  info::EstimateOptions estimateOptions;
  estimateOptions.maxIterations = 30;
  estimateOptions.decrementTolerance = 1e-6;
  const info::Estimate estimated = info::estimate(problem, estimateOptions);
  const info::Parameter& parameter = parameters[static_cast<std::size_t>(held)];
  const double wide = 3 * std::sqrt(std::max(estimated.covariance(held, held), 0.0));
  std::vector<double> values;
  for (int k = -6; k <= 6; ++k) {
    const double value = theta[held] + wide * k / 6;
    if (value >= parameter.lower && value <= parameter.upper) values.push_back(value);
  }
  ProgressBar bar("profile");
  return {parameter, info::profileLikelihood(problem, estimated, held, values, estimateOptions)};
}

GlobalFinding globalSensitivity(const std::vector<bio::TrialPredictor>& experiments,
                                const bio::ParameterCatalogue& catalogue,
                                const std::vector<std::size_t>& selection,
                                const GlobalQuestion& question, const CommandContext& context) {
  const info::Predictor predictor = bio::joined(experiments);
  const auto parameters = catalogue.asEstimated(selection, true);
  const info::CubeModel model = [&](const Eigen::VectorXd& unit) -> Eigen::VectorXd {
    Eigen::VectorXd theta(unit.size());
    for (Eigen::Index i = 0; i < unit.size(); ++i) {
      const info::Parameter& p = parameters[static_cast<std::size_t>(i)];
      const double wide = std::sqrt(3.0) * p.prior->sd;
      const double low = std::max(p.lower, p.start - wide);
      const double high = std::min(p.upper, p.start + wide);
      theta[i] = low + unit[i] * (high - low);
    }
    return question.shown * predictor.outputs(theta).row(0).transpose();
  };
  info::EnsembleOptions ensemble;
  ensemble.samples = question.samples;
  ensemble.seed = context.seed;
  ensemble.threads = context.threads;
  GlobalFinding finding;
  const auto count = static_cast<int>(selection.size());
  ProgressBar bar("global");
  ensemble.progress = [&](int done, int runs) {
    bar.update(static_cast<double>(done) / runs);
    return true;
  };
  if (question.method != "sobol") finding.morris = info::morris(model, count, ensemble);
  if (question.method != "morris") finding.sobol = info::sobol(model, count, ensemble);
  return finding;
}

}  // namespace app
