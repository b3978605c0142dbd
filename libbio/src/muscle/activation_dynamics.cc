#include "bio/muscle/activation_dynamics.h"

#include <algorithm>

#include "info/autodiff/dual.h"

namespace bio {
namespace {

constexpr std::array<std::string_view, 3> schutteNames{"time_scale", "activation1", "activation2"};

/// ∂ȧ/∂a through a dual number.
template <template <class> class Law>
double slopeOfRate(const Law<double>& law, double u, double a) {
  using Number = info::Dual<1>;
  const auto& [first, second, third] = law;
  const Law<Number> inDual{Number(first), Number(second), Number(third)};
  return inDual.rate(Number(u), Number(a, 1, 0)).derivatives()[0];
}

// Schutte's law has functions of its own, the others have members.
double lawRate(const SchutteActivation<double>& law, double u, double a) {
  return activationRate(law, u, a);
}
template <class Law>
double lawRate(const Law& law, double u, double a) {
  return law.rate(u, a);
}
double lawStep(const SchutteActivation<double>& law, double u0, double u1, double a0, double h) {
  return stepActivation(law, u0, u1, a0, h);
}
template <class Law>
double lawStep(const Law& law, double u0, double u1, double a0, double h) {
  return law.step(u0, u1, a0, h);
}
ActivationStep lawStepWithDerivatives(const SchutteActivation<double>& law, double u0, double u1,
                                      double a0, double h) {
  return stepActivationWithDerivatives(law, u0, u1, a0, h);
}
template <class Law>
ActivationStep lawStepWithDerivatives(const Law& law, double u0, double u1, double a0, double h) {
  const auto step = law.stepWithDerivatives(u0, u1, a0, h);
  ActivationStep result{step.value, decltype(ActivationStep::d)::Zero()};
  for (std::size_t i = 0; i < step.d.size(); ++i) {
    result.d[static_cast<Eigen::Index>(i)] = step.d[i];
  }
  return result;
}
std::span<const std::string_view> lawNames(const SchutteActivation<double>&) {
  return schutteNames;
}
template <class Law>
std::span<const std::string_view> lawNames(const Law&) {
  return Law::names;
}

}  // namespace

ActivationDynamics::ActivationDynamics(const muscles::AnyActivation& law)
    : law_(std::visit([](const auto& one) -> decltype(law_) { return one; }, law)) {}

ActivationDynamics::Start ActivationDynamics::start(double u) const {
  if (const auto* direct = std::get_if<muscles::DirectActivation>(&law_)) {
    const double held = direct->held(u);
    return {held, held == u ? 1.0 : 0.0};
  }
  if (const auto* law = std::get_if<muscles::FirstOrderActivation<double>>(&law_)) {
    if (u < law->minimum) return {law->minimum, 0, {0, 0, 1}};
    if (u > 1) return {1, 0};
  }
  return {u, 1};
}

double ActivationDynamics::rate(double u, double a) const {
  return std::visit([&](const auto& law) { return lawRate(law, u, a); }, law_);
}

double ActivationDynamics::rateSlope(double u, double a) const {
  struct Slope {
    double u, a;
    double operator()(const SchutteActivation<double>& law) const {
      return -law.rateConstant(u, u >= a);
    }
    double operator()(const muscles::FirstOrderActivation<double>& law) const {
      return slopeOfRate(law, u, a);
    }
    double operator()(const muscles::SmoothActivation<double>& law) const {
      return slopeOfRate(law, u, a);
    }
    double operator()(const muscles::DirectActivation&) const { return 0; }
  };
  return std::visit(Slope{u, a}, law_);
}

double ActivationDynamics::otherStep(double u0, double u1, double a0, double h) const {
  return std::visit([&](const auto& law) { return lawStep(law, u0, u1, a0, h); }, law_);
}

ActivationStep ActivationDynamics::stepWithDerivatives(double u0, double u1, double a0,
                                                       double h) const {
  return std::visit([&](const auto& law) { return lawStepWithDerivatives(law, u0, u1, a0, h); },
                    law_);
}

std::span<const std::string_view> ActivationDynamics::names() const {
  return std::visit([](const auto& law) { return lawNames(law); }, law_);
}

double ActivationDynamics::lag(double u) const {
  if (const auto* law = schutte()) {
    return 2 / (law->rateConstant(u, true) + law->rateConstant(u, false));
  }
  if (isDirect()) return 0;
  // what a small step up and a small step down of the excitation do
  constexpr double small = 1e-6;
  const double a = start(u).value;
  const double rises = rate(a + small, a) / small, falls = rate(a, a + small) / -small;
  return rises + falls > 0 ? 2 / (rises + falls) : 0;
}

}  // namespace bio
