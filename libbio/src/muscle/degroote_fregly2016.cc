#include "bio/muscle/degroote_fregly2016.h"

#include <algorithm>

namespace bio::muscles {
namespace {

// Places among the class's own numbers.
struct DeGrooteOwn {
  static constexpr std::size_t damping = 0, activeWidth = 1, passiveStrain = 2, tendonStrain = 3;
};
static_assert(DeGrooteFregly2016<double>::dampingPlace == common::count + DeGrooteOwn::damping);

}  // namespace

double degroote::dampedPlace(double P, double A, double B) {
  // At v = 0 f_v is 1. From there the damper alone and the contractile element alone each bound
  // how far v can go.
  const double rest = std::asinh(d3);
  const double byDamper = std::asinh(d2 * (P - A) / B + d3);
  const double byElement = (P / A - d4) / d1;
  const bool lengthens = P >= A;
  double low = lengthens ? std::fmax(byDamper, byElement) : rest;
  double high = lengthens ? rest : std::fmin(byDamper, byElement);
  double y = lengthens ? low : high;
  for (int k = 0; k < 100; ++k) {
    const double excess = A * (d1 * y + d4) + B * (std::sinh(y) - d3) / d2 - P;  // falls in y
    (excess > 0 ? low : high) = y;
    double next = y - excess / (A * d1 + B * std::cosh(y) / d2);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const double step = next - y;
    y = next;
    if (!(std::abs(step) > 1e-15 * (1 + std::abs(y)))) break;
  }
  return y;
}

template <>
void DeGrooteFregly2016Parameters<double>::requireRules() const {
  requireRanges(*this);
}

template <>
AnyActivation DeGrooteFregly2016Parameters<double>::activation() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (ignoreActivationDynamics) return DirectActivation{-infinity, infinity};
  return SmoothActivation<double>{activationTime, deactivationTime, activationSmoothing};
}

// f_T depends on ε/e_T alone.
template <>
auto DeGrooteFregly2016<double>::tendonForceInOwn(double strain) const -> Own {
  Own d{};
  d[DeGrooteOwn::tendonStrain] = -strain / p_.tendonUnitStrain * tendonForce(strain).slope;
  return d;
}

// f_l depends on (l − 1)/ω alone.
template <>
auto DeGrooteFregly2016<double>::activeForceInOwn(double l) const -> Own {
  Own d{};
  d[DeGrooteOwn::activeWidth] = -(l - 1) * perWidth_ * activeForce(l).slope;
  return d;
}

// f_PE = s (E − o), s = 1/(e⁴ − o): the exponents of E and o go as 1/e_M
template <>
auto DeGrooteFregly2016<double>::passiveForceInOwn(double l) const -> Own {
  Own d{};
  const CurvePoint<double> f = passiveForce(l);
  const double perStrain = 1 / p_.passiveUnitStrain;
  const double offset = 0.8 * passiveRate_ * offset_ * perStrain;  // ∂o/∂e_M
  d[DeGrooteOwn::passiveStrain] =
      -(l - 1) * perStrain * f.slope + offset * passiveScale_ * (f.value - 1.0);
  if (p_.ignorePassiveFibreForce) d[DeGrooteOwn::passiveStrain] = 0;
  return d;
}

template <>
auto DeGrooteFregly2016<double>::forceVelocityInOwn(double, double) const -> Own {
  return {};
}

template <>
auto DeGrooteFregly2016<double>::speedInOwn(double P, double A, double a) const -> Own {
  Own d{};
  const FibreSpeed<double> s = speed(P, A, a);
  d[DeGrooteOwn::damping] = -s.v * s.byForce;
  return d;
}

}  // namespace bio::muscles
