#pragma once

// Muscle–tendon lengths in lanes, by their closed forms in sin q and cos q.

#include "simulation/simd/lane_model.h"
#include "simulation/simd/lane_numbers.h"

namespace bio::lanes {
namespace {

struct PathJet {
  Real length, slope, curvature;  ///< ℓ [m], dℓ/dq, d²ℓ/dq²
};

/// L = √(k₀ + k₁ cos q + k₂ sin q):  L′ = (k₂ cos q − k₁ sin q)/2L,
/// L″ = (−(k₁ cos q + k₂ sin q)/2 − L′²)/L
inline void addStraight(PathJet& jet, const LaneSpan<Here>& span, const SineCosine& turn,
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

inline void follow(const Turning<Here>& point, bool fixed, const SineCosine& turn, EndJet& end) {
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
inline Mask addCylinder(PathJet& jet, const Cylinder<Here>& cylinder, const SineCosine& turn,
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
  const Real along = P.value[0] * Q.value[0] + P.value[1] * Q.value[1];
  touches &= (across < 0) | (sine > 0);
  // what has slipped off is straight
  touches &= ~((across < 0) & (cylinder.slipCosine * across - cylinder.slipSine * along > 0));
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
inline void addVariant(PathJet& jet, const LaneModel<Here>& arm, const Variant<Here>& variant,
                       const SineCosine& turn, const Mask& where) {
  jet.length += choose(where, variant.fixedLength, same(0));
  Mask used[maxCylinders] = {};
  for (int i = variant.firstSpan; i < variant.firstSpan + variant.numSpans; ++i) {
    const LaneSpan<Here>& span = arm.spans[i];
    Mask left = where;
    for (int k = span.firstCylinder; k < span.firstCylinder + span.numCylinders; ++k) {
      const Cylinder<Here>& cylinder = arm.cylinders[k];
      const Mask taken = addCylinder(jet, cylinder, turn, left & ~used[cylinder.surface]);
      used[cylinder.surface] |= taken;
      left &= ~taken;
    }
    if (any(left)) addStraight(jet, span, turn, left);
  }
}

inline PathJet muscleTendonLength(const LaneModel<Here>& arm, const LaneMuscle<Here>& muscle,
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
      const Condition<Here>& condition = arm.conditions[muscle.firstCondition + i];
      const Mask holds = (q >= condition.lower) & (q <= condition.upper);
      where &= ((bits >> i) & 1) != 0 ? holds : ~holds;
    }
    if (any(where)) addVariant(jet, arm, arm.variants[muscle.firstVariant + bits], turn, where);
  }
  return jet;
}

}  // namespace
}  // namespace bio::lanes
