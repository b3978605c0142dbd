#include "bio/path/path_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/path/compiled_path.h"
#include "bio/path/surface/chain_change.h"

namespace bio {
namespace {

// Beyond its ends a cylinder does not hold the string.
bool isBeyondEnds(const PathSurface& surface, const ChainObject& object,
                  const ChainContact& contact) {
  if (surface.isSphere || surface.general) return false;
  return std::abs(object.intoFrame(contact.A).z()) > surface.halfLength &&
         std::abs(object.intoFrame(contact.B).z()) > surface.halfLength;
}

// A search that ended where it should from a start that was near.
bool isPlain(const ChainPath& taut) {
  return taut.event == ChainEvent::none && taut.isShortest;
}

}  // namespace

Surface surfaceOf(const PathSurface& surface, double radius) {
  if (surface.general) return *surface.general;
  if (surface.isSphere) return SphereSurface(radius);
  return CylinderSurface(radius);
}

PlacedChain placeChain(const CompiledPath& path, const PathChain& chain,
                       const ChainPlacements& X_GC, const double* radii) {
  PlacedChain placed;
  placed.count = static_cast<std::size_t>(chain.count);
  for (std::size_t j = 0; j < placed.count; ++j) {
    const PathChain::Member& member = chain.members[j];
    const PathSurface& surface = path.surfaces[member.surface];
    const double radius = radii != nullptr ? radii[surface.wrap] : surface.radius;
    placed.objects[j] = {surfaceOf(surface, radius), X_GC[j].R, X_GC[j].p, member.hint};
  }
  return placed;
}

ChainPath tautChain(const CompiledPath& path, const PathChain& chain, const PlacedChain& placed,
                    const ChainPlacements& X_GC, const Vec3<double>& P, const Vec3<double>& Q,
                    unsigned& used) {
  unsigned leftOut = 0;
  for (std::size_t j = 0; j < placed.count; ++j) {
    leftOut |= ((used >> chain.members[j].surface) & 1u) << j;
  }
  ChainStarts::Start start;
  if (chain.starts) start = chain.starts->startFor(placed.all(), X_GC, P, Q);
  ChainPath taut;
  for (;;) {
    ChainMemory memory = start.moved;
    taut = solveChain(P, Q, placed.all(), memory, leftOut);
    if (start.kept != nullptr && !isPlain(taut)) {
      memory = *start.kept;
      taut = solveChain(P, Q, placed.all(), memory, leftOut);
    }
    if (taut.event == ChainEvent::notFound) {
      throw std::domain_error(fmt::format(
          "no taut string is found from ({}, {}, {}) to ({}, {}, {}) m over wrap object {} of its "
          "path{}",
          P[0], P[1], P[2], Q[0], Q[1], Q[2], path.surfaces[chain.members[0].surface].wrap + 1,
          placed.count > 1 ? " and others" : ""));
    }
    bool holds = true;
    for (std::size_t i = 0; i < static_cast<std::size_t>(taut.numContacts); ++i) {
      const ChainContact& contact = taut.contacts[i];
      const auto j = static_cast<std::size_t>(contact.object);
      if (!isBeyondEnds(path.surfaces[chain.members[j].surface], placed.objects[j], contact)) {
        continue;
      }
      leftOut |= 1u << j;
      holds = false;
    }
    if (holds) break;
  }
  for (std::size_t j = 0; j < placed.count; ++j) {
    if (taut.passing[j] == Passing::touching) used |= 1u << chain.members[j].surface;
  }
  return taut;
}

SpanToSecondOrder<double> spanOver(const CompiledPath& path, const PathChain& chain,
                                   const Vec3<double>& p_SP, const Vec3<double>& p_SQ,
                                   unsigned& used, const double* radii) {
  ChainPlacements X_SC;
  for (std::size_t j = 0; j < static_cast<std::size_t>(chain.count); ++j) {
    X_SC[j] = path.surfaces[chain.members[j].surface].X_SC;
  }
  const PlacedChain placed = placeChain(path, chain, X_SC, radii);
  const ChainPath taut = tautChain(path, chain, placed, X_SC, p_SP, p_SQ, used);
  const EndHessian ends = ChainChanges(taut).ends();
  return {{taut.length, -taut.tangentP(), taut.tangentQ(), taut.numContacts > 0},
          {ends.PP, ends.PQ, ends.QQ}};
}

std::vector<Vec3<double>> chainPoints(const PlacedChain& placed, const ChainPath& taut,
                                      double step) {
  std::vector<Vec3<double>> points;
  for (std::size_t i = 0; i < static_cast<std::size_t>(taut.numContacts); ++i) {
    const ChainContact& contact = taut.contacts[i];
    const ChainObject& object = placed.objects[static_cast<std::size_t>(contact.object)];
    const double bend = std::max(
        {std::abs(contact.atA.normal), std::abs(contact.atB.normal), 1 / sizeOf(object.surface)});
    const int pieces = std::clamp(static_cast<int>(std::ceil(contact.arc * bend / step)), 1, 1000);
    const Vec3<double> x = object.intoFrame(contact.A);
    const Vec3<double> u = object.R_GS.transpose() * contact.atA.u;
    for (int k = 0; k <= pieces; ++k) {
      const double arc = contact.arc * k / pieces;
      points.push_back(object.outOfFrame(shootGeodesic(object.surface, x, u, arc).x));
    }
  }
  return points;
}

}  // namespace bio
