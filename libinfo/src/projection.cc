#include "info/projection.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "info/riccati.h"
#include "projection_checks.h"

namespace info {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

FlowProjection::FlowProjection(ExtendedFlow system, FlowDesign design,
                               const std::vector<VectorXd>& start)
    : system_(std::move(system)), design_(std::move(design)) {
  const Dimensions d = system_.dimensions;
  FlowDesign& c = design_;
  if (!(c.step > 0 && std::isfinite(c.step)))
    throw std::domain_error(fmt::format("time step: {} s, rule: > 0 and finite", c.step));
  if (c.desiredInput.size() < 2)
    throw std::invalid_argument(
        fmt::format("desired inputs: {} of them, rule: ≥ 2", c.desiredInput.size()));
  requireLength("x0", c.x0.size(), d.state);
  detail::checkInputs("desired inputs", c.desiredInput, c.desiredInput.size(), d.input);
  if (!start.empty()) detail::checkInputs("start", start, c.desiredInput.size(), d.input);
  inverseDensity_ = detail::inverseCovariance(c.outputDensity, d.output);
  detail::checkLimits(c.limits, d.input);
  const int n = d.state, m = d.input;
  detail::fillWeight("state weight Q", c.stateWeight, n, false);
  detail::fillWeight("input weight R", c.inputWeight, m, false);
  detail::fillWeight("model's state weight", c.modelState, n + n * d.parameter, false);
  detail::fillWeight("model's input weight", c.modelInput, m, true);
  detail::fillWeight("gain's state weight", c.gainState, n, false);
  detail::fillWeight("gain's input weight", c.gainInput, m, true);

  const auto open = [&](const std::vector<VectorXd>& inputs, const char* what) {
    FlowMotion motion;
    if (!run({}, inputs, {}, motion))
      throw std::domain_error(fmt::format("{}: the motion does not stay finite", what));
    return motion;
  };
  motion_ = open(c.desiredInput, "desired motion");
  desiredState_ = motion_.x;
  if (!start.empty()) motion_ = open(start, "start");
  Evaluated at = evaluate(motion_);
  cost_ = at.cost;
  information_ = std::move(at.information);
}

bool FlowProjection::run(const std::vector<VectorXd>& alpha, const std::vector<VectorXd>& beta,
                         const std::vector<MatrixXd>& gains, FlowMotion& motion) const {
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

double FlowProjection::tracking(const FlowMotion& motion) const {
  const FlowDesign& c = design_;
  double sum = 0;
  for (std::size_t k = 0; k <= steps(); ++k) {
    const VectorXd dx = motion.x[k] - desiredState_[k], du = motion.u[k] - c.desiredInput[k];
    double rate = 0.5 * (dx.dot(c.stateWeight * dx) + du.dot(c.inputWeight * du));
    for (Index i = 0; i < c.limits.lower.size(); ++i)
      rate +=
          inputBarrier(motion.u[k][i], c.limits.lower[i], c.limits.upper[i], c.limits.weight).value;
    sum += share(k) * rate;
  }
  return sum;
}

double FlowProjection::trackingCost() const {
  return tracking(motion_);
}

FlowProjection::Evaluated FlowProjection::evaluate(const FlowMotion& motion) const {
  const Index p = system_.dimensions.parameter;
  MatrixXd information = MatrixXd::Zero(p, p);
  for (std::size_t k = 0; k <= steps(); ++k) {
    const MatrixXd gamma = system_.output.gamma(motion.x[k], motion.psi[k], motion.u[k]);
    information += share(k) * gamma.transpose() * (inverseDensity_ * gamma);
  }
  information = (0.5 * (information + information.transpose())).eval();
  const double phi = informationCost(design_.information, information, 1e-9).value;
  return {tracking(motion) + phi, std::move(information)};
}

FlowProjection::Direction FlowProjection::findDirection(double repeatedTolerance) {
  const Dimensions d = system_.dimensions;
  const FlowDesign& c = design_;
  const Index n = d.state, m = d.input, p = d.parameter, N = n + n * p;
  const InformationCost phi = informationCost(c.information, information_, repeatedTolerance);

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
    // a and b: tracking, limits, and dφ = 2⟨Σ⁻¹ Γ dφ/dI, dΓ⟩
    const MatrixXd gamma = system_.output.gamma(x, psi, u);
    const auto g = system_.output.gradient(x, psi, u, 2 * inverseDensity_ * gamma * phi.dvalue_dI);
    VectorXd a(N), b = c.inputWeight * (u - c.desiredInput[k]) + g.u;
    a << c.stateWeight * (x - desiredState_[k]) + g.x, g.psi.reshaped();
    for (Index i = 0; i < c.limits.lower.size(); ++i)
      b[i] += inputBarrier(u[i], c.limits.lower[i], c.limits.upper[i], c.limits.weight).slope;
    slope.a.push_back(std::move(a));
    slope.b.push_back(std::move(b));
  }
  gains_ = continuousLqrGains(plant, c.step, {c.gainState, c.gainInput, {}, {}});
  AffineLqSolution zeta =
      continuousAffineLq(whole, c.step, slope, {c.modelState, c.modelInput, {}, {}});
  z_ = std::move(zeta.z);
  v_ = std::move(zeta.v);
  Direction out{zeta.slope, 0};
  for (const VectorXd& v : v_) out.largestMove = std::max(out.largestMove, v.cwiseAbs().maxCoeff());
  return out;
}

double FlowProjection::trial(double step) {
  const Index n = system_.dimensions.state;
  std::vector<VectorXd> alpha, beta;
  for (std::size_t k = 0; k <= steps(); ++k) {
    alpha.push_back(motion_.x[k] + step * z_[k].head(n));
    beta.push_back(motion_.u[k] + step * v_[k]);
  }
  constexpr double none = std::numeric_limits<double>::infinity();
  if (!run(alpha, beta, gains_, tried_)) return none;
  try {
    Evaluated at = evaluate(tried_);
    triedCost_ = at.cost;
    triedInformation_ = std::move(at.information);
  } catch (const NoInformation&) {
    return none;
  }
  return triedCost_;
}

void FlowProjection::accept() {
  std::swap(motion_, tried_);
  cost_ = triedCost_;
  information_ = triedInformation_;
}

}  // namespace info
