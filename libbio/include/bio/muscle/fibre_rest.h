#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bio/muscle/bracketed_root.h"
#include "bio/muscle/hill_muscle.h"
#include "bio/muscle/muscle_sensitivity.h"

namespace bio::muscles {

/// Where a fibre comes to rest.
struct FibreRest {
  enum class Why {
    found,           ///< the fibre force balances the tendon force
    forceFree,       ///< neither carries force; fibreLength leaves the tendon just slack
    tendonTooShort,  ///< L ≤ ℓs: the tendon is slack at every fibre length
    notBracketed,    ///< no sign change of the force difference between the borders
    held,            ///< it would be shorter than the class lets it; the tendon may be slack
  };
  Why why;
  double fibreLength;  ///< ℓ [m]; NaN unless usable
  double tendonForce;  ///< F_T [N]; NaN unless usable
  int count;           ///< stable rests seen; above 1 the one nearest ℓ0 is given
  bool isUsable() const { return why == Why::found || why == Why::forceFree || why == Why::held; }
};

/// One line for people.
const char* describe(FibreRest::Why why);

/// Throws std::invalid_argument unless both are finite.
void requireFiniteRest(double activation, double pathLength);

/// The stable fibre length with V(a, ℓ, L) = 0, i.e. where f_T − (A + f_PE) cos α falls through 0:
/// looked for in 64 cells between the shortest fibre and the one that leaves the tendon slack, then
/// by a bracketing method. A class that holds its fibres has it rest at shortestFibre() where
/// every longer one would shorten. With a rigid tendon the fibre's length follows from the path.
///
/// Departure from OpenSim: where several rests exist it takes the one that Newton's method finds
/// from ℓ_T = 1.01 ℓs.
/// @throws std::invalid_argument for an activation or length that is not finite
template <class Shape>
FibreRest restingFibre(const HillMuscle<Shape>& muscle, double activation, double pathLength) {
  requireFiniteRest(activation, pathLength);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto& p = muscle.parameters();
  const Shape& shape = muscle.shape();
  const double least = muscle.hasFibreState() && holdsFibre<Shape> ? muscle.shortestFibre() : 0;
  if (pathLength <= p.tendonSlackLength && !(least > 0)) {
    return {FibreRest::Why::tendonTooShort, nan, nan, 0};
  }
  if (!muscle.hasFibreState()) {
    const RigidRate<double> rate = muscle.rigidRate(activation, pathLength, 0.0);
    const bool loaded = rate.tendonForce > 0;
    return {loaded ? FibreRest::Why::found : FibreRest::Why::forceFree, rate.fibreLength,
            rate.tendonForce, 1};
  }

  const double act = muscle.acting(activation);
  const double w = muscle.thickness();
  const auto difference = [&](double length) {
    const double d = length > w ? muscle.projected(length) : 0.0;
    const double l = length * muscle.perFibre();
    const double fibre = act * shape.activeForce(l).value + shape.passiveForce(l).value;
    return shape.tendonForce((pathLength - d) * muscle.perTendon() - 1).value - fibre * d / length;
  };
  const double lower = std::max({w, least, 1e-6 * p.optimalFibreLength});
  const double upper = std::hypot(std::max(pathLength - p.tendonSlackLength, 0.0), w);
  constexpr int cells = 64;
  FibreRest rest{FibreRest::Why::notBracketed, nan, nan, 0};
  const double atLower = difference(lower);
  double a = lower, fa = atLower;
  for (int i = 1; i <= cells; ++i) {
    const double b = i == cells ? upper : lower + (upper - lower) * i / cells;
    const double fb = difference(b);
    if (fa > 0 && fb <= 0 && b > a) {
      const double root =
          fb == 0 ? b : bracketedRoot(difference, a, fa, b, fb, 1e-15 * p.optimalFibreLength);
      ++rest.count;
      const double away = std::abs(root - p.optimalFibreLength);
      if (rest.count == 1 || away < std::abs(rest.fibreLength - p.optimalFibreLength)) {
        rest.fibreLength = root;
      }
    }
    a = b, fa = fb;
  }
  if (rest.count > 0) {
    const double strain = muscle.tendonStrain(rest.fibreLength, pathLength);
    rest.tendonForce = p.maxIsometricForce * shape.tendonForce(strain).value;
    rest.why = rest.tendonForce > 0 ? FibreRest::Why::found : FibreRest::Why::forceFree;
  } else if (least > 0 && (atLower <= 0 || upper <= least)) {
    const double force = shape.tendonForce(muscle.tendonStrain(least, pathLength)).value;
    rest = {FibreRest::Why::held, least, p.maxIsometricForce * force, 1};
  } else if (fa >= 0 && fa < 1e-12) {
    rest = {FibreRest::Why::forceFree, upper, 0, 0};  // they part without force
  }
  return rest;
}

/// How a resting fibre follows what it depends on.
template <class Shape>
struct RestDerivatives {
  double dl_dActivation;          ///< [m]
  double dl_dPathLength;          ///< [1]
  PerNumber<Shape> dl_dNumber{};  ///< ∂ℓ/∂θ [m per unit]
};

/// By the implicit function theorem on fibreBalance at ℓ̇ = 0; of shortestFibre() where the fibre is
/// held; where fibre and tendon carry no force
/// (F_T < 1e-9 F0) or the tendon is rigid, of ℓ = √((L − ℓs)² + w²).
template <class Shape>
RestDerivatives<Shape> restDerivatives(const HillMuscle<Shape>& muscle, double activation,
                                       double pathLength, const FibreRest& rest) {
  const auto& p = muscle.parameters();
  RestDerivatives<Shape> r{};
  const double length = rest.fibreLength;
  if constexpr (holdsFibre<Shape>) {
    if (rest.why == FibreRest::Why::held) {
      r.dl_dNumber = shortestFibreInNumbers(muscle);
      return r;
    }
  }
  if (!muscle.hasFibreState() || rest.tendonForce < 1e-9 * p.maxIsometricForce) {
    const double along = (pathLength - p.tendonSlackLength) / length;
    const double across = muscle.thickness() / length;
    r.dl_dPathLength = along;
    r.dl_dNumber[common::tendonSlackLength] = -along;
    r.dl_dNumber[common::optimalFibreLength] = across * std::sin(p.pennation);
    r.dl_dNumber[common::pennation] = across * p.optimalFibreLength * std::cos(p.pennation);
    return r;
  }
  const FibreBalance<double> b = muscle.fibreBalance(activation, length, pathLength, 0.0);
  const InNumbers<Shape> d = fibreBalanceInNumbers(muscle, activation, length, pathLength, 0.0);
  const double per = -1 / b.dR_dFibreLength;
  r.dl_dActivation = b.dR_dActivation * per;
  r.dl_dPathLength = b.dR_dPathLength * per;
  for (std::size_t i = 0; i < d.equation.size(); ++i) r.dl_dNumber[i] = d.equation[i] * per;
  return r;
}

}  // namespace bio::muscles
