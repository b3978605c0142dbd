#include "info/discovery/likelihood/latent_nodes.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;

double latentCorrelation(double interval, double time, double lag) {
  if (!(lag > 0)) return std::exp(-interval / time);
  if (std::abs(lag - time) < 1e-3 * time) {  // the limit of equal times
    const double x = 2 * interval / (time + lag);
    return (1 + x) * std::exp(-x);
  }
  return (time * std::exp(-interval / time) - lag * std::exp(-interval / lag)) / (time - lag);
}

MatrixXd latentCovariance(const std::vector<Node>& nodes, const MatrixXd& scale, double time,
                          double lag) {
  MatrixXd K = scale * scale.transpose();
  for (Index a = 0; a < K.rows(); ++a)
    for (Index b = 0; b < K.cols(); ++b)
      K(a, b) *= latentCorrelation(std::abs(nodes[static_cast<std::size_t>(a)].time -
                                            nodes[static_cast<std::size_t>(b)].time),
                                   time, lag);
  return K;
}

std::vector<double> nodeTimes(const DiscoveryProblem& data, int trial) {
  std::vector<double> times;
  for (const Node& node : data.nodes(trial))
    if (node.axis == 0) times.push_back(node.time);
  return times;
}

MatrixXd onAxis(const MatrixXd& values, std::size_t axis, std::size_t numAxes) {
  const Index count = values.rows() / static_cast<Index>(numAxes);
  return values.middleRows(static_cast<Index>(axis) * count, count);
}

void requireOrdered(const DiscoveryProblem& data, int trial) {
  const std::vector<Node>& nodes = data.nodes(trial);
  const std::vector<double> times = nodeTimes(data, trial);
  bool ordered = nodes.size() == times.size() * data.axes().size();
  for (std::size_t i = 0; ordered && i < nodes.size(); ++i) {
    const std::size_t k = i % times.size();
    ordered = nodes[i].axis == i / times.size() && nodes[i].time == times[k] &&
              (k == 0 || times[k] > times[k - 1]);
  }
  if (!ordered)
    throw std::invalid_argument(
        fmt::format("{}: nodes of the latent force must be those of each axis in turn, all axes at "
                    "the same rising times",
                    data.trialName(trial)));
}

}  // namespace info::discover
