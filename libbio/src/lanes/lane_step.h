#pragma once

// The step of lane_model.h, for the one file per instruction set that compiles it.

#include "lanes/lane_model.h"
#include "lanes/lane_numbers.h"

namespace bio::lanes {
namespace {

struct PathJet {
  Real length, slope, curvature;  ///< ℓ [m], dℓ/dq, d²ℓ/dq²
};

struct CurveJet {
  Real value, slope;
};

inline CurveJet evaluate(Curve<Lanes>& c, const Real& x) {
  if (!all((x >= c.lower) & (x < c.upper))) movePieces(c, x);
  const Real t = x - c.start;
  return {c.value + t * (c.slope + t * (c.quadratic + t * c.cubic)),
          c.slope + t * (2 * c.quadratic + t * 3 * c.cubic)};
}

/// L = √(k₀ + k₁ cos q + k₂ sin q):  L′ = (k₂ cos q − k₁ sin q)/2L,
/// L″ = (−(k₁ cos q + k₂ sin q)/2 − L′²)/L
inline void addStraight(PathJet& jet, const LaneSpan<Lanes>& span, const SineCosine& turn,
                        const Mask& where) {
  const Real changing = span.cosine * turn.cosine + span.sine * turn.sine;
  const Real length = squareRoot(span.constant + changing);
  const Real perLength = 1 / length;
  const Real slope = (span.sine * turn.cosine - span.cosine * turn.sine) / 2 * perLength;
  const Real curvature = (-changing / 2 - slope * slope) * perLength;
  const Real none = same(0);
  jet.length += choose(where, length, none);
  jet.slope += choose(where, slope, none);
  jet.curvature += choose(where, curvature, none);
}

/// An end of a span over a cylinder and its derivatives in q.
struct EndJet {
  Real value[3], first[3], second[3];
};

inline void follow(const Turning<Lanes>& point, bool fixed, const SineCosine& turn, EndJet& end) {
  for (int i = 0; i < 3; ++i) {
    if (fixed) {
      end.value[i] = point.middle[i];
      continue;
    }
    const Real out = point.along[i] * turn.cosine + point.across[i] * turn.sine;
    end.value[i] = point.middle[i] + out;
    end.first[i] = point.across[i] * turn.cosine - point.along[i] * turn.sine;
    end.second[i] = -out;
  }
}

/// wrapCylinderDyads and addCylinder along q; adds the span where it touches, of the lanes asked
/// for. Returns where it did.
inline Mask addCylinder(PathJet& jet, const Cylinder<Lanes>& cylinder, const SineCosine& turn,
                        const Mask& where) {
  EndJet P, Q;
  follow(cylinder.ends[0], cylinder.fixed[0], turn, P);
  follow(cylinder.ends[1], cylinder.fixed[1], turn, Q);
  const Real r = cylinder.radius * cylinder.side;
  const Real rr = cylinder.radius * cylinder.radius;
  const Real pp = P.value[0] * P.value[0] + P.value[1] * P.value[1];
  const Real qq = Q.value[0] * Q.value[0] + Q.value[1] * Q.value[1];
  Mask touches = where & (pp > rr) & (qq > rr);

  // unit tangents at the ends, and the turn from one to the other
  const Real a = squareRoot(pp - rr);
  const Real b = squareRoot(qq - rr);
  const Real perPP = 1 / pp;
  const Real perQQ = 1 / qq;
  const Real eP[2] = {-(a * P.value[0] + r * P.value[1]) * perPP,
                      (r * P.value[0] - a * P.value[1]) * perPP};
  const Real eQ[2] = {(b * Q.value[0] - r * Q.value[1]) * perQQ,
                      (r * Q.value[0] + b * Q.value[1]) * perQQ};
  const Real sine = (eP[0] * eQ[1] - eP[1] * eQ[0]) * cylinder.side;
  const Real across = cylinder.side * (P.value[0] * Q.value[1] - P.value[1] * Q.value[0]);
  touches &= (across < 0) | (sine > 0);
  if (!any(touches)) return touches;

  // a cylinder of finite length, whose ends the way may pass beyond
  const Mask beyond = touches & ((absolute(P.value[2]) > cylinder.halfLength) |
                                 (absolute(Q.value[2]) > cylinder.halfLength));
  if (any(beyond)) {
    for (int l = 0; l < width; ++l) {
      if (beyond[l] && !touchesWithin(cylinder, P.value, Q.value, l)) touches[l] = 0;
    }
  }

  const Real cosine = eP[0] * eQ[0] + eP[1] * eQ[1];
  const Real s = a + cylinder.radius * angleOf(sine, cosine) + b;
  const Real h = Q.value[2] - P.value[2];
  const Real length = squareRoot(s * s + h * h);
  const Real perLength = 1 / length;
  const Real around = s * perLength;
  const Real up = h * perLength;
  Real slope = same(0);
  Real curvature = same(0);
  Real m = same(0);
  if (!cylinder.fixed[0]) {
    const Real tangent = eP[0] * P.first[0] + eP[1] * P.first[1];
    const Real normal = eP[0] * P.first[1] - eP[1] * P.first[0];
    slope -= around * tangent + up * P.first[2];
    m += around * P.first[2] - up * tangent;
    curvature += around / a * normal * normal -
                 around * (eP[0] * P.second[0] + eP[1] * P.second[1]) - up * P.second[2];
  }
  if (!cylinder.fixed[1]) {
    const Real tangent = eQ[0] * Q.first[0] + eQ[1] * Q.first[1];
    const Real normal = eQ[0] * Q.first[1] - eQ[1] * Q.first[0];
    slope += around * tangent + up * Q.first[2];
    m += up * tangent - around * Q.first[2];
    curvature += around / b * normal * normal +
                 around * (eQ[0] * Q.second[0] + eQ[1] * Q.second[1]) + up * Q.second[2];
  }
  curvature += perLength * m * m;
  const Real none = same(0);
  jet.length += choose(touches, length, none);
  jet.slope += choose(touches, slope, none);
  jet.curvature += choose(touches, curvature, none);
  return touches;
}

/// The muscle–tendon length in the variant of every lane; adds it where asked for.
inline void addVariant(PathJet& jet, const LaneArm<Lanes>& arm, const Variant<Lanes>& variant,
                       const SineCosine& turn, const Mask& where) {
  jet.length += choose(where, variant.fixedLength, same(0));
  Mask used[maxCylinders] = {};
  for (int i = variant.firstSpan; i < variant.firstSpan + variant.numSpans; ++i) {
    const LaneSpan<Lanes>& span = arm.spans[i];
    Mask left = where;
    for (int k = span.firstCylinder; k < span.firstCylinder + span.numCylinders; ++k) {
      const Cylinder<Lanes>& cylinder = arm.cylinders[k];
      const Mask taken = addCylinder(jet, cylinder, turn, left & ~used[cylinder.surface]);
      used[cylinder.surface] |= taken;
      left &= ~taken;
    }
    if (any(left)) addStraight(jet, span, turn, left);
  }
}

inline PathJet muscleTendonLength(const LaneArm<Lanes>& arm, const LaneMuscle<Lanes>& muscle,
                                  const Real& q, const SineCosine& turn) {
  PathJet jet{same(0), same(0), same(0)};
  const Mask everywhere = q == q;
  if (muscle.numConditions == 0) {
    addVariant(jet, arm, arm.variants[muscle.firstVariant], turn, everywhere);
    return jet;
  }
  for (int bits = 0; bits < 1 << muscle.numConditions; ++bits) {
    Mask where = everywhere;
    for (int i = 0; i < muscle.numConditions; ++i) {
      const Condition<Lanes>& condition = arm.conditions[muscle.firstCondition + i];
      const Mask holds = (q >= condition.lower) & (q <= condition.upper);
      where &= ((bits >> i) & 1) != 0 ? holds : ~holds;
    }
    if (any(where)) addVariant(jet, arm, arm.variants[muscle.firstVariant + bits], turn, where);
  }
  return jet;
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
  constexpr double shapeShortening = 0.15;
  constexpr double maxLengtheningForce = 1.4;
  constexpr double shapeLengthening = 0.13 * shapeShortening / (shapeShortening + 1);
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

/// Newton's corrections fall quadratically: is the next one within the tolerance? See
/// VariationalStepper::isLast.
inline Mask isLast(const Real& correction, const Real& previous, double tolerance) {
  constexpr double worthwhile = 1e-4;
  const Real ratio = correction / previous;
  return (correction < tolerance) | ((correction <= worthwhile) & (correction <= 0.1 * previous) &
                                     (correction * ratio * ratio < 0.01 * tolerance));
}

/// See VariationalStepper::solve, whose comments are not repeated.
inline void solve(const LaneArm<Lanes>& arm, LaneStep& step) {
  constexpr double largestTurn = 0.3;
  constexpr double largestFibreStep = 0.25;
  const Real none = same(0);
  const Real one = same(1);
  const Real& h = step.length;
  const Real perStep = 1 / h;
  const Real share = step.symmetric ? h / 2 : h;
  const Real dMv = arm.mass * perStep;
  Real previous = none;
  Mask running = step.wanted;
  step.converged = running ^ running;
  for (int iteration = 1; iteration <= step.maxIterations; ++iteration) {
    const Real q_m = (step.q + step.qEnd) / 2;
    const Real v = (step.qEnd - step.q) / h;
    const SineCosine turn = sineCosine(q_m);

    // skeleton and gravity
    const Real Mv = arm.mass * v;
    const Real L_q = arm.gravityCosine * turn.sine - arm.gravitySine * turn.cosine;
    const Real dL_q = (arm.gravityCosine * turn.cosine + arm.gravitySine * turn.sine) / 2;

    PassiveForce passive{none, none, none};
    if (arm.hasForces) passiveForce(arm, running, q_m, v, passive);
    const Real dPassive = passive.dForce_dq / 2 + passive.dForce_dqDot / h;
    Real dTau = dPassive;

    // muscles, fibre lengths eliminated one by one
    Real force = none;
    Real eliminated = none;
    Real carried = none;
    for (int i = 0; i < arm.numMuscles; ++i) {
      LaneMuscle<Lanes>& muscle = arm.muscles[i];
      MuscleStep& kept = step.muscles[i];
      const PathJet path = muscleTendonLength(arm, muscle, q_m, turn);
      const Real l_m = (kept.fibreLength + kept.fibreLengthEnd) / 2;
      const Rate r = fibreRate(muscle, kept.activation, l_m, path.length);
      force -= r.tendonForce * path.slope;
      dTau -= r.dF_dMuscleTendonLength / 2 * path.slope * path.slope;
      dTau -= r.tendonForce / 2 * path.curvature;
      kept.residual = (kept.fibreLengthEnd - kept.fibreLength) / h - r.fibreVelocity;
      kept.inverse = 1 / (perStep - r.dV_dFibreLength / 2);
      const Real G = share / 2 * r.dF_dFibreLength * kept.inverse * path.slope;
      eliminated -= G * r.dV_dMuscleTendonLength / 2 * path.slope;
      carried += G * kept.residual;
      kept.momentArm = path.slope;
      kept.dV_dMuscleTendonLength = r.dV_dMuscleTendonLength;
      kept.dF_dFibreLength = r.dF_dFibreLength;
    }

    const Real R = Mv - h / 2 * L_q - share * (force + passive.force + step.external) - step.p;
    const Real J = dMv - h / 2 * dL_q - share * dTau - eliminated;
    const Real dq = (carried - R) / J;
    const Real size = absolute(dq);
    Real fibreSize = none;
    for (int i = 0; i < arm.numMuscles; ++i) {
      MuscleStep& kept = step.muscles[i];
      const Real C_dq = -kept.dV_dMuscleTendonLength / 2 * kept.momentArm * dq;
      kept.residual = -(kept.residual + C_dq) * kept.inverse;  // now δℓ
      fibreSize = larger(fibreSize, absolute(kept.residual) * arm.muscles[i].perFibre);
    }
    // what is not a number, or wild, is given up
    running &= (size < 1e6) & (fibreSize < 1e6);

    Real shorten = choose(size > largestTurn, largestTurn / size, one);
    shorten = choose(fibreSize * shorten > largestFibreStep, largestFibreStep / fibreSize, shorten);
    step.qEnd = choose(running, step.qEnd + shorten * dq, step.qEnd);
    for (int i = 0; i < arm.numMuscles; ++i) {
      MuscleStep& kept = step.muscles[i];
      kept.fibreLengthEnd =
          choose(running, kept.fibreLengthEnd + shorten * kept.residual, kept.fibreLengthEnd);
    }
    const Real correction = larger(size, fibreSize);
    const Mask last =
        running & isLast(correction, choose(shorten == 1, previous, none), step.newtonTolerance);
    previous = correction;
    for (int l = 0; l < width; ++l) {
      if (running[l]) step.iterations[l] = iteration;
    }
    if (!any(last)) {
      if (!any(running)) return;
      continue;
    }

    // ends of the lanes that have come to theirs, to first order in the last correction
    for (int i = 0; i < arm.numMuscles; ++i) {
      const MuscleStep& kept = step.muscles[i];
      force -= kept.dF_dFibreLength / 2 * kept.residual * kept.momentArm;
    }
    force += (dTau - dPassive) * dq;
    const Real passiveEnd = passive.force + dPassive * dq;
    const Real moved = step.qEnd - step.q;
    Real p = Mv + dMv * dq + h / 2 * (L_q + dL_q * dq);
    if (step.symmetric) p += share * (force + passiveEnd + step.external);
    step.pEnd = choose(last, p, step.pEnd);
    step.muscleWork = choose(last, force * moved, step.muscleWork);
    step.passiveWork = choose(last, passiveEnd * moved, step.passiveWork);
    step.externalWork = choose(last, step.external * moved, step.externalWork);
    step.converged |= last;
    running &= ~last;
    if (!any(running)) return;
  }
}

}  // namespace
}  // namespace bio::lanes
