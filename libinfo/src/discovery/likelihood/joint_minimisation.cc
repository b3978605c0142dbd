#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "discovery/likelihood/damped_system.h"
#include "discovery/likelihood/joint_point.h"
#include "discovery/likelihood/latent_block.h"
#include "info/discovery/likelihood/joint_fit.h"

// The joint fit: Levenberg and Marquardt's damped Gauss–Newton steps with geodesic acceleration.

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

VectorXd withCoordinates(const Hypothesis& h, VectorXd values, const VectorXd& xi) {
  for (std::size_t i = 0; i < h.free.size(); ++i)
    values[static_cast<Index>(h.free[i].quantity)] = h.free[i].value(xi[static_cast<Index>(i)]);
  return values;
}

}  // namespace

Likelihood::Normal Likelihood::normalEquations(const std::vector<Linear>& trials,
                                               const Point& point) {
  Normal normal;
  DampedSystem::Blocks& blocks = normal.blocks;
  blocks.information = MatrixXd::Identity(point.xi.size(), point.xi.size());
  normal.downhill.xi = -point.xi;
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const Linear& l = trials[t];
    blocks.information.noalias() += l.gamma.transpose() * l.gamma;
    blocks.latent.push_back(latentBlock(l.latent));
    blocks.coupling.push_back(l.latent.transpose() * l.gamma);
    normal.downhill.xi.noalias() += l.gamma.transpose() * l.residuals;
    normal.downhill.eta.push_back(l.latent.transpose() * l.residuals - point.eta[t]);
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
// + ½a with (JᵀJ + 1 + λ) a = −Jᵀy_vv, everything in σ. The correction is omitted if it is not
// small relative to v.
void Likelihood::bend(Step& step, const Hypothesis& hypothesis, const Noise& noise,
                      const std::vector<Linear>& trials, const DampedSystem& system,
                      const Point& point) const {
  const double length = step.move.norm();
  if (!(length > 0) || !step.to.values.allFinite()) return;
  const Point ahead = moved(hypothesis, point, step.move, kProbe);
  JointVector right{VectorXd::Zero(point.xi.size()), {}};
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const Linear& l = trials[t];
    VectorXd change =
        data_.outputs(trials_[t], ahead.values, latentForce(t, noise, ahead.eta[t])) - l.outputs;
    whiten(t, noise, change);
    VectorXd curve = change / kProbe - l.gamma * step.move.xi;
    if (l.latent.cols() > 0) curve.noalias() -= l.latent * step.move.eta[t];
    curve *= 2 / kProbe;
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

// The iteration of one joint fit: its minimised function J + cᵀξ, and the state that every step
// changes.
class Likelihood::JointMinimisation {
 public:
  JointMinimisation(const Likelihood& likelihood, const Hypothesis& hypothesis, const Noise& noise,
                    const FitOptions& options)
      : likelihood_(likelihood),
        hypothesis_(hypothesis),
        noise_(noise),
        options_(options),
        tilt_(options.tilt.size() == 0
                  ? VectorXd(VectorXd::Zero(static_cast<Index>(hypothesis.free.size())))
                  : options.tilt) {}

  /// Whether the model can be simulated at the start; if not with the latent forces given, they
  /// become 0.
  bool start(const VectorXd& values, const std::vector<VectorXd>& eta);
  void minimise();
  Fit result();

 private:
  /// The outcome of an iteration.
  enum class End { improved, converged, stuck };

  Point startPoint(const VectorXd& values, const std::vector<VectorXd>& eta) const;
  std::vector<Linear> linearised(const Point& at) const;
  std::vector<Linear> linearisedIfLess(const Point& at, bool isFirst) const;
  double costOf(const std::vector<Linear>& linear, const Point& at) const;
  End improve(const Normal& normal);
  bool tryStep(Step& next, const DampedSystem& system, bool isFirst);
  void accept(Step& next, std::vector<Linear> there, double cost);

  const Likelihood& likelihood_;
  const Hypothesis& hypothesis_;
  const Noise& noise_;
  const FitOptions& options_;
  VectorXd tilt_;
  Point point_;
  std::vector<Linear> trials_;  // linearised there
  double cost_ = kInfinity;
  double damping_ = 1e-6;
  int iterations_ = 0;
  int idle_ = 0;  // consecutive iterations with negligible gain
  bool converged_ = false;
};

Likelihood::Point Likelihood::JointMinimisation::startPoint(
    const VectorXd& values, const std::vector<VectorXd>& eta) const {
  Point point;
  point.xi.resize(static_cast<Index>(hypothesis_.free.size()));
  for (Index i = 0; i < point.xi.size(); ++i) {
    const FreeQuantity& q = hypothesis_.free[static_cast<std::size_t>(i)];
    point.xi[i] =
        std::clamp(q.coordinate(values[static_cast<Index>(q.quantity)]), q.lowest, q.highest);
  }
  point.values = withCoordinates(hypothesis_, values, point.xi);
  for (std::size_t t = 0; t < likelihood_.trials_.size(); ++t) {
    const Index n = noise_.latent > 0 ? likelihood_.roots_[t].rows() : 0;
    const bool given = t < eta.size() && eta[t].size() == n;
    point.eta.push_back(given ? eta[t] : VectorXd(VectorXd::Zero(n)));
  }
  return point;
}

std::vector<Likelihood::Linear> Likelihood::JointMinimisation::linearised(const Point& at) const {
  std::vector<Linear> linear;
  for (std::size_t t = 0; t < likelihood_.trials_.size(); ++t)
    linear.push_back(
        likelihood_.linearise(t, hypothesis_, noise_, at.values, at.xi, at.eta[t], {}, false));
  return linear;
}

// ∞ also if a simulation has no finite derivatives, or if their squares overflow: no step can start
// there.
double Likelihood::JointMinimisation::costOf(const std::vector<Linear>& linear,
                                             const Point& at) const {
  double squares = 0;
  for (const Linear& l : linear) {
    if (!std::isfinite(l.gamma.squaredNorm() + l.latent.squaredNorm())) return kInfinity;
    squares += l.residuals.squaredNorm();
  }
  return Likelihood::cost(at, squares) + tilt_.dot(at.xi);
}

bool Likelihood::JointMinimisation::start(const VectorXd& values,
                                          const std::vector<VectorXd>& eta) {
  point_ = startPoint(values, eta);
  trials_ = linearised(point_);
  cost_ = costOf(trials_, point_);
  if (!std::isfinite(cost_) && !eta.empty()) {
    for (VectorXd& e : point_.eta) e.setZero();
    trials_ = linearised(point_);
    cost_ = costOf(trials_, point_);
  }
  return std::isfinite(cost_);
}

void Likelihood::JointMinimisation::minimise() {
  for (iterations_ = 0; iterations_ < options_.iterations; ++iterations_) {
    Normal normal = normalEquations(trials_, point_);
    normal.downhill.xi -= tilt_;
    if (idle_ >= kIdle &&
        likelihood_.step(hypothesis_, normal, DampedSystem(normal.blocks, 0), point_).gain <
            kAtAKink) {
      converged_ = true;
      break;
    }
    const End end = improve(normal);
    converged_ = converged_ || end == End::converged;
    if (end != End::improved) break;
  }
}

// Raises the damping until a step lowers the cost.
Likelihood::JointMinimisation::End Likelihood::JointMinimisation::improve(const Normal& normal) {
  double growth = 8;
  for (int attempt = 0; attempt < 12; ++attempt) {
    const DampedSystem system(normal.blocks, damping_);
    Step next = likelihood_.step(hypothesis_, normal, system, point_);
    if (std::abs(next.gain) < options_.tolerance && damping_ < 0.1) return End::converged;
    if (tryStep(next, system, attempt == 0)) return End::improved;
    damping_ = std::max(iterations_ == 0 ? 1e-3 : 1e-7, damping_ * growth);
    growth *= 4;
  }
  return End::stuck;
}

bool Likelihood::JointMinimisation::tryStep(Step& next, const DampedSystem& system, bool isFirst) {
  likelihood_.bend(next, hypothesis_, noise_, trials_, system, point_);
  if (!next.to.values.allFinite()) return false;
  std::vector<Linear> there = linearisedIfLess(next.to, isFirst);
  if (there.empty()) return false;
  const double cost = costOf(there, next.to);
  if (!(cost < cost_)) return false;
  accept(next, std::move(there), cost);
  return true;
}

// Derivatives are computed where the cost is less than here; else, empty, and the remaining trials,
// which could only add to the cost, are not simulated.
std::vector<Likelihood::Linear> Likelihood::JointMinimisation::linearisedIfLess(
    const Point& at, bool isFirst) const {
  std::vector<std::unique_ptr<DiscoveryProblem::Simulation>> simulations;
  double squares = 0;
  for (std::size_t t = 0; t < likelihood_.trials_.size(); ++t) {
    auto simulation = likelihood_.simulated(t, hypothesis_, noise_, at);
    if (!simulation) {
      // the first attempt mostly succeeds, and then its derivatives are needed as well
      const bool isLess =
          isFirst || likelihood_.simulatedCost(noise_, at) + tilt_.dot(at.xi) < cost_;
      return isLess ? linearised(at) : std::vector<Linear>();
    }
    VectorXd e = likelihood_.data_.measured(likelihood_.trials_[t]) - simulation->outputs();
    likelihood_.whiten(t, noise_, e);
    squares += e.squaredNorm();
    if (!(Likelihood::cost(at, squares) + tilt_.dot(at.xi) < cost_)) return {};
    simulations.push_back(std::move(simulation));
  }
  std::vector<Linear> linear;
  for (std::size_t t = 0; t < simulations.size(); ++t)
    linear.push_back(likelihood_.linearOf(t, hypothesis_, noise_, at.xi, simulations[t]->predict(),
                                          at.eta[t].size() != 0, false));
  return linear;
}

void Likelihood::JointMinimisation::accept(Step& next, std::vector<Linear> there, double cost) {
  const double ratio = (cost_ - cost) / std::max(next.gain, 1e-12);
  damping_ = std::max(1e-8, damping_ * (ratio > 0.7 ? 0.1 : ratio > 0.3 ? 0.5 : 2));
  idle_ = cost_ - cost < options_.tolerance ? idle_ + 1 : 0;
  cost_ = cost;
  point_ = std::move(next.to);
  trials_ = std::move(there);
}

Fit Likelihood::JointMinimisation::result() {
  Fit fit;
  fit.hypothesis = hypothesis_;
  fit.noise = noise_;
  fit.iterations = iterations_;
  fit.converged = converged_;
  fit.values = std::move(point_.values);
  fit.xi = std::move(point_.xi);
  fit.eta = std::move(point_.eta);
  fit.cost = cost_ - tilt_.dot(fit.xi);
  likelihood_.finish(fit, trials_, tilt_);
  return fit;
}

std::optional<Fit> Likelihood::tryFit(const Hypothesis& hypothesis, const Noise& noise,
                                      const VectorXd& start, const std::vector<VectorXd>& eta,
                                      const FitOptions& options) const {
  if (!noise.output.isPositive() || !(noise.latent >= 0))
    throw std::invalid_argument(fmt::format("noise: σ_y = {} must be > 0 and σ_d = {} must be ≥ 0",
                                            noise.output.sd(0), noise.latent));
  JointMinimisation minimisation(*this, hypothesis, noise, options);
  if (!minimisation.start(start, eta)) return std::nullopt;
  minimisation.minimise();
  return minimisation.result();
}

}  // namespace info::discover
