#include "calibration/nudged_starts.h"

#include <algorithm>
#include <cmath>

#include "info/discovery/judgement/output_sd.h"
#include "info/estimation/least_squares.h"
#include "info/estimation/nudge_stages.h"
#include "info/information/output_covariance.h"

namespace bio {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int stageIterations = 8;
/// Shift of a start in prior standard deviations, and how many parameters have such starts.
constexpr double aside = 1.5;
constexpr int mostSides = 6;

}  // namespace

std::vector<VectorXd> nudgedStarts(const TrialSet& trials, const ChannelNoise& channels,
                                   const std::vector<info::Parameter>& parameters,
                                   const std::vector<VectorXd>& starts, double sd,
                                   const info::EstimateOptions& estimate) {
  const auto& series = trials.series();
  const bool canHold =
      std::any_of(series.begin(), series.end(), [](const MeasuredSeries& measured) {
        return measured.what.isCoordinate() && measured.times.size() >= 4;
      });
  if (!canHold) return {};
  std::vector<VectorXd> nudged = starts;
  info::EstimateOptions options = estimate;
  options.maxIterations = stageIterations;
  const MatrixXd measured = channels.weighted(trials.measured());
  for (const info::NudgeStage& stage : info::nudgeStages) {
    const std::vector<TrialPredictor> held = trials.nudged(stage.frequency);
    const info::Predictor predictor = channels.weighted(trials.predictor(held));
    const double sigma = stage.spread * sd;
    const info::OutputCovariance covariance(MatrixXd::Constant(1, 1, sigma * sigma));
    const info::LeastSquares problem(predictor, {measured, covariance, {}, {}}, parameters);
    std::erase_if(nudged, [&](VectorXd& theta) {
      const auto end = info::estimateIfDefined(problem, theta, options);
      if (end) theta = end->parameters;
      return !end;
    });
  }
  return nudged;
}

std::vector<VectorXd> startsOnBothSides(const TrialSet& trials,
                                        const std::vector<info::Parameter>& parameters,
                                        const VectorXd& start) {
  std::vector<VectorXd> starts = {start};
  int sides = 0;
  for (std::size_t i = 0; i < trials.numCommon() && sides < mostSides; ++i) {
    const ParameterTarget& target =
        trials.catalogue().parameters()[trials.selection()[i]].targets.front();
    if (!std::holds_alternative<WrapTarget>(target) && !std::holds_alternative<PointTarget>(target))
      continue;
    ++sides;
    // a point mirrored at its joint's axis may fit as well
    const bool isPoint = std::holds_alternative<PointTarget>(target);
    for (const double side : {-aside, aside, -2 * aside, 2 * aside}) {
      if (!isPoint && std::abs(side) > aside) continue;
      VectorXd other = start;
      const auto k = static_cast<Index>(i);
      other[k] = std::clamp(start[k] + side * trials.priorSds()[k], parameters[i].lower,
                            parameters[i].upper);
      starts.push_back(std::move(other));
    }
  }
  return starts;
}

double measuredSd(const TrialSet& trials, std::size_t channel) {
  info::discover::ThirdDifferences differences;
  for (const MeasuredSeries& series : trials.series()) {
    if (series.channel == channel) differences.add(series.times, series.values);
  }
  return differences.count > 0 ? differences.sd() : 0;
}

}  // namespace bio
