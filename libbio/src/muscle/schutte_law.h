#pragma once

// Schutte's law with its derivatives, for numbers N of one state or of several side by side
// (branch() in bio/muscle/number_type.h). `Muscle` is SchutteMuscle<double> or has functions of the
// same names; `Pieces` are the curves' SchuttePieces.

#include <cmath>
#include <limits>

#include "bio/muscle/curves/force_velocity.h"
#include "bio/muscle/number_type.h"

namespace bio::schutte {

using muscles::branch;
using muscles::choose;

/// Value and derivatives of a piecewise cubic.
template <class N>
struct CurveJet {
  N value, slope;
};

/// P and A with their derivatives in act, ℓ and ℓ_MT; κ = 1/cos α.
template <class N>
struct ForceBalance {
  N tendon, tendonSlope;  ///< F̂_T over ε
  N kappa, dKappa;        ///< over ℓ
  N P, dP_dl, dP_dm;
  N A, dA_da, dA_dl;
};

/// P with its derivatives in ℓ and ℓ_MT.
template <class N>
struct Pull {
  N P, byLength, byPath;
};

/// P = F̂_T κ − f_PE, held at 0 where it is clamped; `f` as far as it is known.
template <class Muscle, class N>
[[gnu::always_inline]] inline Pull<N> pullOf(const Muscle& muscle, const ForceBalance<N>& f,
                                             const CurveJet<N>& passive) {
  const N none(0.0);
  const N perFibre = muscle.perFibre();
  const N perTendon = muscle.perTendon();
  const N P = f.tendon * f.kappa - passive.value;
  return branch(
      muscle.options().clampForce && P < 0.0,
      [&] {
        return Pull<N>{none, none, none};
      },
      [&] {
        const N slope = f.tendonSlope * perTendon;
        return Pull<N>{P,
                       -slope * f.kappa * f.kappa + f.tendon * f.dKappa - passive.slope * perFibre,
                       slope * f.kappa};
      });
}

template <class Muscle, class Pieces, class N>
[[gnu::always_inline]] inline ForceBalance<N> forceBalance(const Muscle& muscle,
                                                           const N& activation,
                                                           const N& fibreLength,
                                                           const N& muscleTendonLength,
                                                           Pieces& last) {
  using std::exp, std::sqrt;
  const N none(0.0);
  ForceBalance<N> f;
  const N perFibre = muscle.perFibre();
  const N perTendon = muscle.perTendon();
  const auto& curves = muscle.curves();

  // Pennation: d = ℓ cos α = √(ℓ² − w²), κ = ℓ/d.
  const N w2 = muscle.thickness() * muscle.thickness();
  const N d = branch(
      fibreLength > muscle.thickness(), [&] { return N(sqrt(fibreLength * fibreLength - w2)); },
      [] { return N(std::numeric_limits<double>::quiet_NaN()); });
  const N perD = 1.0 / d;
  f.kappa = fibreLength * perD;
  f.dKappa = -w2 * perD * perD * perD;

  // Tendon.
  const N strain = (muscleTendonLength - d) * perTendon - 1.0;
  using Jet = CurveJet<N>;
  const Jet tendon = branch(
      strain < 0.0,
      [&] {
        return Jet{none, none};
      },
      [&] {
        const auto y = curves.tendonForce.evaluate(strain, last.tendonForce);
        return Jet{y.value, y.slope};
      });
  f.tendon = tendon.value;
  f.tendonSlope = tendon.slope;

  // Fibre.
  const N l = fibreLength * perFibre;
  Jet passive;
  if (curves.passiveForce) {
    const auto y = curves.passiveForce->evaluate(l, last.passiveForce);
    passive = {y.value, y.slope};
  } else {
    const N value = exp(8.0 * l - 12.0);
    passive = {value, 8.0 * value};
  }
  const auto active = curves.activeForce.evaluate(l, last.activeForce);
  const N least(muscle.options().activationFloor);
  const auto floored = activation < least;
  const N act = choose(floored, least, activation);
  struct Active {
    N A, byActivation, byLength;
  };
  const Active a = branch(
      active.value < 0.0,
      [&] {
        return Active{none, none, none};
      },
      [&] {
        return Active{act * active.value, choose(floored, none, N(active.value)),
                      act * active.slope * perFibre};
      });
  f.A = a.A;
  f.dA_da = a.byActivation;
  f.dA_dl = a.byLength;

  const Pull<N> p = pullOf(muscle, f, passive);
  f.P = p.P;
  f.dP_dl = p.byLength;
  f.dP_dm = p.byPath;
  return f;
}

/// v(P, A), from the quadratic G(v; P, A) = 0 of its regime: v_x = −G_x/G_v.
template <class N>
struct Velocity {
  N v, dv_dP, dv_dA;
};

template <class N>
[[gnu::always_inline]] inline Velocity<N> velocity(const N& P, const N& A, const N& B) {
  using std::sqrt;
  const auto linear = [&] { return Velocity<N>{P / B, 1.0 / B, N(0.0)}; };
  const auto shortening = [&] {
    const N b = P + shapeShortening * (A + B);
    const N c = shapeShortening * (P - A);
    const N root = sqrt(b * b - 4.0 * B * c);
    const N v = branch(
        b > 0.0, [&] { return N(2.0 * c / (b + root)); },
        [&] { return N((b - root) / (2.0 * B)); });
    const N perRoot = 1.0 / root;
    return Velocity<N>{v, (shapeShortening - v) * perRoot, -shapeShortening * (1.0 + v) * perRoot};
  };
  const auto lengthening = [&] {
    const N b = P - maxLengtheningForce * A - shapeLengthening * B;
    const N c = shapeLengthening * (P - A);
    const N root = sqrt(b * b + 4.0 * B * c);
    const N v = branch(
        b > 0.0, [&] { return N((b + root) / (2.0 * B)); },
        [&] { return N(2.0 * c / (root - b)); });
    const N perRoot = 1.0 / root;
    return Velocity<N>{v, (v + shapeLengthening) * perRoot,
                       -(maxLengtheningForce * v + shapeLengthening) * perRoot};
  };
  return branch(P < -B, linear, [&] { return branch(P < A, shortening, lengthening); });
}

/// Fibre velocity and tendon force with first derivatives, `Rate` having the members of
/// FibreRateDerivatives.
template <class Rate, class Muscle, class N>
[[gnu::always_inline]] inline Rate assemble(const Muscle& muscle, const ForceBalance<N>& f,
                                            const Velocity<N>& u) {
  const N speed = muscle.speedScale();
  const N force = muscle.quantities().maxIsometricForce;
  const N stiffness = force * f.tendonSlope * muscle.perTendon();
  return {.fibreVelocity = speed * u.v,
          .tendonForce = force * f.tendon,
          .dV_dActivation = speed * u.dv_dA * f.dA_da,
          .dV_dFibreLength = speed * (u.dv_dP * f.dP_dl + u.dv_dA * f.dA_dl),
          .dV_dMuscleTendonLength = speed * u.dv_dP * f.dP_dm,
          .dF_dFibreLength = -stiffness * f.kappa,
          .dF_dMuscleTendonLength = stiffness};
}

}  // namespace bio::schutte
