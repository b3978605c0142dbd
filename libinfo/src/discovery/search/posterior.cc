#include <algorithm>
#include <cmath>
#include <numbers>

#include "discovery/likelihood/latent_block.h"
#include "info/discovery/likelihood/joint_fit.h"
#include "info/discovery/likelihood/truncated.h"

// Results of a converged fit: evidence, covariance, scores, innovations, latent force.

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double Fit::sd(std::size_t free) const {
  const auto i = static_cast<Index>(free);
  return std::abs(hypothesis.free[free].slope(xi[i])) * std::sqrt(covariance(i, i));
}

namespace {

// What a prior probability of the nominal value adds to the evidence: ln(1 − π + π·B) with the
// ratio B of posterior and prior density at ξ = 0, which is the Bayes factor of ξ = 0 (Savage and
// Dickey).
double logNominalGain(double share, double xi, double sd) {
  if (share == 0) return 0;
  const double logFactor = -0.5 * xi * xi / (sd * sd) - std::log(sd);
  return std::log(1 - share + share * std::exp(logFactor));
}

}  // namespace

// Laplace's evidence, the posterior covariance, and the effective number of parameters of the
// latent force.
void Likelihood::finish(Fit& fit, const std::vector<Linear>& trials, const VectorXd& tilt) const {
  const Hypothesis& h = fit.hypothesis;
  const Index p = fit.xi.size();
  MatrixXd R = MatrixXd::Identity(p, p);
  VectorXd gradient = fit.xi + tilt;
  double logDeterminant = 0;
  fit.latentNormSquared = 0;
  fit.effectiveParameters = 0;
  double logNoise = 0;            // Σ log(σ√2π)
  std::vector<MatrixXd> carried;  // C⁻¹WᵀΓ = −dη/dξ
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const Linear& l = trials[t];
    const Index samples = l.residuals.size();
    logNoise += fit.noise.output.logDeterminant(data_.outputOfSample(trials_[t]), samples) +
                0.5 * static_cast<double>(samples) * std::log(2 * std::numbers::pi);
    R.noalias() += l.gamma.transpose() * l.gamma;
    gradient.noalias() -= l.gamma.transpose() * l.residuals;
    if (l.latent.cols() == 0) continue;
    const auto block = latentBlock(l.latent).llt();
    const MatrixXd L = block.matrixL();
    logDeterminant += 2 * L.diagonal().array().log().sum();
    MatrixXd half = l.latent.transpose() * l.gamma;
    if (p > 0) block.matrixL().solveInPlace(half);  // Eigen does not allow empty matrices here
    R.noalias() -= half.transpose() * half;
    const MatrixXd inverse = block.matrixL().solve(MatrixXd::Identity(L.rows(), L.rows()));
    fit.latentNormSquared += fit.eta[t].squaredNorm();
    fit.effectiveParameters += static_cast<double>(L.rows()) - inverse.squaredNorm();
    carried.push_back(inverse.transpose() * half);
  }
  // the parameters: those at a bound contribute a one-sided probability mass
  std::vector<Index> inside;
  fit.atBound.assign(static_cast<std::size_t>(p), false);
  for (Index i = 0; i < p; ++i) {
    const FreeQuantity& q = h.free[static_cast<std::size_t>(i)];
    const bool held =
        (fit.xi[i] <= q.lowest && gradient[i] >= 0) || (fit.xi[i] >= q.highest && gradient[i] <= 0);
    fit.atBound[static_cast<std::size_t>(i)] = held;
    if (!held) inside.push_back(i);
  }
  fit.covariance = MatrixXd::Zero(p, p);
  double mass = 0;
  const auto n = static_cast<Index>(inside.size());
  const Eigen::LLT<MatrixXd> factor = MatrixXd(R(inside, inside)).llt();
  if (n > 0) {
    const MatrixXd L = factor.matrixL();
    logDeterminant += 2 * L.diagonal().array().log().sum();
    const MatrixXd covariance = factor.solve(MatrixXd::Identity(n, n));
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j)
        fit.covariance(inside[static_cast<std::size_t>(i)], inside[static_cast<std::size_t>(j)]) =
            covariance(i, j);
  }
  for (Index i = 0; i < p; ++i) {
    const FreeQuantity& q = h.free[static_cast<std::size_t>(i)];
    mass -= logNormalWithin(q.lowest, q.highest);
    if (fit.atBound[static_cast<std::size_t>(i)]) {
      double curvature = R(i, i);
      if (n > 0) {
        const VectorXd beside = R(inside, i);
        curvature -= beside.dot(factor.solve(beside));
      }
      mass += logMassAtBound(std::abs(gradient[i]), curvature, q.highest - q.lowest);
    } else {
      const double sd = std::sqrt(fit.covariance(i, i));
      mass += logNormalWithin((q.lowest - fit.xi[i]) / sd, (q.highest - fit.xi[i]) / sd);
      mass += logNominalGain(q.nominalShare, fit.xi[i], sd);
    }
  }
  for (const MatrixXd& c : carried)
    fit.effectiveParameters -= (c * fit.covariance).cwiseProduct(c).sum();
  fit.logEvidence = -fit.cost - 0.5 * logDeterminant + mass - logNoise;
}

Likelihood::Projected Likelihood::project(const Fit& fit, const std::vector<Linear>& trials,
                                          const std::vector<MatrixXd>& disturbances) const {
  std::vector<Index> inside;
  for (Index i = 0; i < fit.xi.size(); ++i)
    if (!fit.atBound[static_cast<std::size_t>(i)]) inside.push_back(i);
  const auto p = static_cast<Index>(inside.size());
  const Index m = disturbances.at(0).cols();

  // Gram matrix of (Γ, disturbances, residuals) in the metric S⁻¹ of each trial's innovations
  MatrixXd gram = MatrixXd::Zero(p + m + 1, p + m + 1);
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const Linear& l = trials[t];
    MatrixXd Q(l.residuals.size(), p + m + 1);
    Q << l.gamma(Eigen::all, inside), disturbances[t], l.residuals;
    if (l.latent.cols() > 0) Q.col(p + m) += l.latent * fit.eta[t];
    gram.noalias() += Q.transpose() * Q;
    if (l.latent.cols() == 0) continue;
    const auto block = latentBlock(l.latent).llt();
    const MatrixXd half = block.matrixL().solve(MatrixXd(l.latent.transpose() * Q));
    gram.noalias() -= half.transpose() * half;
  }
  gram.topLeftCorner(p, p).diagonal().array() += 1;
  VectorXd pull = gram.topRightCorner(p, 1);
  pull -= fit.xi(inside);
  Projected projected;
  projected.score = gram.block(p, p + m, m, 1);
  projected.information = gram.block(p, p, m, m);
  if (p > 0) {
    const Eigen::LLT<MatrixXd> factor = gram.topLeftCorner(p, p).llt();
    const MatrixXd cross = gram.block(0, p, p, m);
    const MatrixXd solved = factor.solve(cross);
    projected.score -= solved.transpose() * pull;
    projected.information -= cross.transpose() * solved;
  }
  return projected;
}

Likelihood::Whitened Likelihood::whitened(std::size_t at, const Fit& fit) const {
  const Linear l = linearise(at, fit, fit.values, {}, false);
  if (l.latent.cols() == 0) return {l.residuals, l.gamma};
  const Index n = l.residuals.size();
  const Eigen::LLT<MatrixXd> factor(outputCovariance(l.latent, n));
  return {factor.matrixL().solve(VectorXd(l.residuals + l.latent * fit.eta[at])),
          factor.matrixL().solve(l.gamma)};
}

VectorXd Likelihood::force(std::size_t at, const Fit& fit) const {
  if (fit.eta[at].size() == 0) return VectorXd::Zero(roots_[at].rows());
  return fit.noise.latent * (roots_[at] * fit.eta[at]);
}

VectorXd Likelihood::forceSd(std::size_t at, const Fit& fit) const {
  if (fit.eta[at].size() == 0) return VectorXd::Zero(roots_[at].rows());
  const Linear l = linearise(at, fit, fit.values, {}, false);
  const auto block = latentBlock(l.latent).llt();
  // var η = C⁻¹ + C⁻¹ B cov(ξ) Bᵀ C⁻¹
  const MatrixXd B = block.solve(MatrixXd(l.latent.transpose() * l.gamma));
  MatrixXd variance = block.solve(MatrixXd::Identity(B.rows(), B.rows()));
  variance.noalias() += B * fit.covariance * B.transpose();
  const MatrixXd root = fit.noise.latent * roots_[at];
  return (root * variance * root.transpose()).diagonal().cwiseMax(0).cwiseSqrt();
}

}  // namespace info::discover
