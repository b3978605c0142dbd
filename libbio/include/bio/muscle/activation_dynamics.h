#pragma once

#include <array>
#include <span>
#include <string_view>
#include <variant>

#include "bio/muscle/activation/activation.h"
#include "bio/muscle/activation_variant.h"

namespace bio {

/// The activation dynamics of a muscle of any class: how activation a follows excitation u, both
/// 0…1 and dimensionless. Functions as those of the law that it holds.
class ActivationDynamics {
 public:
  explicit ActivationDynamics(const SchutteActivation<double>& law) : law_(law) {}
  explicit ActivationDynamics(const muscles::AnyActivation& law);

  /// Null for other laws.
  const SchutteActivation<double>* schutte() const {
    return std::get_if<SchutteActivation<double>>(&law_);
  }
  /// Whether activation is the excitation, so that it has no state.
  bool isDirect() const { return std::holds_alternative<muscles::DirectActivation>(law_); }

  /// Activation at the start of a motion: the excitation, within the law's limits.
  struct Start {
    double value;
    double byExcitation;               ///< ∂a/∂u
    std::array<double, 3> byNumber{};  ///< in the law's own numbers
  };
  Start start(double u) const;

  /// The activation that acts: a, or the excitation within limits if the law is direct.
  double acting(double u, double a) const {
    const auto* direct = std::get_if<muscles::DirectActivation>(&law_);
    return direct ? direct->held(u) : a;
  }
  double rate(double u, double a) const;       ///< ȧ [1/s]
  double rateSlope(double u, double a) const;  ///< ∂ȧ/∂a at fixed u [1/s]

  /// a after a step of h [s] in which the excitation goes straight from u0 to u1.
  double step(double u0, double u1, double a0, double h) const {
    if (const auto* law = schutte()) return stepActivation(*law, u0, u1, a0, h);
    return otherStep(u0, u1, a0, h);
  }
  /// With derivatives in u₀, u₁, a₀, h and the law's own numbers.
  ActivationStep stepWithDerivatives(double u0, double u1, double a0, double h) const;

  /// Names of the own numbers, as the catalogue of parameters has them.
  std::span<const std::string_view> names() const;

  /// Mean time by which activation is late [s] about a = u: two over the sum of the rates of rising
  /// and of falling.
  double lag(double u) const;

 private:
  double otherStep(double u0, double u1, double a0, double h) const;

  std::variant<SchutteActivation<double>, muscles::FirstOrderActivation<double>,
               muscles::SmoothActivation<double>, muscles::DirectActivation>
      law_;
};

}  // namespace bio
