#include <cmath>

#include "discovery/likelihood/latent_block.h"
#include "info/discovery/likelihood/joint_fit.h"

// The parameters that are most probable by themselves: docs/decisions/042-marginal-mode.md.

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Of a posterior deviation: how far apart two determinants are taken. W is smooth, and its own
// error (Newton's tolerance) is far below that.
constexpr double kApart = 0.02;

// What is more probable by itself has more evidence. One that loses so many nats was led astray:
// the slope is that of a kink, or of a motion that nearly falls over (set 71437 lost 355).
constexpr double kLost = 2;

double logDeterminant(const MatrixXd& W, double output) {
  const MatrixXd L = latentBlock(W, output).llt().matrixL();
  return 2 * L.diagonal().array().log().sum();
}

}  // namespace

// d ½log|H_ηη|/dξ along the valley of J, where η follows ξ; differences of one trial at a time, as
// a start moves its own alone. 0 where the simulation fails.
VectorXd Likelihood::logDeterminantSlope(const Fit& fit) const {
  const auto p = fit.xi.size();
  const double output = fit.noise.output;
  VectorXd slope = VectorXd::Zero(p);
  for (std::size_t t = 0; t < trials_.size(); ++t) {
    const Linear here = linearise(t, fit, fit.values, {}, false);
    const auto block = latentBlock(here.latent, output).llt();
    const MatrixXd follow =
        -block.solve(MatrixXd(here.latent.transpose() * here.gamma)) / (output * output);
    const double logHere = logDeterminant(here.latent, output);
    Fit beside = fit;
    beside.hypothesis.free.clear();  // none of their derivatives is asked for
    for (Index i = 0; i < p; ++i) {
      const FreeQuantity& q = fit.hypothesis.free[static_cast<std::size_t>(i)];
      if (here.gamma.col(i).isZero(0) || q.lowest >= q.highest) continue;
      const double curvature = 1 + here.gamma.col(i).squaredNorm() / (output * output);
      const double sd =
          fit.covariance(i, i) > 0 ? std::sqrt(fit.covariance(i, i)) : 1 / std::sqrt(curvature);
      double apart = kApart * sd;
      if (fit.xi[i] + apart > q.highest) apart = -apart;
      beside.values = fit.values;
      beside.values[static_cast<Index>(q.quantity)] = q.value(fit.xi[i] + apart);
      beside.eta[t] = fit.eta[t] + apart * follow.col(i);
      const Linear there = linearise(t, beside, beside.values, {}, false);
      const double change = 0.5 * (logDeterminant(there.latent, output) - logHere) / apart;
      if (std::isfinite(change)) slope[i] += change;
    }
  }
  return slope;
}

Fit Likelihood::marginal(const Fit& near) const {
  if (!(near.noise.latent > 0)) return near;
  auto moved = tryFit(near.hypothesis, near.noise, near.values, near.eta,
                      {8, 0.02, logDeterminantSlope(near)});
  if (!moved || moved->logEvidence < near.logEvidence - kLost) return near;
  moved->converged = moved->converged && near.converged;
  return std::move(*moved);
}

}  // namespace info::discover
