#include "info/discover/remainder.h"

#include <algorithm>
#include <cmath>

#include "node_states.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index kDirections = 15;
constexpr int kSizes = 5;
constexpr Index kLags = 5;

VectorXd scaled(const std::vector<VectorXd>& trials) {
  Index n = 0;
  for (const VectorXd& x : trials) n += x.size();
  VectorXd all(n);
  Index at = 0;
  for (const VectorXd& x : trials) {
    all.segment(at, x.size()) = x;
    at += x.size();
  }
  all.array() -= all.mean();
  const double deviation = std::sqrt(all.squaredNorm() / static_cast<double>(n));
  if (deviation > 0) all /= deviation;
  return all;
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

// Of forces with these columns at the nodes of all trials, one trial below the other.
double evidenceOf(const Likelihood& likelihood, const Fit& fit, const NodeStates& states,
                  const MatrixXd& forces) {
  if (forces.cols() == 0) return 0;
  std::vector<MatrixXd> disturbances;
  Index at = 0;
  for (const auto& linear : states.linear) {
    disturbances.push_back(linear.force * forces.middleRows(at, linear.force.cols()));
    at += linear.force.cols();
  }
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

MatrixXd fieldOfState(const NodeStates& states) {
  const VectorXd q = scaled(states.q), qDot = scaled(states.qDot);
  const Index n = q.size();
  MatrixXd K(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const double a = q[i] - q[j], b = qDot[i] - qDot[j];
      K(i, j) = std::exp(-0.5 * (a * a + b * b));
    }
  return pivotedRoot(K, kDirections);
}

// Every input at every lag; before the start of a trial it is what it is there.
MatrixXd pastInputs(const Likelihood& likelihood, const NodeStates& states) {
  Index rows = 0;
  for (const MatrixXd& u : states.inputs) rows += u.rows();
  const Index inputs = states.inputs.front().cols();
  MatrixXd past(rows, inputs * kLags);
  Index at = 0;
  for (std::size_t t = 0; t < states.inputs.size(); ++t) {
    const MatrixXd& u = states.inputs[t];
    const auto& nodes = likelihood.data().latentTimes(likelihood.trials()[t]);
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

}  // namespace

RemainderEvidence remainderEvidence(const Likelihood& likelihood, const Fit& fit) {
  const NodeStates states = statesAtNodes(likelihood, fit);
  return {evidenceOf(likelihood, fit, states, fieldOfState(states)),
          evidenceOf(likelihood, fit, states, pastInputs(likelihood, states))};
}

}  // namespace info::discover
