#pragma once

// What Schutte's muscle does at a state, in lanes.

#include "bio/muscle/curves/force_velocity.h"
#include "simulation/simd/lane_model.h"
#include "simulation/simd/lane_numbers.h"

namespace bio::lanes {
namespace {

struct CurveJet {
  Real value, slope;
};

inline CurveJet evaluate(Curve<Lanes>& c, const Real& x) {
  if (!all((x >= c.lower) & (x < c.upper))) movePieces(c, x);
  const Real t = x - c.start;
  return {c.value + t * (c.slope + t * (c.quadratic + t * c.cubic)),
          c.slope + t * (2 * c.quadratic + t * 3 * c.cubic)};
}

/// fibreRateDerivatives, the kinks chosen by masks.
struct Rate {
  Real fibreVelocity, tendonForce;
  Real dV_dFibreLength, dV_dMuscleTendonLength, dF_dFibreLength, dF_dMuscleTendonLength;
};

inline Rate fibreRate(LaneMuscle<Lanes>& muscle, const Real& activation, const Real& fibreLength,
                      const Real& muscleTendonLength) {
  const Real none = same(0);
  // pennation; outside the fibre's domain everything becomes NaN
  const Real square = muscle.thickness * muscle.thickness;
  const Real projected = squareRoot(
      choose(fibreLength > muscle.thickness, fibreLength * fibreLength - square, same(-1)));
  const Real perProjected = 1 / projected;
  const Real kappa = fibreLength * perProjected;
  const Real dKappa = -square * perProjected * perProjected * perProjected;

  // tendon, slack at negative strains
  const Real strain = (muscleTendonLength - projected) * muscle.perTendon - 1;
  CurveJet tendon = evaluate(muscle.tendon, strain);
  const Mask slack = strain < 0;
  tendon.value = choose(slack, none, tendon.value);
  tendon.slope = choose(slack, none, tendon.slope);

  // fibre
  const Real l = fibreLength * muscle.perFibre;
  CurveJet passive;
  if (muscle.hasPassiveCurve) {
    passive = evaluate(muscle.passive, l);
  } else {
    exponentialPassiveForce(l, passive.value, passive.slope);
  }
  CurveJet active = evaluate(muscle.active, l);
  const Mask out = active.value < 0;
  active.value = choose(out, none, active.value);
  active.slope = choose(out, none, active.slope);
  const Real act = larger(activation, muscle.activationFloor);
  const Real A = act * active.value;
  const Real dA_dl = act * active.slope * muscle.perFibre;

  // P = F̂_T κ − f_PE
  const Real slope = tendon.slope * muscle.perTendon;
  Real P = tendon.value * kappa - passive.value;
  Real dP_dm = slope * kappa;
  Real dP_dl = -slope * kappa * kappa + tendon.value * dKappa - passive.slope * muscle.perFibre;
  if (muscle.clampsForce) {
    const Mask clamped = P < 0;
    P = choose(clamped, none, P);
    dP_dm = choose(clamped, none, dP_dm);
    dP_dl = choose(clamped, none, dP_dl);
  }

  // v(P, A): the root of the quadratic of its regime, written without cancellation
  using schutte::maxLengtheningForce;
  using schutte::shapeLengthening;
  using schutte::shapeShortening;
  const Real& B = muscle.damping;
  const Mask shortens = P < A;
  const Real b = choose(shortens, P + shapeShortening * (A + B),
                        P - maxLengtheningForce * A - shapeLengthening * B);
  const Real c = choose(shortens, same(shapeShortening), same(shapeLengthening)) * (P - A);
  const Real product = 4 * B * c;
  const Real root = squareRoot(b * b + choose(shortens, -product, product));
  const Real sum = absolute(b) + root;
  const Mask conjugate = ~(shortens ^ (b > 0));
  Real v = choose(conjugate, 2 * c, choose(shortens, -sum, sum)) / choose(conjugate, sum, 2 * B);
  const Real perRoot = 1 / root;
  Real dv_dP = choose(shortens, shapeShortening - v, v + shapeLengthening) * perRoot;
  Real dv_dA =
      -choose(shortens, shapeShortening * (1 + v), maxLengtheningForce * v + shapeLengthening) *
      perRoot;
  const Mask linear = P < -B;
  if (any(linear)) {
    v = choose(linear, P / B, v);
    dv_dP = choose(linear, 1 / B, dv_dP);
    dv_dA = choose(linear, none, dv_dA);
  }

  const Real stiffness = muscle.force * slope;
  return {muscle.speedScale * v,
          muscle.force * tendon.value,
          muscle.speedScale * (dv_dP * dP_dl + dv_dA * dA_dl),
          muscle.speedScale * dv_dP * dP_dm,
          -stiffness * kappa,
          stiffness};
}

}  // namespace
}  // namespace bio::lanes
