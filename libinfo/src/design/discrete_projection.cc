#include "info/design/discrete_projection.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "design/projection_checks.h"
#include "info/design/riccati.h"

namespace info {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Checked and filled; in place, so that the base class may have it.
StepDesign& prepared(StepDesign& c, const ExtendedStepMap& system) {
  if (!(c.timeStep > 0 && std::isfinite(c.timeStep)))
    throw std::domain_error(fmt::format("time step: {} s, must be > 0 and finite", c.timeStep));
  const Index m = system.dimensions.input;
  detail::prepareDesign(c, detail::sizesOf(system), m);
  const std::size_t steps = c.desiredInput.size() - 1;
  if (c.stepsPerSample < 1 || c.stepsPerSample > steps)
    throw std::domain_error(
        fmt::format("steps per sample: {}, must be 1 … {}", c.stepsPerSample, steps));
  for (StepWaypoint& waypoint : c.waypoints) {
    if (waypoint.step < 1 || waypoint.step > steps)
      throw std::invalid_argument(
          fmt::format("waypoint at step {}, must be 1 … {}", waypoint.step, steps));
    requireLength("waypoint's state", waypoint.state.size(), system.dimensions.state);
    detail::fillWeight("waypoint's weight", waypoint.weight, system.dimensions.state, false);
    if (!waypoint.state.allFinite())
      throw std::domain_error(
          fmt::format("waypoint at step {}: the state is not finite", waypoint.step));
  }
  detail::fillWeight("rate weight V", c.rateWeight, m, false);
  detail::fillWeight("model's rate weight", c.modelRate, m, false);
  // u_0 is given: no search can bring it within
  for (Index i = 0; i < c.limits.lower.size(); ++i)
    if (!(c.desiredInput[0][i] >= c.limits.lower[i] && c.desiredInput[0][i] <= c.limits.upper[i]))
      throw std::domain_error(fmt::format("limits of input {}: {} at time 0, must be {} … {}", i,
                                          c.desiredInput[0][i], c.limits.lower[i],
                                          c.limits.upper[i]));
  return c;
}

}  // namespace

StepProjection::StepProjection(ExtendedStepMap system, StepDesign design,
                               const std::vector<VectorXd>& start)
    : ProjectedMotion(
          system.output, system.candidates, prepared(design, system),
          detail::inverseCovariance(design.outputCovariance, detail::sizesOf(system).h)),
      system_(std::move(system)),
      design_(std::move(design)) {
  const StepDesign& c = design_;
  if (!start.empty())
    detail::checkInputs("start", start, c.desiredInput.size(), system_.dimensions.input);
  const auto run = [&](const std::vector<VectorXd>& inputs, const char* what) {
    Motion motion{
        {c.x0}, inputs, {MatrixXd::Zero(system_.dimensions.state, system_.dimensions.parameter)}};
    for (std::size_t k = 0; k + 1 < inputs.size(); ++k) {
      auto next = system_.step(motion.x[k], motion.psi[k], inputs[k], inputs[k + 1]);
      if (!next.converged || !next.x.allFinite() || !next.psi.allFinite())
        throw std::domain_error(fmt::format("{}: no solution of the step from {} s", what,
                                            c.timeStep * static_cast<double>(k)));
      motion.x.push_back(std::move(next.x));
      motion.psi.push_back(std::move(next.psi));
    }
    return motion;
  };
  Motion desired = run(c.desiredInput, "desired motion");
  desiredState_ = desired.x;
  begin(start.empty() ? std::move(desired) : run(start, "start"));
}

double StepProjection::share(std::size_t k) const {
  return k > 0 && k % design_.stepsPerSample == 0 ? 1 : 0;
}

double StepProjection::tracking(const Motion& motion) const {
  const StepDesign& c = design_;
  double sum = 0;
  for (std::size_t k = 1; k <= steps(); ++k) {
    const VectorXd dx = motion.x[k] - desiredState_[k], du = motion.u[k] - c.desiredInput[k];
    const VectorXd rate = (du - (motion.u[k - 1] - c.desiredInput[k - 1])) / c.timeStep;
    sum += 0.5 * (dx.dot(c.stateWeight * dx) + du.dot(c.inputWeight * du) +
                  rate.dot(c.rateWeight * rate));
    sum += limitCost(c.limits, motion.u[k]);
  }
  for (const StepWaypoint& waypoint : c.waypoints) {
    const VectorXd off = motion.x[waypoint.step] - waypoint.state;
    sum += 0.5 * off.dot(waypoint.weight * off);
  }
  return sum;
}

StepProjection::Direction StepProjection::findDirection(double repeatedTolerance) {
  const Dimensions d = system_.dimensions;
  const StepDesign& c = design_;
  const Index n = d.state, m = d.input, p = d.parameter, N = n + m + n * p;
  const std::vector<MatrixXd> slopes = informationSlopes(repeatedTolerance);
  const double h = c.timeStep;

  // the extended system s = (x, u_k, vec ψ), w = u_{k+1}, about the motion; and its LQR on (x, u_k)
  LinearSequence whole, plant;
  LinearCost slope;
  whole.A.reserve(steps());
  slope.a.assign(steps() + 1, VectorXd::Zero(N));
  slope.b.assign(steps(), VectorXd::Zero(m));
  for (std::size_t k = 0; k < steps(); ++k) {
    const auto at =
        system_.derivatives(motion_.x[k], motion_.psi[k], motion_.u[k], motion_.u[k + 1]);
    MatrixXd A = MatrixXd::Zero(N, N), B = MatrixXd::Zero(N, m);
    A.topLeftCorner(n, n + m) = at.x.leftCols(n + m);
    A.bottomLeftCorner(n * p, n + m) = at.psi.leftCols(n + m);
    for (Index j = 0; j < p; ++j) A.block(n + m + j * n, n + m + j * n, n, n) = at.x.leftCols(n);
    B.topRows(n) = at.x.rightCols(m);
    B.middleRows(n, m).setIdentity();
    B.bottomRows(n * p) = at.psi.rightCols(m);
    plant.A.push_back(A.topLeftCorner(n + m, n + m));
    plant.B.push_back(B.topRows(n + m));
    whole.A.push_back(std::move(A));
    whole.B.push_back(std::move(B));
  }
  for (std::size_t k = 1; k <= steps(); ++k) {
    VectorXd& a = slope.a[k];
    VectorXd& b = slope.b[k - 1];
    const VectorXd du = motion_.u[k] - c.desiredInput[k];
    a.head(n) = c.stateWeight * (motion_.x[k] - desiredState_[k]);
    b = c.inputWeight * du;
    const VectorXd rate =
        c.rateWeight * (du - (motion_.u[k - 1] - c.desiredInput[k - 1])) / (h * h);
    b += rate;
    slope.a[k - 1].segment(n, m) -= rate;
    b += limitSlope(c.limits, motion_.u[k]);
    if (share(k) == 0) continue;
    const auto g = outputSlope(k, slopes);
    a.head(n) += g.x;
    a.segment(n, m) += g.u;
    a.tail(n * p) += g.psi.reshaped();
  }
  for (const StepWaypoint& waypoint : c.waypoints)
    slope.a[waypoint.step].head(n) += waypoint.weight * (motion_.x[waypoint.step] - waypoint.state);
  gains_ = lqrGains(plant, {c.gainState, c.gainInput, {}, {}});

  // rate² = |w − u_k|²/Δt² couples w and the state u_k
  QuadraticWeights model{c.modelState, c.modelInput + c.modelRate / (h * h), MatrixXd::Zero(m, N),
                         c.modelState};
  for (const StepWaypoint& waypoint : c.waypoints) {
    model.extra.push_back({waypoint.step, MatrixXd::Zero(N, N)});
    model.extra.back().Q.topLeftCorner(n, n) = waypoint.weight;
  }
  model.Q.block(n, n, m, m) += c.modelRate / (h * h);
  model.S.middleCols(n, m) = -c.modelRate / (h * h);
  return follow(affineLq(whole, slope, model));
}

bool StepProjection::project(double step, Motion& motion) const {
  const Index n = system_.dimensions.state, m = system_.dimensions.input;
  motion.x.resize(steps() + 1);
  motion.u.resize(steps() + 1);
  motion.psi.resize(steps() + 1);
  motion.x[0] = motion_.x[0];
  motion.u[0] = motion_.u[0];
  motion.psi[0] = motion_.psi[0];
  VectorXd error(n + m);
  for (std::size_t k = 0; k < steps(); ++k) {
    error.head(n) = motion.x[k] - motion_.x[k] - step * z_[k].head(n);
    error.tail(m) = motion.u[k] - motion_.u[k] - step * z_[k].segment(n, m);
    motion.u[k + 1] = motion_.u[k + 1] + step * v_[k] - gains_[k] * error;
    auto next = system_.step(motion.x[k], motion.psi[k], motion.u[k], motion.u[k + 1]);
    if (!next.converged || !next.x.allFinite() || !next.psi.allFinite()) return false;
    motion.x[k + 1] = std::move(next.x);
    motion.psi[k + 1] = std::move(next.psi);
  }
  return true;
}

}  // namespace info
