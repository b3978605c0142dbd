#include "bio/path/surface/taut_polygon.h"

#include <cmath>
#include <numbers>

namespace bio {
namespace {

using Eigen::Vector3d;

constexpr int cornersPerLeg = 16;
constexpr int maxCorners = (maxChain + 1) * cornersPerLeg + 1;

Vector3d intoFrame(const ChainObject& object, const Vector3d& p_G) {
  return object.R_GS.transpose() * (p_G - object.p_GS);
}
Vector3d outOfFrame(const ChainObject& object, const Vector3d& p_S) {
  return object.R_GS * p_S + object.p_GS;
}

struct Polygon {
  int numCorners = 0;
  std::array<Vector3d, maxCorners> corner;
  std::array<int, maxCorners> touched;  // the object that a corner lies on, −1: none
};

Polygon throughHints(const Vector3d& P, const Vector3d& Q, std::span<const ChainObject> objects,
                     const std::array<bool, maxChain>& inPlay) {
  Polygon polygon;
  Vector3d from = P;
  const auto add = [&](const Vector3d& p) {
    polygon.touched[static_cast<std::size_t>(polygon.numCorners)] = -1;
    polygon.corner[static_cast<std::size_t>(polygon.numCorners++)] = p;
  };
  add(P);
  const auto lead = [&](const Vector3d& to) {
    for (int i = 1; i <= cornersPerLeg; ++i) add(from + (to - from) * (i / double{cornersPerLeg}));
    from = to;
  };
  for (std::size_t j = 0; j < objects.size(); ++j) {
    if (inPlay[j]) lead(outOfFrame(objects[j], objects[j].hint));
  }
  lead(Q);
  return polygon;
}

// Out of the object that a corner is in, if any.
int pushOut(std::span<const ChainObject> objects, const std::array<bool, maxChain>& inPlay,
            Vector3d& p_G) {
  int touched = -1;
  for (std::size_t j = 0; j < objects.size(); ++j) {
    if (!inPlay[j]) continue;
    const Vector3d p_S = intoFrame(objects[j], p_G);
    std::visit(
        [&](const auto& surface) {
          if (!(surface.value(p_S) < 0)) return;
          p_G = outOfFrame(objects[j], ontoSurface(surface, p_S));
          touched = static_cast<int>(j);
        },
        objects[j].surface);
  }
  return touched;
}

}  // namespace

std::array<ContactMemory, maxChain> tautPolygon(const Vector3d& P, const Vector3d& Q,
                                                std::span<const ChainObject> objects,
                                                const std::array<bool, maxChain>& inPlay,
                                                int rounds) {
  Polygon polygon = throughHints(P, Q, objects, inPlay);
  const auto last = static_cast<std::size_t>(polygon.numCorners - 1);
  // the best factor for a free string; a little less, for the contacts
  const double over = 0.95 * 2 / (1 + std::sin(std::numbers::pi / static_cast<double>(last)));
  for (int round = 0; round < rounds; ++round) {
    const double factor = round < 4 ? 1.0 : over;
    for (std::size_t i = 1; i < last; ++i) {
      Vector3d& p = polygon.corner[i];
      p += factor * (0.5 * (polygon.corner[i - 1] + polygon.corner[i + 1]) - p);
      polygon.touched[i] = pushOut(objects, inPlay, p);
    }
  }
  std::array<ContactMemory, maxChain> contacts;
  for (std::size_t j = 0; j < objects.size(); ++j) {
    ContactMemory& contact = contacts[j];
    std::size_t previous = 0;
    for (std::size_t i = 1; i < last; ++i) {
      if (polygon.touched[i] != static_cast<int>(j)) continue;
      if (contact.passing == Passing::clear) {
        contact.passing = Passing::touching;
        contact.p_SA = intoFrame(objects[j], polygon.corner[i]);
        contact.u_SA = objects[j].R_GS.transpose() *
                       (polygon.corner[i + 1] - polygon.corner[i - 1]).normalized();
      } else {
        contact.arc += (polygon.corner[i] - polygon.corner[previous]).norm();
      }
      previous = i;
    }
  }
  return contacts;
}

}  // namespace bio
