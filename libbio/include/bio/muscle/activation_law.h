#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string_view>

namespace bio::muscles {

/// Activation at the end of a step with its derivatives in u₀, u₁, a₀ and h, then in the law's own
/// numbers.
template <std::size_t own>
struct ActivationStep {
  double value = 0;
  std::array<double, 4 + own> d{};
};

/// How activation a follows excitation u, both 0…1 and dimensionless.
///
///     rate(u, a)               ȧ [1/s]
///     step(u₀, u₁, a₀, h)      a after a step of h [s] in which u goes straight from u₀ to u₁
///     stepWithDerivatives(…)   the same with exact derivatives of that step
///     names                    OpenSim's names of the law's own numbers, in their order
template <class Law>
concept ActivationLaw = requires(const Law& law, double x) {
  { Law::names.size() } -> std::convertible_to<std::size_t>;
  { law.rate(x, x) } -> std::same_as<double>;
  { law.step(x, x, x, x) } -> std::same_as<double>;
  { law.stepWithDerivatives(x, x, x, x).value } -> std::convertible_to<double>;
};

/// Activation is the excitation (ignore_activation_dynamics), held within the class's limits.
struct DirectActivation {
  double least = 0;  ///< Millard's minimum_activation; De Groote's class has no limits
  double most = 1;
  static constexpr std::array<std::string_view, 0> names{};

  double held(double u) const { return u < least ? least : u > most ? most : u; }
  double rate(double, double) const { return 0; }
  double step(double, double u1, double, double) const { return held(u1); }
  ActivationStep<0> stepWithDerivatives(double, double u1, double, double) const {
    ActivationStep<0> s;
    s.value = held(u1);
    s.d[1] = s.value == u1 ? 1 : 0;
    return s;
  }
};
static_assert(ActivationLaw<DirectActivation>);

}  // namespace bio::muscles
