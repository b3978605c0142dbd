#include "robot/robot_trials.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace app {

using Eigen::Index;
using Eigen::MatrixXd;

nlohmann::ordered_json rowsOf(const MatrixXd& matrix) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const auto& row : matrix.rowwise())
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  return rows;
}

void sayHistograms(Report& report) {
  report.details.emplace_back(
      Section{"Simulated experiments",
              "How estimates from simulated experiments scatter about the true values; if the "
              "bound is reached, the histogram follows the dashed curve."});
}

Figure histogram(const std::string& name, const info::MonteCarloResult& result, Index parameter,
                 double truth) {
  const double sigma = std::sqrt(result.bound(parameter, parameter));
  constexpr int bins = 24;
  std::vector<double> counts(bins, 0.0);
  double inside = 0;
  for (const info::MonteCarloTrial& trial : result.trials) {
    const double place = ((trial.parameters[parameter] - truth) / sigma + 4) / 8 * bins;
    if (!trial.converged || !(place >= 0 && place < bins)) continue;
    counts[static_cast<std::size_t>(place)] += 1;
    inside += 1;
  }
  Series bars{.name = "estimates", .style = SeriesStyle::path},
      bound{.name = "normal distribution of the bound", .style = SeriesStyle::dashed};
  for (int i = 0; i < bins; ++i) {
    const double low = -4 + 8.0 * i / bins, high = -4 + 8.0 * (i + 1) / bins,
                 mid = (low + high) / 2;
    const double count = counts[static_cast<std::size_t>(i)];
    for (const auto& [edge, height] :
         {std::pair{low, 0.0}, {low, count}, {high, count}, {high, 0.0}}) {
      bars.x.push_back(truth + sigma * edge);
      bars.y.push_back(height);
    }
    bound.x.push_back(truth + sigma * mid);
    bound.y.push_back(result.converged * 8.0 / bins * std::exp(-mid * mid / 2) /
                      std::sqrt(2 * std::numbers::pi));
  }
  return {.title = name,
          .xLabel = name,
          .yLabel = "Trials",
          .series = {bars, bound},
          .caption = fmt::format("{:.0f} of {} estimates lie within 4 standard deviations.", inside,
                                 result.converged)};
}

}  // namespace app
