#include "path/span_surfaces.h"

#include <algorithm>

#include "bio/path/surface/way.h"
#include "path/path_reach.h"

namespace bio {

void SpanSurfaces::assign(const CandidateWrap& wrap, PathVariant& variant, std::size_t bits) const {
  const PathSurface& surface = path_.surfaces[wrap.surface];
  std::vector<Encounter> through, around;
  for (std::size_t i = 0; i < variant.all.size(); ++i) {
    const PathSpan& span = variant.all[i];
    if (!inRange(wrap, span)) continue;
    Encounter encounter;
    encounter.span = i;
    encounter.moves = movesAgainst(wrap, span);
    const std::size_t numPostures = encounter.moves ? postures_.size() : 1;
    const double reach = encounter.moves ? 1.02 : 1.0;
    for (std::size_t k = 0; k < numPostures && !encounter.penetrates; ++k) {
      if (encounter.moves && !occurs(bits, postures_[k])) continue;
      const auto [P, Q] = ends(wrap, span, postures_[k]);
      if (!(closestApproach(surface, P, Q) < reach)) continue;
      encounter.penetrates = true;
      encounter.way = wayRound(wrap.surface, P, Q);
      encounter.decidedIn = k;
    }
    if (encounter.penetrates) {
      keepContinuous(wrap, span, bits, encounter);
      through.push_back(encounter);
    } else if (passesWrongSide(wrap, span, encounter)) {
      keepContinuous(wrap, span, bits, encounter);
      around.push_back(encounter);
    }
  }
  // A span that stays and goes through the object has it for good.
  const auto stays =
      std::find_if(through.begin(), through.end(), [](const Encounter& e) { return !e.moves; });
  if (stays != through.end()) {
    give(*stays, variant);
    return;
  }
  for (const Encounter& encounter : through) give(encounter, variant);
  if (!through.empty() || around.empty()) return;
  give(*std::min_element(
           around.begin(), around.end(),
           [](const Encounter& a, const Encounter& b) { return a.lengthChange < b.lengthChange; }),
       variant);
}

// Whether a span that never meets the object has to be led round it, because it passes near it on
// the side that the quadrant forbids.
bool SpanSurfaces::passesWrongSide(const CandidateWrap& wrap, const PathSpan& span,
                                   Encounter& encounter) const {
  const PathSurface& surface = path_.surfaces[wrap.surface];
  if (surface.quadrant == WrapQuadrant::all) return false;
  const auto [P, Q] = ends(wrap, span, postures_.front());
  if (!(closestApproach(surface, P, Q) < 2)) return false;
  if (surface.general) return bendsRound(surface, P, Q, encounter);
  encounter.way = wayRound(wrap.surface, P, Q);
  if (surfaceIsOutOfPlay(surface, surface.radius, encounter.way, P, Q)) return false;
  const Span<double> wrapped = surface.isSphere
                                   ? wrapSphere(surface.radius, encounter.way.way, P, Q)
                                   : wrapCylinder(surface.radius, encounter.way.side, P, Q);
  encounter.lengthChange = wrapped.length - (Q - P).norm();
  return wrapped.touches;
}

// The same for a surface without a closed form: its way towards the quadrant touches.
bool SpanSurfaces::bendsRound(const PathSurface& surface, const Vec3<double>& P,
                              const Vec3<double>& Q, Encounter& encounter) const {
  if (std::holds_alternative<TorusSurface>(*surface.general)) return false;
  ChainObject object{*surface.general};
  object.hint = hintTowards(*surface.general, directionOf(surface.quadrant), P, Q);
  ChainMemory memory;
  const ChainPath taut = solveChain(P, Q, {&object, 1}, memory);
  encounter.way.surface = static_cast<std::size_t>(&surface - path_.surfaces.data());
  encounter.lengthChange = taut.length - (Q - P).norm();
  return taut.event != ChainEvent::notFound && taut.numContacts > 0 && taut.isShortest;
}

// Where a path round a cylinder slips off it: never in a posture in which the path occurs.
void SpanSurfaces::keepContinuous(const CandidateWrap& wrap, const PathSpan& span, std::size_t bits,
                                  Encounter& encounter) const {
  const PathSurface& surface = path_.surfaces[wrap.surface];
  if (surface.isSphere || surface.general || !encounter.moves) return;
  const auto angle = [&](const std::pair<Vec3<double>, Vec3<double>>& at) {
    return angleRound(encounter.way.side, at.first, at.second);
  };
  const double decided = angle(ends(wrap, span, postures_[encounter.decidedIn]));
  std::vector<double> angles = {decided};
  for (const Posture& posture : postures_) {
    if (!occurs(bits, posture)) continue;
    const auto at = ends(wrap, span, posture);
    const double nearest = std::min(at.first.head<2>().norm(), at.second.head<2>().norm());
    if (nearest > surface.radius) angles.push_back(angle(at));
  }
  encounter.way.slip = slipAngle(decided, std::move(angles));
}

void SpanSurfaces::give(const Encounter& encounter, PathVariant& variant) {
  PathSpan& span = variant.all[encounter.span];
  const bool isSecond = !encounter.moves && !span.surfaces.empty();
  if (isSecond && !encounter.penetrates) return;
  span.surfaces.push_back(encounter.way);
  span.moves = span.moves || encounter.moves;
}

bool SpanSurfaces::touchesSeveral(const PathSpan& span, std::size_t bits) const {
  if (span.surfaces.size() < 2) return false;
  if (!span.moves) return true;
  return std::any_of(postures_.begin(), postures_.end(), [&](const Posture& posture) {
    return occurs(bits, posture) &&
           std::count_if(span.surfaces.begin(), span.surfaces.end(), [&](const SpanSurface& way) {
             return touches(path_, span, way, posture);
           }) > 1;
  });
}

bool SpanSurfaces::occurs(std::size_t bits, const Posture& posture) const {
  for (std::size_t i = 0; i < path_.conditions.size(); ++i) {
    const CompiledCondition& c = path_.conditions[i];
    const double q = posture.q[static_cast<std::size_t>(c.source.freeIndex)];
    if (isActive(c, c.source.coupling.evaluate(q).value) != (((bits >> i) & 1) != 0)) return false;
  }
  return true;
}

bool SpanSurfaces::inRange(const CandidateWrap& wrap, const PathSpan& span) const {
  return path_.nodes[span.a].point >= wrap.firstPoint &&
         path_.nodes[span.b].point <= wrap.lastPoint;
}

bool SpanSurfaces::movesAgainst(const CandidateWrap& wrap, const PathSpan& span) const {
  return span.moves || path_.nodes[span.a].segment != wrap.segment;
}

// Ends of a span in a wrap's frame.
std::pair<Vec3<double>, Vec3<double>> SpanSurfaces::ends(const CandidateWrap& wrap,
                                                         const PathSpan& span,
                                                         const Posture& posture) const {
  const auto seen = [&](std::size_t node) {
    const Vec3<double> p_G = nodePosition(path_, path_.nodes[node], posture);
    return seenFrom(posture, wrap.segment, wrap.X_SC, p_G);
  };
  return {seen(span.a), seen(span.b)};
}

SpanSurface SpanSurfaces::wayRound(std::size_t index, const Vec3<double>& P,
                                   const Vec3<double>& Q) const {
  const PathSurface& surface = path_.surfaces[index];
  SpanSurface way{index, Side::counterclockwise, Way::shorter, {}};
  if (surface.general) return way;
  if (surface.isSphere) {
    way.way = sphereWay(surface.quadrant, P, Q);
  } else {
    way.side = cylinderSide(surface.quadrant, P, Q);
  }
  return way;
}

}  // namespace bio
