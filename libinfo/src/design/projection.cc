#include "info/design/projection.h"

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
FlowDesign& prepared(FlowDesign& c, const ExtendedFlow& system) {
  if (!(c.step > 0 && std::isfinite(c.step)))
    throw std::domain_error(fmt::format("time step: {} s, must be > 0 and finite", c.step));
  detail::prepareDesign(c, detail::sizesOf(system), 0);
  return c;
}

}  // namespace

FlowProjection::FlowProjection(ExtendedFlow system, FlowDesign design,
                               const std::vector<VectorXd>& start)
    : ProjectedMotion(system.output, system.candidates, prepared(design, system),
                      detail::inverseCovariance(design.outputDensity, detail::sizesOf(system).h)),
      system_(std::move(system)),
      design_(std::move(design)) {
  if (!start.empty())
    detail::checkInputs("start", start, design_.desiredInput.size(), system_.dimensions.input);
  const auto open = [&](const std::vector<VectorXd>& inputs, const char* what) {
    Motion motion;
    if (!run({}, inputs, {}, motion))
      throw std::domain_error(fmt::format("{}: the motion does not stay finite", what));
    return motion;
  };
  Motion desired = open(design_.desiredInput, "desired motion");
  desiredState_ = desired.x;
  begin(start.empty() ? std::move(desired) : open(start, "start"));
}

double FlowProjection::share(std::size_t k) const {
  return k == 0 || k == steps() ? 0.5 * design_.step : design_.step;
}

bool FlowProjection::run(const std::vector<VectorXd>& alpha, const std::vector<VectorXd>& beta,
                         const std::vector<MatrixXd>& gains, Motion& motion) const {
  const double h = design_.step;
  motion.x.assign(1, design_.x0);
  motion.psi.assign(1, MatrixXd::Zero(system_.dimensions.state, system_.dimensions.parameter));
  motion.u.clear();
  const bool open = gains.empty();
  const auto input = [&](std::size_t k, const VectorXd& x) {
    return open ? beta[k] : VectorXd(beta[k] - gains[k] * (x - alpha[k]));
  };
  for (std::size_t k = 0;; ++k) {
    const VectorXd& x = motion.x[k];
    const MatrixXd& psi = motion.psi[k];
    if (!x.allFinite() || !psi.allFinite()) return false;
    motion.u.push_back(input(k, x));
    if (k == steps()) return true;
    const VectorXd betaMid = 0.5 * (beta[k] + beta[k + 1]);
    const VectorXd alphaMid = open ? VectorXd() : VectorXd(0.5 * (alpha[k] + alpha[k + 1]));
    const MatrixXd gainMid = open ? MatrixXd() : MatrixXd(0.5 * (gains[k] + gains[k + 1]));
    const auto middle = [&](const VectorXd& at) {
      return open ? betaMid : VectorXd(betaMid - gainMid * (at - alphaMid));
    };
    const auto k1 = system_.rate(x, psi, motion.u[k]);
    const VectorXd x2 = x + 0.5 * h * k1.x;
    const auto k2 = system_.rate(x2, psi + 0.5 * h * k1.psi, middle(x2));
    const VectorXd x3 = x + 0.5 * h * k2.x;
    const auto k3 = system_.rate(x3, psi + 0.5 * h * k2.psi, middle(x3));
    const VectorXd x4 = x + h * k3.x;
    const auto k4 = system_.rate(x4, psi + h * k3.psi, input(k + 1, x4));
    VectorXd x1 = x + h / 6 * (k1.x + 2 * k2.x + 2 * k3.x + k4.x);
    MatrixXd psi1 = psi + h / 6 * (k1.psi + 2 * k2.psi + 2 * k3.psi + k4.psi);
    motion.x.push_back(std::move(x1));
    motion.psi.push_back(std::move(psi1));
  }
}

double FlowProjection::tracking(const Motion& motion) const {
  const FlowDesign& c = design_;
  double sum = 0;
  for (std::size_t k = 0; k <= steps(); ++k) {
    const VectorXd dx = motion.x[k] - desiredState_[k], du = motion.u[k] - c.desiredInput[k];
    const double rate = 0.5 * (dx.dot(c.stateWeight * dx) + du.dot(c.inputWeight * du)) +
                        limitCost(c.limits, motion.u[k]);
    sum += share(k) * rate;
  }
  return sum;
}

FlowProjection::Direction FlowProjection::findDirection(double repeatedTolerance) {
  const Dimensions d = system_.dimensions;
  const FlowDesign& c = design_;
  const Index n = d.state, m = d.input, p = d.parameter, N = n + n * p;
  const std::vector<MatrixXd> slopes = informationSlopes(repeatedTolerance);

  LinearSequence whole, plant;
  LinearCost slope;
  for (std::size_t k = 0; k <= steps(); ++k) {
    const VectorXd &x = motion_.x[k], &u = motion_.u[k];
    const MatrixXd& psi = motion_.psi[k];
    // the extended system (x, vec ψ) about the motion; its x part is for the projection's LQR
    const auto at = system_.derivatives(x, psi, u);
    MatrixXd A = MatrixXd::Zero(N, N), B(N, m);
    A.topLeftCorner(n, n) = at.x.leftCols(n);
    A.bottomLeftCorner(n * p, n) = at.psi.leftCols(n);
    for (Index j = 0; j < p; ++j) A.block(n + j * n, n + j * n, n, n) = at.x.leftCols(n);
    B << at.x.rightCols(m), at.psi.rightCols(m);
    plant.A.push_back(at.x.leftCols(n));
    plant.B.push_back(at.x.rightCols(m));
    whole.A.push_back(std::move(A));
    whole.B.push_back(std::move(B));
    // a and b: tracking, limits and information
    const auto g = outputSlope(k, slopes);
    VectorXd a(N);
    a << c.stateWeight * (x - desiredState_[k]) + g.x, g.psi.reshaped();
    VectorXd b = c.inputWeight * (u - c.desiredInput[k]) + g.u + limitSlope(c.limits, u);
    slope.a.push_back(std::move(a));
    slope.b.push_back(std::move(b));
  }
  gains_ = continuousLqrGains(plant, c.step, {c.gainState, c.gainInput, {}, {}}, c.riccati);
  return follow(
      continuousAffineLq(whole, c.step, slope, {c.modelState, c.modelInput, {}, {}}, c.riccati));
}

bool FlowProjection::project(double step, Motion& motion) const {
  const Index n = system_.dimensions.state;
  std::vector<VectorXd> alpha, beta;
  for (std::size_t k = 0; k <= steps(); ++k) {
    alpha.push_back(motion_.x[k] + step * z_[k].head(n));
    beta.push_back(motion_.u[k] + step * v_[k]);
  }
  return run(alpha, beta, gains_, motion);
}

}  // namespace info
