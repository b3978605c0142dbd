#include "info/discrete_projection.h"

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

StepProjection::StepProjection(ExtendedStepMap system, StepDesign design,
                               const std::vector<VectorXd>& start)
    : system_(std::move(system)), design_(std::move(design)) {
  const Dimensions d = system_.dimensions;
  StepDesign& c = design_;
  if (!(c.timeStep > 0 && std::isfinite(c.timeStep)))
    throw std::domain_error(fmt::format("time step: {} s, rule: > 0 and finite", c.timeStep));
  if (c.stepsPerSample < 1) throw std::domain_error("steps per sample: 0, rule: ≥ 1");
  if (c.desiredInput.size() < 2)
    throw std::invalid_argument(
        fmt::format("desired inputs: {} of them, rule: ≥ 2", c.desiredInput.size()));
  requireLength("x0", c.x0.size(), d.state);
  detail::checkInputs("desired inputs", c.desiredInput, c.desiredInput.size(), d.input);
  if (!start.empty()) detail::checkInputs("start", start, c.desiredInput.size(), d.input);
  inverseCovariance_ = detail::inverseCovariance(c.outputCovariance, d.output);
  detail::checkLimits(c.limits, d.input);
  const int n = d.state, m = d.input;
  detail::fillWeight("state weight Q", c.stateWeight, n, false);
  detail::fillWeight("input weight R", c.inputWeight, m, false);
  detail::fillWeight("rate weight V", c.rateWeight, m, false);
  detail::fillWeight("model's rate weight", c.modelRate, m, false);
  detail::fillWeight("model's state weight", c.modelState, n + m + n * d.parameter, false);
  detail::fillWeight("model's input weight", c.modelInput, m, true);
  detail::fillWeight("gain's state weight", c.gainState, n + m, false);
  detail::fillWeight("gain's input weight", c.gainInput, m, true);

  const auto run = [&](const std::vector<VectorXd>& inputs, const char* what) {
    StepMotion motion{{c.x0}, inputs, {MatrixXd::Zero(n, d.parameter)}};
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
  motion_ = run(c.desiredInput, "desired motion");
  desiredState_ = motion_.x;
  if (!start.empty()) motion_ = run(start, "start");
  Evaluated at = evaluate(motion_);
  cost_ = at.cost;
  information_ = std::move(at.information);
}

double StepProjection::tracking(const StepMotion& motion) const {
  const StepDesign& c = design_;
  double sum = 0;
  for (std::size_t k = 1; k <= steps(); ++k) {
    const VectorXd dx = motion.x[k] - desiredState_[k], du = motion.u[k] - c.desiredInput[k];
    const VectorXd rate = (du - (motion.u[k - 1] - c.desiredInput[k - 1])) / c.timeStep;
    sum += 0.5 * (dx.dot(c.stateWeight * dx) + du.dot(c.inputWeight * du) +
                  rate.dot(c.rateWeight * rate));
    for (Index i = 0; i < c.limits.lower.size(); ++i)
      sum +=
          inputBarrier(motion.u[k][i], c.limits.lower[i], c.limits.upper[i], c.limits.weight).value;
  }
  return sum;
}

double StepProjection::trackingCost() const {
  return tracking(motion_);
}

StepProjection::Evaluated StepProjection::evaluate(const StepMotion& motion) const {
  const Index p = system_.dimensions.parameter;
  MatrixXd information = MatrixXd::Zero(p, p);
  for (std::size_t k = 1; k <= steps(); ++k) {
    if (!measured(k)) continue;
    const MatrixXd gamma = system_.output.gamma(motion.x[k], motion.psi[k], motion.u[k]);
    information.noalias() += gamma.transpose() * (inverseCovariance_ * gamma);
  }
  information = (0.5 * (information + information.transpose())).eval();
  const double phi = informationCost(design_.information, information, 1e-9).value;
  return {tracking(motion) + phi, std::move(information)};
}

StepProjection::Direction StepProjection::findDirection(double repeatedTolerance) {
  const Dimensions d = system_.dimensions;
  const StepDesign& c = design_;
  const Index n = d.state, m = d.input, p = d.parameter, N = n + m + n * p;
  const InformationCost phi = informationCost(c.information, information_, repeatedTolerance);
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
    b += limitSlope(motion_.u[k]);
    if (!measured(k)) continue;
    // dφ = 2⟨Σ⁻¹ Γ dφ/dI, dΓ⟩
    const MatrixXd gamma = system_.output.gamma(motion_.x[k], motion_.psi[k], motion_.u[k]);
    const auto g = system_.output.gradient(motion_.x[k], motion_.psi[k], motion_.u[k],
                                           2 * inverseCovariance_ * gamma * phi.dvalue_dI);
    a.head(n) += g.x;
    a.segment(n, m) += g.u;
    a.tail(n * p) += g.psi.reshaped();
  }
  gains_ = lqrGains(plant, {c.gainState, c.gainInput, {}, {}});

  // rate² = |w − u_k|²/Δt² couples w and the state u_k
  QuadraticWeights model{c.modelState, c.modelInput + c.modelRate / (h * h), MatrixXd::Zero(m, N),
                         c.modelState};
  model.Q.block(n, n, m, m) += c.modelRate / (h * h);
  model.S.middleCols(n, m) = -c.modelRate / (h * h);
  AffineLqSolution zeta = affineLq(whole, slope, model);
  z_ = std::move(zeta.z);
  v_ = std::move(zeta.v);
  Direction out{zeta.slope, 0};
  for (const VectorXd& v : v_) out.largestMove = std::max(out.largestMove, v.cwiseAbs().maxCoeff());
  return out;
}

VectorXd StepProjection::limitSlope(const VectorXd& u) const {
  const InputLimits& limits = design_.limits;
  VectorXd slope = VectorXd::Zero(u.size());
  for (Index i = 0; i < limits.lower.size(); ++i)
    slope[i] = inputBarrier(u[i], limits.lower[i], limits.upper[i], limits.weight).slope;
  return slope;
}

double StepProjection::trial(double step) {
  const Index n = system_.dimensions.state, m = system_.dimensions.input;
  constexpr double none = std::numeric_limits<double>::infinity();
  tried_.x.resize(steps() + 1);
  tried_.u.resize(steps() + 1);
  tried_.psi.resize(steps() + 1);
  tried_.x[0] = motion_.x[0];
  tried_.u[0] = motion_.u[0];
  tried_.psi[0] = motion_.psi[0];
  VectorXd error(n + m);
  for (std::size_t k = 0; k < steps(); ++k) {
    error.head(n) = tried_.x[k] - motion_.x[k] - step * z_[k].head(n);
    error.tail(m) = tried_.u[k] - motion_.u[k] - step * z_[k].segment(n, m);
    tried_.u[k + 1] = motion_.u[k + 1] + step * v_[k] - gains_[k] * error;
    auto next = system_.step(tried_.x[k], tried_.psi[k], tried_.u[k], tried_.u[k + 1]);
    if (!next.converged || !next.x.allFinite() || !next.psi.allFinite()) return none;
    tried_.x[k + 1] = std::move(next.x);
    tried_.psi[k + 1] = std::move(next.psi);
  }
  try {
    Evaluated at = evaluate(tried_);
    triedCost_ = at.cost;
    triedInformation_ = std::move(at.information);
  } catch (const NoInformation&) {
    return none;
  }
  return triedCost_;
}

void StepProjection::accept() {
  std::swap(motion_, tried_);
  cost_ = triedCost_;
  information_ = triedInformation_;
}

}  // namespace info
