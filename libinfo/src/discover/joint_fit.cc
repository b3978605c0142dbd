#include "info/discover/joint_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "info/discover/truncated.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::size_t> wantedOf(const Hypothesis& h) {
  std::vector<std::size_t> wanted;
  for (const FreeQuantity& q : h.free) wanted.push_back(q.quantity);
  return wanted;
}

VectorXd withCoordinates(const Hypothesis& h, VectorXd values, const VectorXd& xi) {
  for (std::size_t i = 0; i < h.free.size(); ++i)
    values[static_cast<Index>(h.free[i].quantity)] = h.free[i].value(xi[static_cast<Index>(i)]);
  return values;
}

// 1 + WᵀW/σ², the block of one trial's latent force
MatrixXd latentBlock(const MatrixXd& W, double output) {
  MatrixXd C = MatrixXd::Identity(W.cols(), W.cols());
  C.selfadjointView<Eigen::Lower>().rankUpdate(W.transpose(), 1 / (output * output));
  return C;
}

}  // namespace

struct Likelihood::Point {
  VectorXd values, xi;
  std::vector<VectorXd> eta;
};

struct Likelihood::Step {
  VectorXd xi;
  std::vector<VectorXd> eta;
  double gain = 0;  // nats that the linear model promises
};

double Fit::deviation(std::size_t free) const {
  const auto i = static_cast<Index>(free);
  return std::abs(hypothesis.free[free].slope(xi[i])) * std::sqrt(covariance(i, i));
}

Likelihood::Likelihood(const Disagreement& data, std::vector<int> trials, const VectorXd& values,
                       double latentTime)
    : data_(data), trials_(std::move(trials)) {
  if (trials_.empty()) throw std::invalid_argument("likelihood: there must be a trial");
  for (const int trial : trials_) {
    const auto& nodes = data.latentTimes(trial);
    const VectorXd& measured = data.measured(trial);
    const auto n = static_cast<Index>(nodes.size());
    if (measured.size() == 0 || !measured.allFinite() ||
        measured.size() != static_cast<Index>(data.times(trial).size()))
      throw std::invalid_argument(fmt::format(
          "{}: there must be samples, finite, one for each time", data.trialName(trial)));
    MatrixXd K(n, n);
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j)
        K(i, j) = std::exp(
            -std::abs(nodes[static_cast<std::size_t>(i)] - nodes[static_cast<std::size_t>(j)]) /
            latentTime);
    const VectorXd G = data.predict(trial, values, {}, {}, true).latentScale;
    if (G.size() != n || !G.allFinite())
      throw std::invalid_argument(
          fmt::format("{}: the scale of the latent force must be finite at its {} nodes",
                      data.trialName(trial), n));
    roots_.push_back(G.asDiagonal() * MatrixXd(K.llt().matrixL()));
  }
}

Index Likelihood::samples() const {
  Index n = 0;
  for (const int trial : trials_) n += data_.measured(trial).size();
  return n;
}

double Likelihood::cost(const Hypothesis&, const Noise& noise, const Point& point) const {
  double cost = 0.5 * point.xi.squaredNorm();
  for (std::size_t t = 0; t < trials_.size(); ++t) {
    VectorXd force;
    if (point.eta[t].size() != 0) {
      force = noise.latent * (roots_[t] * point.eta[t]);
      cost += 0.5 * point.eta[t].squaredNorm();
    }
    const VectorXd y = data_.outputs(trials_[t], point.values, force);
    cost += 0.5 * (data_.measured(trials_[t]) - y).squaredNorm() / (noise.output * noise.output);
  }
  return std::isfinite(cost) ? cost : kInfinity;
}

Likelihood::Linear Likelihood::linearise(std::size_t at, const Hypothesis& hypothesis,
                                         double latentSize, const VectorXd& values,
                                         const VectorXd& xi, const VectorXd& eta,
                                         const std::vector<std::size_t>& extra, bool force) const {
  std::vector<std::size_t> wanted = wantedOf(hypothesis);
  const auto p = static_cast<Index>(wanted.size());
  wanted.insert(wanted.end(), extra.begin(), extra.end());
  const bool latent = eta.size() != 0;
  VectorXd d;
  if (latent) d = latentSize * (roots_[at] * eta);
  Disagreement::Prediction prediction =
      data_.predict(trials_[at], values, d, wanted, latent || force);
  Linear linear;
  linear.residuals = data_.measured(trials_[at]) - prediction.outputs;
  linear.gamma = prediction.gamma.leftCols(p);
  for (Index i = 0; i < p; ++i)
    linear.gamma.col(i) *= hypothesis.free[static_cast<std::size_t>(i)].slope(xi[i]);
  linear.extra = prediction.gamma.rightCols(prediction.gamma.cols() - p);
  linear.latent = latent ? MatrixXd(latentSize * (prediction.latentGamma *
                                                  roots_[at].triangularView<Eigen::Lower>()))
                         : MatrixXd(linear.residuals.size(), 0);
  if (force) linear.force = std::move(prediction.latentGamma);
  linear.speeds = std::move(prediction.speeds);
  return linear;
}

Likelihood::Linear Likelihood::linearise(std::size_t at, const Fit& fit, const VectorXd& values,
                                         const std::vector<std::size_t>& extra, bool force) const {
  return linearise(at, fit.hypothesis, fit.noise.latent, values, fit.xi, fit.eta[at], extra, force);
}

Fit Likelihood::fit(const Hypothesis& hypothesis, const Noise& noise, const VectorXd& start,
                    const std::vector<VectorXd>& eta, const FitOptions& options) const {
  if (!(noise.output > 0) || !(noise.latent >= 0))
    throw std::invalid_argument(fmt::format("noise: σ_y {} must be above 0 and σ_d {} not below",
                                            noise.output, noise.latent));
  const auto p = static_cast<Index>(hypothesis.free.size());
  const double precision = 1 / (noise.output * noise.output);

  // where to start
  Point point;
  point.xi.resize(p);
  for (Index i = 0; i < p; ++i) {
    const FreeQuantity& q = hypothesis.free[static_cast<std::size_t>(i)];
    point.xi[i] =
        std::clamp(q.coordinate(start[static_cast<Index>(q.quantity)]), q.lowest, q.highest);
  }
  point.values = withCoordinates(hypothesis, start, point.xi);
  for (std::size_t t = 0; t < trials_.size(); ++t) {
    const Index n = noise.latent > 0 ? roots_[t].rows() : 0;
    const bool given = t < eta.size() && eta[t].size() == n;
    point.eta.push_back(given ? eta[t] : VectorXd(VectorXd::Zero(n)));
  }
  Fit fit;
  fit.hypothesis = hypothesis;
  fit.noise = noise;
  fit.cost = cost(hypothesis, noise, point);
  if (!std::isfinite(fit.cost)) {
    for (VectorXd& e : point.eta) e.setZero();
    fit.cost = cost(hypothesis, noise, point);
  }
  if (!std::isfinite(fit.cost))
    throw std::domain_error("discover: the model cannot be simulated where the fit starts");

  std::vector<Linear> trials(trials_.size());
  const auto relinearise = [&] {
    for (std::size_t t = 0; t < trials_.size(); ++t)
      trials[t] =
          linearise(t, hypothesis, noise.latent, point.values, point.xi, point.eta[t], {}, false);
  };
  relinearise();

  double damping = 1e-6;
  for (fit.iterations = 0; fit.iterations < options.iterations; ++fit.iterations) {
    // normal equations of what there is at this point
    MatrixXd information = MatrixXd::Identity(p, p);
    VectorXd gradient = point.xi;
    std::vector<MatrixXd> blocks, coupling;
    std::vector<VectorXd> latentRight;
    for (std::size_t t = 0; t < trials.size(); ++t) {
      const Linear& l = trials[t];
      information.noalias() += precision * l.gamma.transpose() * l.gamma;
      gradient.noalias() -= precision * l.gamma.transpose() * l.residuals;
      blocks.push_back(latentBlock(l.latent, noise.output));
      coupling.push_back(precision * l.latent.transpose() * l.gamma);
      latentRight.push_back(precision * l.latent.transpose() * l.residuals - point.eta[t]);
    }
    bool accepted = false;
    for (int attempt = 0; attempt < 12 && !accepted && !fit.converged; ++attempt) {
      // eliminate each trial's latent force
      MatrixXd R = information;
      VectorXd right = -gradient;
      R.diagonal() *= 1 + damping;
      std::vector<Eigen::LLT<MatrixXd>> factors;
      for (std::size_t t = 0; t < trials.size(); ++t) {
        MatrixXd C = blocks[t];
        C.diagonal().array() += damping;
        factors.push_back(C.llt());
        if (coupling[t].rows() == 0) continue;
        const MatrixXd half = factors[t].matrixL().solve(coupling[t]);
        const VectorXd halfRight = factors[t].matrixL().solve(latentRight[t]);
        R.noalias() -= half.transpose() * half;
        right.noalias() -= half.transpose() * halfRight;
      }
      // what a bound holds back does not move
      std::vector<Index> moving;
      for (Index i = 0; i < p; ++i) {
        const FreeQuantity& q = hypothesis.free[static_cast<std::size_t>(i)];
        const bool held = (point.xi[i] <= q.lowest && right[i] < 0) ||
                          (point.xi[i] >= q.highest && right[i] > 0) || q.lowest >= q.highest;
        if (!held) moving.push_back(i);
      }
      Step step;
      step.xi = VectorXd::Zero(p);
      if (!moving.empty()) {
        const MatrixXd free = R(moving, moving);
        const VectorXd pull = right(moving);
        const VectorXd solved = free.llt().solve(pull);
        for (std::size_t i = 0; i < moving.size(); ++i)
          step.xi[moving[i]] = solved[static_cast<Index>(i)];
      }
      Point next = point;
      for (Index i = 0; i < p; ++i) {
        const FreeQuantity& q = hypothesis.free[static_cast<std::size_t>(i)];
        next.xi[i] = std::clamp(point.xi[i] + step.xi[i], q.lowest, q.highest);
      }
      step.xi = next.xi - point.xi;
      step.gain = -0.5 * gradient.dot(step.xi);
      for (std::size_t t = 0; t < trials.size(); ++t) {
        if (coupling[t].rows() == 0) continue;
        step.eta.push_back(factors[t].solve(latentRight[t] - coupling[t] * step.xi));
        step.gain += 0.5 * latentRight[t].dot(step.eta.back());
        next.eta[t] += step.eta.back();
      }
      if (std::abs(step.gain) < options.tolerance && damping < 0.1) {
        fit.converged = true;
        break;
      }
      next.values = withCoordinates(hypothesis, point.values, next.xi);
      const double nextCost = cost(hypothesis, noise, next);
      if (nextCost < fit.cost) {
        accepted = true;
        const double ratio = (fit.cost - nextCost) / std::max(step.gain, 1e-12);
        damping = std::max(1e-8, damping * (ratio > 0.7 ? 0.1 : ratio > 0.3 ? 0.5 : 2));
        fit.cost = nextCost;
        point = std::move(next);
      } else {
        damping = std::max(1e-3, damping * 8);
      }
    }
    if (!accepted) break;
    relinearise();
  }
  fit.values = std::move(point.values);
  fit.xi = std::move(point.xi);
  fit.eta = std::move(point.eta);
  finish(fit, trials);
  return fit;
}

// Laplace's evidence, the posterior covariance, and what the latent force has used up.
void Likelihood::finish(Fit& fit, const std::vector<Linear>& trials) const {
  const Hypothesis& h = fit.hypothesis;
  const Index p = fit.xi.size();
  const double precision = 1 / (fit.noise.output * fit.noise.output);
  MatrixXd R = MatrixXd::Identity(p, p);
  VectorXd gradient = fit.xi;
  double logDeterminant = 0;
  fit.latentPower = 0;
  fit.latentFreedom = 0;
  Index samples = 0;
  std::vector<MatrixXd> carried;  // C⁻¹WᵀΓ/σ², how η follows ξ
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const Linear& l = trials[t];
    samples += l.residuals.size();
    R.noalias() += precision * l.gamma.transpose() * l.gamma;
    gradient.noalias() -= precision * l.gamma.transpose() * l.residuals;
    if (l.latent.cols() == 0) continue;
    const auto block = latentBlock(l.latent, fit.noise.output).llt();
    const MatrixXd L = block.matrixL();
    logDeterminant += 2 * L.diagonal().array().log().sum();
    const MatrixXd half =
        block.matrixL().solve(MatrixXd(precision * l.latent.transpose() * l.gamma));
    R.noalias() -= half.transpose() * half;
    const MatrixXd inverse = block.matrixL().solve(MatrixXd::Identity(L.rows(), L.rows()));
    fit.latentPower += fit.eta[t].squaredNorm();
    fit.latentFreedom += static_cast<double>(L.rows()) - inverse.squaredNorm();
    carried.push_back(inverse.transpose() * half);
  }
  // the parameters: those at a bound have a one-sided mass of their own
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
      const double deviation = std::sqrt(fit.covariance(i, i));
      mass +=
          logNormalWithin((q.lowest - fit.xi[i]) / deviation, (q.highest - fit.xi[i]) / deviation);
    }
  }
  for (const MatrixXd& c : carried) fit.latentFreedom -= (c * fit.covariance).cwiseProduct(c).sum();
  fit.logEvidence =
      -fit.cost - 0.5 * logDeterminant + mass -
      static_cast<double>(samples) * std::log(fit.noise.output * std::sqrt(2 * std::numbers::pi));
}

Likelihood::Projected Likelihood::project(const Fit& fit, const std::vector<Linear>& trials,
                                          const std::vector<MatrixXd>& disturbances) const {
  const double precision = 1 / (fit.noise.output * fit.noise.output);
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
    gram.noalias() += precision * Q.transpose() * Q;
    if (l.latent.cols() == 0) continue;
    const auto block = latentBlock(l.latent, fit.noise.output).llt();
    const MatrixXd half = block.matrixL().solve(MatrixXd(precision * l.latent.transpose() * Q));
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

VectorXd Likelihood::innovations(std::size_t at, const Fit& fit) const {
  const Linear l = linearise(at, fit, fit.values, {}, false);
  if (l.latent.cols() == 0) return l.residuals / fit.noise.output;
  const Index n = l.residuals.size();
  MatrixXd S = MatrixXd::Zero(n, n);
  S.selfadjointView<Eigen::Lower>().rankUpdate(l.latent);
  S.diagonal().array() += fit.noise.output * fit.noise.output;
  return S.llt().matrixL().solve(VectorXd(l.residuals + l.latent * fit.eta[at]));
}

VectorXd Likelihood::force(std::size_t at, const Fit& fit) const {
  if (fit.eta[at].size() == 0) return VectorXd::Zero(roots_[at].rows());
  return fit.noise.latent * (roots_[at] * fit.eta[at]);
}

VectorXd Likelihood::forceDeviation(std::size_t at, const Fit& fit) const {
  if (fit.eta[at].size() == 0) return VectorXd::Zero(roots_[at].rows());
  const Linear l = linearise(at, fit, fit.values, {}, false);
  const double precision = 1 / (fit.noise.output * fit.noise.output);
  const auto block = latentBlock(l.latent, fit.noise.output).llt();
  // var η = C⁻¹ + C⁻¹ B cov(ξ) Bᵀ C⁻¹
  const MatrixXd B = block.solve(MatrixXd(precision * l.latent.transpose() * l.gamma));
  MatrixXd variance = block.solve(MatrixXd::Identity(B.rows(), B.rows()));
  variance.noalias() += B * fit.covariance * B.transpose();
  const MatrixXd root = fit.noise.latent * roots_[at];
  return (root * variance * root.transpose()).diagonal().cwiseMax(0).cwiseSqrt();
}

double Likelihood::simulationError(const VectorXd& values) const {
  double sum = 0;
  for (const int trial : trials_)
    sum += (data_.measured(trial) - data_.outputs(trial, values, {})).squaredNorm();
  return std::sqrt(sum / static_cast<double>(samples()));
}

OutputDeviation estimateOutputDeviation(const Disagreement& data, const std::vector<int>& trials) {
  double sum = 0;
  double count = 0;
  for (const int trial : trials) {
    const auto& t = data.times(trial);
    const VectorXd& y = data.measured(trial);
    for (std::size_t k = 3; k < t.size(); ++k) {
      const double step = t[k] - t[k - 1];
      if (std::abs(t[k - 1] - t[k - 2] - step) > 1e-3 * step ||
          std::abs(t[k - 2] - t[k - 3] - step) > 1e-3 * step)
        continue;
      const auto i = static_cast<Index>(k);
      const double third = y[i] - 3 * y[i - 1] + 3 * y[i - 2] - y[i - 3];
      sum += third * third;
      ++count;
    }
  }
  if (!(sum > 0))
    throw std::invalid_argument(
        "output deviation: there must be four equally spaced samples that are not on a parabola");
  // third differences of white noise have variance 20σ², and autocorrelations −15, 6, −1 of 20
  return {std::sqrt(sum / (20 * count)), std::sqrt(2 * (1 + 2 * 262.0 / 400.0) / count)};
}

}  // namespace info::discover
