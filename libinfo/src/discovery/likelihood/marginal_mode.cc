#include <cmath>

#include "discovery/likelihood/latent_block.h"
#include "info/discovery/likelihood/joint_fit.h"

// The most probable parameters after marginalisation over the latent forces:
// docs/decisions/042-marginal-mode.md.

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Step of the differences of determinants, in posterior standard deviations. W is smooth, and its
// own error (Newton's tolerance) is far below that.
constexpr double kApart = 0.02;

// The marginal mode must not have less evidence than the joint one. A loss of more nats than this
// means that the gradient was useless, as at a kink or for a nearly unstable motion; the result is
// then discarded.
constexpr double kLost = 2;

double logDeterminant(const MatrixXd& W) {
  const MatrixXd L = latentBlock(W).llt().matrixL();
  return 2 * L.diagonal().array().log().sum();
}

}  // namespace

// d ½log|H_ηη|/dξ along the minimum of J over η; by differences for one trial at a time, since an
// initial state affects its own trial only. 0 if the simulation fails.
VectorXd Likelihood::logDeterminantSlope(const Fit& fit) const {
  const auto p = fit.xi.size();
  VectorXd slope = VectorXd::Zero(p);
  for (std::size_t t = 0; t < trials_.size(); ++t) {
    const Linear here = linearise(t, fit, fit.values, {}, false);
    const auto block = latentBlock(here.latent).llt();
    const MatrixXd follow = -block.solve(MatrixXd(here.latent.transpose() * here.gamma));
    const double logHere = logDeterminant(here.latent);
    Fit beside = fit;
    beside.hypothesis.free.clear();  // no derivatives in ξ are needed
    for (Index i = 0; i < p; ++i) {
      const FreeQuantity& q = fit.hypothesis.free[static_cast<std::size_t>(i)];
      if (here.gamma.col(i).isZero(0) || q.lowest >= q.highest) continue;
      const double curvature = 1 + here.gamma.col(i).squaredNorm();
      const double sd =
          fit.covariance(i, i) > 0 ? std::sqrt(fit.covariance(i, i)) : 1 / std::sqrt(curvature);
      double apart = kApart * sd;
      if (fit.xi[i] + apart > q.highest) apart = -apart;
      beside.values = fit.values;
      beside.values[static_cast<Index>(q.quantity)] = q.value(fit.xi[i] + apart);
      beside.eta[t] = fit.eta[t] + apart * follow.col(i);
      const Linear there = linearise(t, beside, beside.values, {}, false);
      const double change = 0.5 * (logDeterminant(there.latent) - logHere) / apart;
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
