#include "bio/muscle/millard2012.h"

#include <cmath>

namespace bio::muscles {
namespace {

using MillardNumbers = Millard2012Parameters<double>;
// Places among all numbers where those of the curves begin.
constexpr std::size_t activePlace = 6, passivePlace = 11, tendonPlace = 16, velocityPlace = 20;
static_assert(MillardNumbers::properties[activePlace].name ==
              "ActiveForceLengthCurve/min_norm_active_fiber_length");
static_assert(MillardNumbers::properties[passivePlace].name ==
              "FiberForceLengthCurve/strain_at_zero_force");
static_assert(MillardNumbers::properties[tendonPlace].name ==
              "TendonForceLengthCurve/strain_at_one_norm_force");
static_assert(MillardNumbers::properties[velocityPlace].name ==
              "ForceVelocityCurve/concentric_slope_at_vmax");
static_assert(MillardNumbers::properties[Millard2012<double>::dampingPlace].name ==
              "fiber_damping");
static_assert(MillardNumbers::properties[Millard2012<double>::minimumActivationPlace].name ==
              "minimum_activation");

// The parameters as dual numbers, those from `place` on varied.
template <int C>
Millard2012Parameters<info::Dual<C>> varied(const MillardNumbers& p, std::size_t place) {
  using D = info::Dual<C>;
  auto q = inNumbers<Millard2012Parameters, D>(p);
  for (int i = 0; i < C; ++i) {
    D& x = q.at(q, place + static_cast<std::size_t>(i));
    x = D(x.value(), C, i);
  }
  return q;
}

// A curve's derivatives among the class's own numbers.
template <std::size_t C>
Millard2012<double>::Own placed(const std::array<double, C>& d, std::size_t place) {
  Millard2012<double>::Own own{};
  for (std::size_t i = 0; i < C; ++i) own[place - common::count + i] = d[i];
  return own;
}

void requireVelocityRules(const MillardNumbers& p) {
  const double margin = p.maxEccentricForce - 1;
  requireRule(p.concentricSlope < p.concentricNearSlope,
              "ForceVelocityCurve/concentric_slope_at_vmax", p.concentricSlope,
              "< concentric_slope_near_vmax");
  requireRule(p.eccentricSlope <= p.eccentricNearSlope,
              "ForceVelocityCurve/eccentric_slope_at_vmax", p.eccentricSlope,
              "<= eccentric_slope_near_vmax");
  requireRule(p.eccentricNearSlope < margin, "ForceVelocityCurve/eccentric_slope_near_vmax",
              p.eccentricNearSlope, "< max_eccentric_velocity_force_multiplier - 1");
}

}  // namespace

template <>
void Millard2012Parameters<double>::requireRules() const {
  requireRanges(*this);
  requireRule(minActiveLength < transitionLength,
              "ActiveForceLengthCurve/min_norm_active_fiber_length", minActiveLength,
              "< transition_norm_fiber_length");
  requireRule(transitionLength < 1, "ActiveForceLengthCurve/transition_norm_fiber_length",
              transitionLength, "< 1");
  requireRule(shallowSlope < (1 - minActiveForce) / (1 - transitionLength),
              "ActiveForceLengthCurve/shallow_ascending_slope", shallowSlope,
              "< (1 - minimum_value)/(1 - transition_norm_fiber_length)");
  requireRule(passiveUnitStrain > passiveZeroStrain,
              "FiberForceLengthCurve/strain_at_one_norm_force", passiveUnitStrain,
              "> strain_at_zero_force");
  const double chord = 1 / (passiveUnitStrain - passiveZeroStrain);
  if (passiveShapeIsGiven) {
    requireRule(passiveUnitStiffness > chord, "FiberForceLengthCurve/stiffness_at_one_norm_force",
                passiveUnitStiffness, "> 1/(strain_at_one_norm_force - strain_at_zero_force)");
    requireRule(passiveLowStiffness < chord, "FiberForceLengthCurve/stiffness_at_low_force",
                passiveLowStiffness, "< 1/(strain_at_one_norm_force - strain_at_zero_force)");
  } else {
    requireRule(chord > 0.2, "FiberForceLengthCurve/strain_at_one_norm_force", passiveUnitStrain,
                "< strain_at_zero_force + 5 where stiffness_at_low_force is not given");
  }
  if (tendonShapeIsGiven) {
    requireRule(tendonUnitStiffness * tendonUnitStrain > 1,
                "TendonForceLengthCurve/stiffness_at_one_norm_force", tendonUnitStiffness,
                "> 1/strain_at_one_norm_force");
  }
  requireVelocityRules(*this);
  requireRule(isDamped() || ignoreTendonCompliance || minimumActivation >= 0.01,
              "minimum_activation", minimumActivation,
              ">= 0.01 without damping (fiber_damping < 0.001)");
}

template <>
AnyActivation Millard2012Parameters<double>::activation() const {
  if (ignoreActivationDynamics) return DirectActivation{minimumActivation, 1};
  return FirstOrderActivation<double>{activationTime, deactivationTime, minimumActivation};
}

MillardSensitivities::MillardSensitivities(const Millard2012Parameters<double>& p)
    : active(activeCurveOf(varied<5>(p, activePlace))),
      passive(passiveCurveOf(varied<5>(p, passivePlace))),
      tendon(tendonCurveOf(varied<4>(p, tendonPlace))),
      forceVelocity(forceVelocityCurveOf(varied<8>(p, velocityPlace))) {}

template <>
auto Millard2012<double>::tendonForceInOwn(double strain) const -> Own {
  return placed(inOwn_.tendon.at(tendon_, strain + 1), tendonPlace);
}

template <>
auto Millard2012<double>::activeForceInOwn(double l) const -> Own {
  return placed(inOwn_.active.at(active_, l), activePlace);
}

template <>
auto Millard2012<double>::passiveForceInOwn(double l) const -> Own {
  return placed(inOwn_.passive.at(passive_, l), passivePlace);
}

template <>
auto Millard2012<double>::forceVelocityInOwn(double v, double) const -> Own {
  return placed(inOwn_.forceVelocity.at(forceVelocity_, v), velocityPlace);
}

// A f_v(v) + B v = P at fixed P and A: v_θ = −(A f_v,θ + B_θ v)/(A f_v′ + B)
template <>
auto Millard2012<double>::speedInOwn(double P, double A, double a) const -> Own {
  const FibreSpeed<double> s = speed(P, A, a);
  Own d = forceVelocityInOwn(s.v, a);
  for (double& x : d) x *= -A * s.byForce;
  if (p_.isDamped()) d[dampingPlace - common::count] = -s.v * s.byForce;
  return d;
}

}  // namespace bio::muscles
