#include "info/discovery/judgement/residual_causes.h"

#include <algorithm>
#include <cmath>

#include "discovery/judgement/node_states.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index kDirections = 15;
constexpr int kSizes = 5;
constexpr Index kLags = 5;

VectorXd joined(const std::vector<VectorXd>& trials) {
  Index n = 0;
  for (const VectorXd& x : trials) n += x.size();
  VectorXd all(n);
  Index at = 0;
  for (const VectorXd& x : trials) {
    all.segment(at, x.size()) = x;
    at += x.size();
  }
  return all;
}

// Scaled to mean square 1, unless it is 0.
VectorXd sized(VectorXd x) {
  const double size = std::sqrt(x.squaredNorm() / static_cast<double>(x.size()));
  if (size > 0) x /= size;
  return x;
}

VectorXd scaled(const std::vector<VectorXd>& trials) {
  VectorXd all = joined(trials);
  all.array() -= all.mean();
  return sized(std::move(all));
}

// B with BBᵀ ≈ K of rank `rank`: Cholesky's factor, the largest remaining variance first.
MatrixXd pivotedRoot(const MatrixXd& K, Index rank) {
  const Index n = K.rows();
  VectorXd left = K.diagonal();
  MatrixXd B(n, std::min(rank, n));
  for (Index j = 0; j < B.cols(); ++j) {
    Index pivot = 0;
    if (left.maxCoeff(&pivot) < 1e-6) return B.leftCols(j);
    const VectorXd column = K.col(pivot) - B.leftCols(j) * B.row(pivot).head(j).transpose();
    B.col(j) = column / std::sqrt(left[pivot]);
    left -= B.col(j).cwiseAbs2();
  }
  return B;
}

// Score and information of disturbances with these columns at the samples of each trial.
double evidenceOf(const Likelihood& likelihood, const Fit& fit, const NodeStates& states,
                  const std::vector<MatrixXd>& disturbances) {
  if (disturbances.front().cols() == 0) return 0;
  const auto projected = likelihood.project(fit, states.linear, disturbances);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(projected.information);
  const VectorXd information = eigen.eigenvalues().cwiseMax(0);
  const VectorXd score = eigen.eigenvectors().transpose() * projected.score;
  const double most = information.maxCoeff();
  if (!(most > 0)) return 0;
  double best = -HUGE_VAL, variance = 10 / most;
  for (int k = 0; k < kSizes; ++k, variance *= 10) {
    double gain = 0;
    for (Index i = 0; i < score.size(); ++i) {
      const double growth = 1 + variance * information[i];
      gain += 0.5 * score[i] * score[i] * variance / growth - 0.5 * std::log(growth);
    }
    best = std::max(best, gain);
  }
  return best - std::log(static_cast<double>(kSizes));
}

// Response of the outputs to forces on every axis in turn.
// @param forcesOn columns of force at the nodes of an axis of all trials, stacked by trial
template <class ForcesOn>
std::vector<MatrixXd> outputsOf(const NodeStates& states, const ForcesOn& forcesOn) {
  std::vector<MatrixXd> disturbances(states.linear.size());
  for (std::size_t axis = 0; axis < states.numAxes; ++axis) {
    const MatrixXd forces = forcesOn(axis);
    Index at = 0;
    for (std::size_t t = 0; t < states.linear.size(); ++t) {
      const MatrixXd& byNode = states.linear[t].force;
      const MatrixXd own = byNode.middleCols(states.begin(t, axis), states.count(t)) *
                           forces.middleRows(at, states.count(t));
      MatrixXd& all = disturbances[t];
      all.conservativeResize(own.rows(), all.cols() + own.cols());
      all.rightCols(own.cols()) = own;
      at += states.count(t);
    }
  }
  return disturbances;
}

MatrixXd fieldOfState(const NodeStates& states, std::size_t axis) {
  const VectorXd q = scaled(states.positions(axis)), qDot = scaled(states.speeds(axis));
  const Index n = q.size();
  MatrixXd K(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const double a = q[i] - q[j], b = qDot[i] - qDot[j];
      K(i, j) = std::exp(-0.5 * (a * a + b * b));
    }
  return pivotedRoot(K, kDirections);
}

// Every input at every lag; before the start of a trial it has its initial value.
MatrixXd pastInputs(const Likelihood& likelihood, const NodeStates& states, std::size_t axis) {
  Index rows = 0;
  for (std::size_t t = 0; t < states.inputs.size(); ++t) rows += states.count(t);
  const Index inputs = states.inputs.front().cols();
  MatrixXd past(rows, inputs * kLags);
  Index at = 0;
  for (std::size_t t = 0; t < states.inputs.size(); ++t) {
    const MatrixXd u = onAxis(states.inputs[t], axis, states.numAxes);
    const std::vector<double> nodes = nodeTimes(likelihood.data(), likelihood.trials()[t]);
    for (Index i = 0; i < u.rows(); ++i)
      for (Index lag = 0; lag < kLags; ++lag) {
        const double then = nodes[static_cast<std::size_t>(i)] - 0.05 * static_cast<double>(lag);
        Index k = i;
        while (k > 0 && nodes[static_cast<std::size_t>(k)] > then + 1e-9) --k;
        past.row(at + i).segment(lag * inputs, inputs) = u.row(k);
      }
    at += u.rows();
  }
  for (Index j = 0; j < past.cols(); ++j) past.col(j) = scaled({past.col(j)});
  return past;
}

// q̈ at an axis's nodes without the latent force: second differences of the simulated motion, less
// the direct contribution of the forces on all axes at the node and its neighbours. Otherwise every
// force would be correlated with the acceleration that it causes
// (docs/decisions/049-latent-force-acceleration.md).
MatrixXd accelerations(const Likelihood& likelihood, const Fit& fit, const NodeStates& states,
                       std::size_t axis) {
  std::vector<VectorXd> all;
  const std::vector<VectorXd> positions = states.positions(axis);
  for (std::size_t t = 0; t < positions.size(); ++t) {
    const VectorXd& q = positions[t];
    const MatrixXd response = onAxis(states.response[t], axis, states.numAxes);
    const VectorXd force = fit.eta[t].size() > 0 ? likelihood.force(t, fit) : VectorXd();
    const DiscoveryProblem& data = likelihood.data();
    const std::vector<double> nodes = nodeTimes(data, likelihood.trials()[t]);
    const double last = data.times(likelihood.trials()[t]).back();
    const auto bend = [](const auto& x, Index i) { return x[i + 1] - 2 * x[i] + x[i - 1]; };
    VectorXd own = VectorXd::Zero(q.size());
    Index i = 1;
    for (; i + 1 < q.size() && nodes[static_cast<std::size_t>(i + 1)] < last + 1e-9; ++i) {
      const double width =
          nodes[static_cast<std::size_t>(i)] - nodes[static_cast<std::size_t>(i - 1)];
      own[i] = bend(q, i);
      for (std::size_t from = 0; force.size() > 0 && from < states.numAxes; ++from)
        for (Index j = states.begin(t, from) + i - 1; j <= states.begin(t, from) + i + 1; ++j)
          own[i] -= bend(response.col(j), i) * force[j];
      own[i] /= width * width;
    }
    if (i > 1) {  // no differences at the ends
      own[0] = own[1];
      own.tail(q.size() - i).setConstant(own[i - 1]);
    }
    all.push_back(std::move(own));
  }
  return sized(joined(all));
}

// 1, y, y² and ẏ of the first output at its samples
std::vector<MatrixXd> sensorErrors(const Likelihood& likelihood, const Fit& fit,
                                   const NodeStates& states) {
  const DiscoveryProblem& data = likelihood.data();
  std::vector<VectorXd> outputs, speeds;
  for (std::size_t t = 0; t < states.linear.size(); ++t) {
    const auto whitened = [&](VectorXd samples) {
      fit.noise.output.whiten(data.outputOfSample(likelihood.trials()[t]), samples);
      return samples;
    };
    outputs.push_back(whitened(states.linear[t].outputs));
    speeds.push_back(whitened(states.linear[t].speeds));
  }
  const VectorXd y = scaled(outputs), ySquared = scaled({y.cwiseAbs2()}), yDot = scaled(speeds);
  std::vector<MatrixXd> columns;
  Index at = 0;
  for (std::size_t t = 0; t < outputs.size(); ++t) {
    const Index n = outputs[t].size();
    MatrixXd own(n, 4);
    own << VectorXd::Ones(n), y.segment(at, n), ySquared.segment(at, n), yDot.segment(at, n);
    const auto& channels = data.outputOfSample(likelihood.trials()[t]);
    for (Index k = 0; !channels.empty() && k < n; ++k)
      if (channels[static_cast<std::size_t>(k)] != 0) own.row(k).setZero();
    fit.noise.output.whiten(channels, own);
    columns.push_back(std::move(own));
    at += n;
  }
  return columns;
}

// Every channel's moment about an axis times z and z² − 1, z the scaled position
MatrixXd moments(const Likelihood& likelihood, const Fit& fit, const NodeStates& states,
                 std::size_t axis) {
  const VectorXd q = scaled(states.positions(axis));
  MatrixXd columns;
  Index at = 0;
  for (const int trial : likelihood.trials()) {
    const MatrixXd G = onAxis(likelihood.data().predict(trial, fit.values, {}, {}, true).scale,
                              axis, states.numAxes);
    const Index n = G.rows(), m = std::max<Index>(G.cols() - static_cast<Index>(states.numAxes), 0);
    if (at == 0) columns.resize(q.size(), 2 * m);
    const VectorXd z = q.segment(at, n);
    columns.middleRows(at, n).leftCols(m) = z.asDiagonal() * G.leftCols(m);
    columns.middleRows(at, n).rightCols(m) =
        (z.cwiseAbs2().array() - 1).matrix().asDiagonal() * G.leftCols(m);
    at += n;
  }
  for (Index j = 0; j < columns.cols(); ++j) columns.col(j) = sized(columns.col(j));
  return columns;
}

}  // namespace

const char* name(Cause cause) {
  static constexpr const char* kNames[] = {"state", "inputs", "acceleration", "sensor", "moments"};
  return kNames[static_cast<int>(cause)];
}

Cause ResidualEvidence::strongest() const {
  return kCauses[static_cast<std::size_t>(std::max_element(nats.begin(), nats.end()) -
                                          nats.begin())];
}

ResidualEvidence residualEvidence(const Likelihood& likelihood, const Fit& fit) {
  const NodeStates states = statesAtNodes(likelihood, fit);
  const auto natsOf = [&](const std::vector<MatrixXd>& disturbances) {
    return evidenceOf(likelihood, fit, states, disturbances);
  };
  const auto ofForces = [&](const auto& forcesOn) { return natsOf(outputsOf(states, forcesOn)); };
  return {{ofForces([&](std::size_t axis) { return fieldOfState(states, axis); }),
           ofForces([&](std::size_t axis) { return pastInputs(likelihood, states, axis); }),
           ofForces([&](std::size_t axis) { return accelerations(likelihood, fit, states, axis); }),
           natsOf(sensorErrors(likelihood, fit, states)),
           ofForces([&](std::size_t axis) { return moments(likelihood, fit, states, axis); })}};
}

}  // namespace info::discover
