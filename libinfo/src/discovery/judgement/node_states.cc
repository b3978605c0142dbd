#include "discovery/judgement/node_states.h"

#include "info/dynamics/linear_table.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Values at the nodes' times, straight between the first samples of each time.
MatrixXd atNodes(const std::vector<Node>& nodes, const std::vector<double>& times,
                 const MatrixXd& samples) {
  std::vector<Index> first;
  for (std::size_t k = 0; k < times.size(); ++k)
    if (k == 0 || times[k] > times[k - 1]) first.push_back(static_cast<Index>(k));
  std::vector<double> risen;
  for (const Index k : first) risen.push_back(times[static_cast<std::size_t>(k)]);
  const MatrixXd own = samples(first, Eigen::all);
  MatrixXd result(static_cast<Index>(nodes.size()), samples.cols());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    result.row(static_cast<Index>(i)) = linearAt(risen, nodes[i].time).rows(own);
  }
  return result;
}

}  // namespace

std::vector<VectorXd> NodeStates::positions(std::size_t axis) const {
  std::vector<VectorXd> own;
  for (const VectorXd& all : q) own.emplace_back(onAxis(all, axis, numAxes));
  return own;
}

std::vector<VectorXd> NodeStates::speeds(std::size_t axis) const {
  std::vector<VectorXd> own;
  for (const VectorXd& all : qDot) own.emplace_back(onAxis(all, axis, numAxes));
  return own;
}

MatrixXd NodeStates::placed(std::size_t trial, std::size_t axis, const MatrixXd& forces) const {
  MatrixXd all = MatrixXd::Zero(q[trial].size(), forces.cols());
  all.middleRows(begin(trial, axis), count(trial)) = forces;
  return all;
}

double rootMeanSquare(const std::vector<VectorXd>& parts) {
  double squares = 0, count = 0;
  for (const VectorXd& part : parts) {
    squares += part.squaredNorm();
    count += static_cast<double>(part.size());
  }
  return std::sqrt(squares / count);
}

NodeStates statesAtNodes(const Likelihood& likelihood, const Fit& fit) {
  const DiscoveryProblem& data = likelihood.data();
  NodeStates states;
  states.numAxes = data.axes().size();
  for (std::size_t t = 0; t < likelihood.trials().size(); ++t) {
    const int trial = likelihood.trials()[t];
    states.linear.push_back(likelihood.linearise(t, fit, fit.values, {}, true));
    Likelihood::Linear& linear = states.linear.back();
    states.q.push_back(std::move(linear.course.q));
    states.qDot.push_back(std::move(linear.course.qDot));
    states.response.push_back(std::move(linear.courseByNode));
    states.inputs.push_back(atNodes(data.nodes(trial), data.times(trial), data.inputs(trial)));
  }
  return states;
}

}  // namespace info::discover
