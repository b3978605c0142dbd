#include "info/discover/joint_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "latent_block.h"

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

// The normal equations over (ξ, η) at a point, η's own blocks apart.
struct Likelihood::Normal {
  MatrixXd information;
  VectorXd gradient;
  std::vector<MatrixXd> blocks, coupling;  // per trial
  std::vector<VectorXd> latentRight;
};

struct Likelihood::Step {
  Point to;
  double gain = 0;  // nats that the linear model promises
};

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
        K(i, j) = latentCorrelation(
            std::abs(nodes[static_cast<std::size_t>(i)] - nodes[static_cast<std::size_t>(j)]),
            latentTime, data.latentLag());
    const MatrixXd G = data.predict(trial, values, {}, {}, true).latentScale;
    if (G.rows() != n || G.cols() < 1 || !G.allFinite())
      throw std::invalid_argument(
          fmt::format("{}: the scale of the latent force must be finite at its {} nodes",
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

double Likelihood::simulatedCost(const Noise& noise, const Point& point) const {
  double squares = 0;
  for (std::size_t t = 0; t < trials_.size(); ++t) {
    VectorXd force;
    if (point.eta[t].size() != 0) force = noise.latent * (roots_[t] * point.eta[t]);
    const VectorXd y = data_.outputs(trials_[t], point.values, force);
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

Likelihood::Normal Likelihood::normalEquations(const std::vector<Linear>& trials,
                                               const Noise& noise, const Point& point) const {
  const double precision = 1 / (noise.output * noise.output);
  Normal normal;
  normal.information = MatrixXd::Identity(point.xi.size(), point.xi.size());
  normal.gradient = point.xi;
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const Linear& l = trials[t];
    normal.information.noalias() += precision * l.gamma.transpose() * l.gamma;
    normal.gradient.noalias() -= precision * l.gamma.transpose() * l.residuals;
    normal.blocks.push_back(latentBlock(l.latent, noise.output));
    normal.coupling.push_back(precision * l.latent.transpose() * l.gamma);
    normal.latentRight.push_back(precision * l.latent.transpose() * l.residuals - point.eta[t]);
  }
  return normal;
}

// A damped step within the bounds; each trial's latent force is eliminated, then follows.
Likelihood::Step Likelihood::step(const Hypothesis& hypothesis, const Normal& normal,
                                  const Point& point, double damping) const {
  const Index p = point.xi.size();
  MatrixXd R = normal.information;
  VectorXd right = -normal.gradient;
  R.diagonal() *= 1 + damping;
  std::vector<Eigen::LLT<MatrixXd>> factors;
  for (std::size_t t = 0; t < normal.blocks.size(); ++t) {
    MatrixXd C = normal.blocks[t];
    C.diagonal().array() += damping;
    factors.push_back(C.llt());
    if (normal.coupling[t].rows() == 0) continue;
    const MatrixXd half = factors[t].matrixL().solve(normal.coupling[t]);
    const VectorXd halfRight = factors[t].matrixL().solve(normal.latentRight[t]);
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
  VectorXd move = VectorXd::Zero(p);
  if (!moving.empty()) {
    const MatrixXd free = R(moving, moving);
    const VectorXd pull = right(moving);
    const VectorXd solved = free.llt().solve(pull);
    move(moving) = solved;
  }
  Step step{point, 0};
  for (Index i = 0; i < p; ++i) {
    const FreeQuantity& q = hypothesis.free[static_cast<std::size_t>(i)];
    step.to.xi[i] = std::clamp(point.xi[i] + move[i], q.lowest, q.highest);
  }
  move = step.to.xi - point.xi;
  step.gain = -0.5 * normal.gradient.dot(move);
  for (std::size_t t = 0; t < normal.blocks.size(); ++t) {
    if (normal.coupling[t].rows() == 0) continue;
    const VectorXd eta = factors[t].solve(normal.latentRight[t] - normal.coupling[t] * move);
    step.gain += 0.5 * normal.latentRight[t].dot(eta);
    step.to.eta[t] += eta;
  }
  step.to.values = withCoordinates(hypothesis, point.values, step.to.xi);
  return step;
}

Fit Likelihood::fit(const Hypothesis& hypothesis, const Noise& noise, const VectorXd& start,
                    const std::vector<VectorXd>& eta, const FitOptions& options) const {
  std::optional<Fit> fit = tryFit(hypothesis, noise, start, eta, options);
  if (!fit) throw std::domain_error("discover: the model cannot be simulated where the fit starts");
  return std::move(*fit);
}

std::optional<Fit> Likelihood::tryFit(const Hypothesis& hypothesis, const Noise& noise,
                                      const VectorXd& start, const std::vector<VectorXd>& eta,
                                      const FitOptions& options) const {
  if (!(noise.output > 0) || !(noise.latent >= 0))
    throw std::invalid_argument(fmt::format("noise: σ_y {} must be above 0 and σ_d {} not below",
                                            noise.output, noise.latent));
  const auto p = static_cast<Index>(hypothesis.free.size());

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
  const auto linearised = [&](const Point& at) {
    std::vector<Linear> linear;
    for (std::size_t t = 0; t < trials_.size(); ++t)
      linear.push_back(
          linearise(t, hypothesis, noise.latent, at.values, at.xi, at.eta[t], {}, false));
    return linear;
  };
  const auto costOf = [&](const std::vector<Linear>& linear, const Point& at) {
    double squares = 0;
    for (const Linear& l : linear) squares += l.residuals.squaredNorm();
    return cost(noise, at, squares);
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
  for (fit.iterations = 0; fit.iterations < options.iterations; ++fit.iterations) {
    const Normal normal = normalEquations(trials, noise, point);
    bool accepted = false;
    for (int attempt = 0; attempt < 12 && !accepted; ++attempt) {
      Step next = step(hypothesis, normal, point, damping);
      if (std::abs(next.gain) < options.tolerance && damping < 0.1) {
        fit.converged = true;
        break;
      }
      // the first attempt mostly succeeds, and then its derivatives are needed, too
      std::vector<Linear> there;
      double nextCost = kInfinity;
      if (next.to.values.allFinite()) {
        if (attempt == 0) there = linearised(next.to);
        nextCost = attempt == 0 ? costOf(there, next.to) : simulatedCost(noise, next.to);
      }
      if (nextCost < fit.cost) {
        accepted = true;
        const double ratio = (fit.cost - nextCost) / std::max(next.gain, 1e-12);
        damping = std::max(1e-8, damping * (ratio > 0.7 ? 0.1 : ratio > 0.3 ? 0.5 : 2));
        fit.cost = nextCost;
        point = std::move(next.to);
        trials = attempt == 0 ? std::move(there) : linearised(point);
      } else {
        damping = std::max(1e-3, damping * 8);
      }
    }
    if (!accepted) break;
  }
  fit.values = std::move(point.values);
  fit.xi = std::move(point.xi);
  fit.eta = std::move(point.eta);
  finish(fit, trials);
  return fit;
}

double Likelihood::simulationError(const VectorXd& values) const {
  double sum = 0;
  for (const int trial : trials_)
    sum += (data_.measured(trial) - data_.outputs(trial, values, {})).squaredNorm();
  return std::sqrt(sum / static_cast<double>(samples()));
}

}  // namespace info::discover
