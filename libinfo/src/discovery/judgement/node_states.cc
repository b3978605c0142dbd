#include "discovery/judgement/node_states.h"

#include <algorithm>

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Samples of the first output alone.
struct FirstOutput {
  FirstOutput(const DiscoveryProblem& data, int trial) {
    const auto& channels = data.outputOfSample(trial);
    for (std::size_t k = 0; k < data.times(trial).size(); ++k) {
      if (!channels.empty() && channels[k] != 0) continue;
      which.push_back(static_cast<Index>(k));
      times.push_back(data.times(trial)[k]);
    }
  }
  VectorXd of(const VectorXd& samples) const { return samples(which); }
  std::vector<Index> which;
  std::vector<double> times;
};

// y at the latent nodes, linear between samples
VectorXd atNodes(const std::vector<double>& nodes, const std::vector<double>& times,
                 const VectorXd& y) {
  VectorXd result(static_cast<Index>(nodes.size()));
  std::size_t k = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    while (k + 2 < times.size() && times[k + 1] < nodes[i]) ++k;
    const auto at = static_cast<Index>(k);
    const double s = std::clamp((nodes[i] - times[k]) / (times[k + 1] - times[k]), 0.0, 1.0);
    result[static_cast<Index>(i)] = (1 - s) * y[at] + s * y[at + 1];
  }
  return result;
}

}  // namespace

NodeStates statesAtNodes(const Likelihood& likelihood, const Fit& fit) {
  const DiscoveryProblem& data = likelihood.data();
  NodeStates states;
  for (std::size_t t = 0; t < likelihood.trials().size(); ++t) {
    const int trial = likelihood.trials()[t];
    states.linear.push_back(likelihood.linearise(t, fit, fit.values, {}, true));
    const auto& linear = states.linear.back();
    const auto& nodes = data.latentTimes(trial);
    const FirstOutput first(data, trial);
    states.q.push_back(atNodes(nodes, first.times, first.of(linear.outputs)));
    states.qDot.push_back(atNodes(nodes, first.times, first.of(linear.speeds)));
    const auto n = static_cast<Index>(nodes.size());
    MatrixXd response(n, linear.force.cols());
    for (Index j = 0; j < response.cols(); ++j)
      response.col(j) =
          fit.noise.output.sd(0) * atNodes(nodes, first.times, first.of(linear.force.col(j)));
    states.response.push_back(std::move(response));
    const MatrixXd u = data.inputs(trial);
    MatrixXd placed(static_cast<Index>(nodes.size()), u.cols());
    for (Index j = 0; j < u.cols(); ++j)
      placed.col(j) = atNodes(nodes, first.times, first.of(u.col(j)));
    states.inputs.push_back(std::move(placed));
  }
  return states;
}

}  // namespace info::discover
