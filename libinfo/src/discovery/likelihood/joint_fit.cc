#include "info/discovery/likelihood/joint_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "discovery/likelihood/damped_system.h"
#include "discovery/likelihood/latent_block.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Fraction of a step at which its curvature is evaluated, and the largest accepted 2|a|/|v|, both
// from Transtrum and Sethna (arXiv:1201.5885).
constexpr double kProbe = 0.1, kMostBend = 0.75;

// At a kink of J (a contact that just begins, an input that is clipped) the decrease predicted by
// Newton's step is not attained. The iteration ends after this many iterations without gain, if the
// predicted gain is below this many nats.
constexpr int kIdle = 3;
constexpr double kAtAKink = 1;

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

}  // namespace

double latentCorrelation(double interval, double time, double lag) {
  if (!(lag > 0)) return std::exp(-interval / time);
  if (std::abs(lag - time) < 1e-3 * time) {  // the limit of equal times
    const double x = 2 * interval / (time + lag);
    return (1 + x) * std::exp(-x);
  }
  return (time * std::exp(-interval / time) - lag * std::exp(-interval / lag)) / (time - lag);
}

struct Likelihood::Point {
  VectorXd values, xi;
  std::vector<VectorXd> eta;
};

// The normal equations over (ξ, η) at a point.
struct Likelihood::Normal {
  DampedSystem::Blocks blocks;
  JointVector downhill;  // −dJ/d(ξ, η)
};

struct Likelihood::Step {
  Point to;
  double gain = 0;            // gain predicted by the linear model [nats]
  JointVector move;           // first-order step
  std::vector<Index> moving;  // ξ not blocked by a bound
};

Likelihood::Likelihood(const DiscoveryProblem& data, std::vector<int> trials,
                       const VectorXd& values, double latentTime)
    : data_(data), trials_(std::move(trials)) {
  if (trials_.empty()) throw std::invalid_argument("likelihood: no trial, must have at least one");
  for (const int trial : trials_) {
    const auto& nodes = data.latentTimes(trial);
    const VectorXd& measured = data.measured(trial);
    const auto n = static_cast<Index>(nodes.size());
    if (measured.size() == 0 || !measured.allFinite() ||
        measured.size() != static_cast<Index>(data.times(trial).size()))
      throw std::invalid_argument(
          fmt::format("{}: samples must be finite, at least one, and one for each time",
                      data.trialName(trial)));
    MatrixXd K(n, n);
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j)
        K(i, j) = latentCorrelation(
            std::abs(nodes[static_cast<std::size_t>(i)] - nodes[static_cast<std::size_t>(j)]),
            latentTime, data.latentLag());
    const MatrixXd G = data.predict(trial, values, {}, {}, true).latentScale;
    if (G.rows() != n || G.cols() < 1 || !G.allFinite())
      throw std::invalid_argument(
          fmt::format("{}: scale of the latent force must be finite at its {} nodes",
                      data.trialName(trial), n));
    roots_.push_back(K.cwiseProduct(G * G.transpose()).llt().matrixL());
  }
}

Index Likelihood::samples() const {
  Index n = 0;
  for (const int trial : trials_) n += data_.measured(trial).size();
  return n;
}

// J of residuals whose squares have this sum.
double Likelihood::cost(const Noise& noise, const Point& point, double squares) {
  double cost = 0.5 * point.xi.squaredNorm() + 0.5 * squares / (noise.output * noise.output);
  for (const VectorXd& eta : point.eta) cost += 0.5 * eta.squaredNorm();
  return std::isfinite(cost) ? cost : kInfinity;
}

VectorXd Likelihood::latentForce(std::size_t at, const Noise& noise, const VectorXd& eta) const {
  if (eta.size() == 0) return {};
  return noise.latent * (roots_[at] * eta);
}

double Likelihood::simulatedCost(const Noise& noise, const Point& point) const {
  double squares = 0;
  for (std::size_t t = 0; t < trials_.size(); ++t) {
    const VectorXd y = data_.outputs(trials_[t], point.values, latentForce(t, noise, point.eta[t]));
    squares += (data_.measured(trials_[t]) - y).squaredNorm();
  }
  return cost(noise, point, squares);
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
  DiscoveryProblem::Prediction prediction =
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

Likelihood::Normal Likelihood::normalEquations(const std::vector<Linear>& trials,
                                               const Noise& noise, const Point& point) const {
  const double precision = 1 / (noise.output * noise.output);
  Normal normal;
  DampedSystem::Blocks& blocks = normal.blocks;
  blocks.information = MatrixXd::Identity(point.xi.size(), point.xi.size());
  normal.downhill.xi = -point.xi;
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const Linear& l = trials[t];
    blocks.information.noalias() += precision * l.gamma.transpose() * l.gamma;
    blocks.latent.push_back(latentBlock(l.latent, noise.output));
    blocks.coupling.push_back(precision * l.latent.transpose() * l.gamma);
    normal.downhill.xi.noalias() += precision * l.gamma.transpose() * l.residuals;
    normal.downhill.eta.push_back(precision * l.latent.transpose() * l.residuals - point.eta[t]);
  }
  return normal;
}

// A damped step within the bounds; components blocked by a bound do not change.
Likelihood::Step Likelihood::step(const Hypothesis& hypothesis, const Normal& normal,
                                  const DampedSystem& system, const Point& point) const {
  const VectorXd pull = system.pull(normal.downhill);
  Step step;
  for (Index i = 0; i < point.xi.size(); ++i) {
    const FreeQuantity& q = hypothesis.free[static_cast<std::size_t>(i)];
    const bool held = (point.xi[i] <= q.lowest && pull[i] < 0) ||
                      (point.xi[i] >= q.highest && pull[i] > 0) || q.lowest >= q.highest;
    if (!held) step.moving.push_back(i);
  }
  step.to = moved(hypothesis, point, {system.solve(pull, step.moving), {}}, 1);
  step.move.xi = step.to.xi - point.xi;
  step.move.eta = system.follow(normal.downhill, step.move.xi);
  step.gain = 0.5 * normal.downhill.xi.dot(step.move.xi);
  for (std::size_t t = 0; t < point.eta.size(); ++t) {
    step.gain += 0.5 * normal.downhill.eta[t].dot(step.move.eta[t]);
    step.to.eta[t] += step.move.eta[t];
  }
  return step;
}

Likelihood::Point Likelihood::moved(const Hypothesis& hypothesis, const Point& from,
                                    const JointVector& move, double share) {
  Point to = from;
  for (Index i = 0; i < to.xi.size(); ++i) {
    const FreeQuantity& q = hypothesis.free[static_cast<std::size_t>(i)];
    to.xi[i] = std::clamp(from.xi[i] + share * move.xi[i], q.lowest, q.highest);
  }
  for (std::size_t t = 0; t < move.eta.size(); ++t) to.eta[t] += share * move.eta[t];
  to.values = withCoordinates(hypothesis, from.values, to.xi);
  return to;
}

// Geodesic acceleration (docs/decisions/036-geodesic-acceleration.md). The outputs along a straight
// step v are y + Jv + ½y_vv; one more simulation at h·v gives y_vv, and the second-order step is v
// + ½a with (JᵀJ/σ² + 1 + λ) a = −Jᵀy_vv/σ². The correction is omitted if it is not small relative
// to v.
void Likelihood::bend(Step& step, const Hypothesis& hypothesis, const Noise& noise,
                      const std::vector<Linear>& trials, const DampedSystem& system,
                      const Point& point) const {
  const double length = step.move.norm(), precision = 1 / (noise.output * noise.output);
  if (!(length > 0) || !step.to.values.allFinite()) return;
  const Point ahead = moved(hypothesis, point, step.move, kProbe);
  JointVector right{VectorXd::Zero(point.xi.size()), {}};
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const Linear& l = trials[t];
    const VectorXd y = data_.outputs(trials_[t], ahead.values, latentForce(t, noise, ahead.eta[t]));
    const VectorXd slope = (y - data_.measured(trials_[t]) + l.residuals) / kProbe;
    VectorXd curve = slope - l.gamma * step.move.xi;
    if (l.latent.cols() > 0) curve.noalias() -= l.latent * step.move.eta[t];
    curve *= 2 / kProbe * precision;
    right.xi.noalias() -= l.gamma.transpose() * curve;
    right.eta.push_back(-(l.latent.transpose() * curve));
  }
  JointVector bent{system.solve(system.pull(right), step.moving), {}};
  bent.eta = system.follow(right, bent.xi);
  const double turn = bent.norm();
  if (!(2 * turn <= kMostBend * length)) return;  // also if the simulation failed there
  for (std::size_t t = 0; t < bent.eta.size(); ++t) bent.eta[t] *= 0.5;
  bent.xi *= 0.5;
  step.to = moved(hypothesis, step.to, bent, 1);
}

Fit Likelihood::fit(const Hypothesis& hypothesis, const Noise& noise, const VectorXd& start,
                    const std::vector<VectorXd>& eta, const FitOptions& options) const {
  std::optional<Fit> fit = tryFit(hypothesis, noise, start, eta, options);
  if (!fit)
    throw std::domain_error(
        "discover: the model cannot be simulated at the start values of the fit");
  return std::move(*fit);
}

std::optional<Fit> Likelihood::tryFit(const Hypothesis& hypothesis, const Noise& noise,
                                      const VectorXd& start, const std::vector<VectorXd>& eta,
                                      const FitOptions& options) const {
  if (!(noise.output > 0) || !(noise.latent >= 0))
    throw std::invalid_argument(fmt::format("noise: σ_y = {} must be > 0 and σ_d = {} must be ≥ 0",
                                            noise.output, noise.latent));
  const auto p = static_cast<Index>(hypothesis.free.size());

  // the starting point
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
  const auto linearised = [&](const Point& at) {
    std::vector<Linear> linear;
    for (std::size_t t = 0; t < trials_.size(); ++t)
      linear.push_back(
          linearise(t, hypothesis, noise.latent, at.values, at.xi, at.eta[t], {}, false));
    return linear;
  };
  const VectorXd tilt = options.tilt.size() == 0 ? VectorXd(VectorXd::Zero(p)) : options.tilt;
  // ∞ also if a simulation has no finite derivatives, or if their squares overflow: no step can
  // start there
  const auto costOf = [&](const std::vector<Linear>& linear, const Point& at) {
    double squares = 0;
    for (const Linear& l : linear) {
      if (!std::isfinite((l.gamma.squaredNorm() + l.latent.squaredNorm()) /
                         (noise.output * noise.output)))
        return kInfinity;
      squares += l.residuals.squaredNorm();
    }
    return cost(noise, at, squares) + tilt.dot(at.xi);
  };
  std::vector<Linear> trials = linearised(point);
  fit.cost = costOf(trials, point);
  if (!std::isfinite(fit.cost) && !eta.empty()) {
    for (VectorXd& e : point.eta) e.setZero();
    trials = linearised(point);
    fit.cost = costOf(trials, point);
  }
  if (!std::isfinite(fit.cost)) return std::nullopt;

  double damping = 1e-6;
  int idle = 0;  // consecutive iterations with negligible gain
  for (fit.iterations = 0; fit.iterations < options.iterations; ++fit.iterations) {
    Normal normal = normalEquations(trials, noise, point);
    normal.downhill.xi -= tilt;
    if (idle >= kIdle &&
        step(hypothesis, normal, DampedSystem(normal.blocks, 0), point).gain < kAtAKink) {
      fit.converged = true;
      break;
    }
    bool accepted = false;
    double growth = 8;
    for (int attempt = 0; attempt < 12 && !accepted; ++attempt) {
      const DampedSystem system(normal.blocks, damping);
      Step next = step(hypothesis, normal, system, point);
      if (std::abs(next.gain) < options.tolerance && damping < 0.1) {
        fit.converged = true;
        break;
      }
      bend(next, hypothesis, noise, trials, system, point);
      // the first attempt mostly succeeds, and then its derivatives are needed as well
      std::vector<Linear> there;
      double nextCost = kInfinity;
      const bool promising =
          next.to.values.allFinite() &&
          (attempt == 0 || simulatedCost(noise, next.to) + tilt.dot(next.to.xi) < fit.cost);
      if (promising) {
        there = linearised(next.to);
        nextCost = costOf(there, next.to);
      }
      if (nextCost < fit.cost) {
        accepted = true;
        const double ratio = (fit.cost - nextCost) / std::max(next.gain, 1e-12);
        damping = std::max(1e-8, damping * (ratio > 0.7 ? 0.1 : ratio > 0.3 ? 0.5 : 2));
        idle = fit.cost - nextCost < options.tolerance ? idle + 1 : 0;
        fit.cost = nextCost;
        point = std::move(next.to);
        trials = std::move(there);
      } else {
        damping = std::max(fit.iterations == 0 ? 1e-3 : 1e-7, damping * growth);
        growth *= 4;
      }
    }
    if (!accepted) break;
  }
  fit.values = std::move(point.values);
  fit.xi = std::move(point.xi);
  fit.eta = std::move(point.eta);
  fit.cost -= tilt.dot(fit.xi);
  finish(fit, trials, tilt);
  return fit;
}

double Likelihood::simulationError(const VectorXd& values) const {
  double sum = 0;
  for (const int trial : trials_)
    sum += (data_.measured(trial) - data_.outputs(trial, values, {})).squaredNorm();
  return std::sqrt(sum / static_cast<double>(samples()));
}

}  // namespace info::discover
