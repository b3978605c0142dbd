#include "bio/muscle/activation_dynamics.h"

#include <algorithm>
#include <type_traits>

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
  return std::visit(
      [&](const auto& law) -> double {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(law)>,
                                     SchutteActivation<double>>) {
          return activationRate(law, u, a);
        } else {
          return law.rate(u, a);
        }
      },
      law_);
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
  return std::visit(
      [&](const auto& law) -> double {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(law)>,
                                     SchutteActivation<double>>) {
          return stepActivation(law, u0, u1, a0, h);
        } else {
          return law.step(u0, u1, a0, h);
        }
      },
      law_);
}

ActivationStep ActivationDynamics::stepWithDerivatives(double u0, double u1, double a0,
                                                       double h) const {
  return std::visit(
      [&](const auto& law) -> ActivationStep {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(law)>,
                                     SchutteActivation<double>>) {
          return stepActivationWithDerivatives(law, u0, u1, a0, h);
        } else {
          const auto step = law.stepWithDerivatives(u0, u1, a0, h);
          ActivationStep result{step.value, decltype(ActivationStep::d)::Zero()};
          for (std::size_t i = 0; i < step.d.size(); ++i) {
            result.d[static_cast<Eigen::Index>(i)] = step.d[i];
          }
          return result;
        }
      },
      law_);
}

std::span<const std::string_view> ActivationDynamics::names() const {
  return std::visit(
      [](const auto& law) -> std::span<const std::string_view> {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(law)>,
                                     SchutteActivation<double>>) {
          return schutteNames;
        } else {
          return std::remove_cvref_t<decltype(law)>::names;
        }
      },
      law_);
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
