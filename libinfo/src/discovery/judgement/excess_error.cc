#include "info/discovery/judgement/excess_error.h"

#include <algorithm>
#include <map>
#include <utility>

namespace info::discover {

Eigen::VectorXd errorsByOutput(const DiscoveryProblem& data, const std::vector<int>& trials,
                               const Eigen::VectorXd& values, std::size_t numOutputs) {
  const auto n = static_cast<Eigen::Index>(numOutputs);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(n), count = squares;
  for (const int t : trials) {
    const auto& outputs = data.outputOfSample(t);
    const Eigen::VectorXd difference = data.outputs(t, values, {}) - data.measured(t);
    for (Eigen::Index k = 0; k < difference.size(); ++k) {
      const int output = outputs.empty() ? 0 : outputs[static_cast<std::size_t>(k)];
      squares[output] += difference[k] * difference[k];
      ++count[output];
    }
  }
  return (squares.array() / count.array()).sqrt().matrix();
}

double rangeOf(const DiscoveryProblem& data, const std::vector<int>& trials,
               const Whitening& noise) {
  std::map<int, std::pair<double, double>> ends;  // by output
  for (const int t : trials) {
    const auto& outputs = data.outputOfSample(t);
    const Eigen::VectorXd& y = data.measured(t);
    for (Eigen::Index k = 0; k < y.size(); ++k) {
      const int output = outputs.empty() ? 0 : outputs[static_cast<std::size_t>(k)];
      auto& [low, high] = ends.try_emplace(output, y[k], y[k]).first->second;
      low = std::min(low, y[k]);
      high = std::max(high, y[k]);
    }
  }
  double widest = 0;
  for (const auto& [output, of] : ends) {
    const double factor = noise.sd(0) / noise.sd(static_cast<std::size_t>(output));
    widest = std::max(widest, factor * (of.second - of.first));
  }
  return widest;
}

void explainExcess(ExcessError& excess) {
  const double floor = excess.floor * excess.floor, after = excess.after * excess.after - floor;
  const auto closed = [&](double before) -> std::optional<double> {
    if (before * before < 1.2 * floor) return std::nullopt;
    return 1 - after / (before * before - floor);
  };
  excess.closedFromCalibrated = closed(excess.calibrated);
  excess.closedFromNominal = closed(excess.nominal);
}

}  // namespace info::discover
