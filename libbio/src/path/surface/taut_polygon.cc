#include "bio/path/surface/taut_polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bio {
namespace {

using Eigen::Vector3d;

constexpr int cornersPerLeg = 16;
constexpr double roughness = 4e-3;  // over the rounds: moves of this share of the whole are small
constexpr int finer = 8;            // pieces of a side near a contact
constexpr int maxCorners = 4 * (maxChain + 1) * cornersPerLeg;

struct Polygon {
  int numCorners = 0;
  std::array<Vector3d, maxCorners> corner;
  std::array<int, maxCorners> touched;  // the object that a corner lies on, −1: none
  std::array<double, maxCorners> side;  // length that the side after a corner aims at, relative

  void add(const Vector3d& p, int on) {
    touched[static_cast<std::size_t>(numCorners)] = on;
    side[static_cast<std::size_t>(numCorners)] = 1;
    corner[static_cast<std::size_t>(numCorners++)] = p;
  }
};

Polygon throughHints(const Vector3d& P, const Vector3d& Q, std::span<const ChainObject> objects,
                     const std::array<bool, maxChain>& inPlay) {
  Polygon polygon;
  Vector3d from = P;
  polygon.add(P, -1);
  const auto lead = [&](const Vector3d& to) {
    for (int i = 1; i <= cornersPerLeg; ++i) {
      polygon.add(from + (to - from) * (i / double{cornersPerLeg}), -1);
    }
    from = to;
  };
  for (std::size_t j = 0; j < objects.size(); ++j) {
    if (inPlay[j]) lead(objects[j].outOfFrame(objects[j].hint));
  }
  lead(Q);
  return polygon;
}

// Beyond this distance from its origin nothing is in a surface; infinite for a cylinder.
double reachOf(const Surface& surface) {
  if (const auto* sphere = std::get_if<SphereSurface>(&surface)) return sphere->radius();
  if (const auto* ellipsoid = std::get_if<EllipsoidSurface>(&surface)) {
    return ellipsoid->semiAxes().maxCoeff();
  }
  if (const auto* torus = std::get_if<TorusSurface>(&surface)) {
    return torus->ringRadius() + torus->tubeRadius();
  }
  return std::numeric_limits<double>::infinity();
}

// The point of a surface nearest to a point inside; of ellipsoids and tori one near it.
template <class S>
Vector3d outOf(const S& surface, const Vector3d& inside) {
  return ontoSurface(surface, inside);
}
Vector3d outOf(const SphereSurface& sphere, const Vector3d& inside) {
  return inside * (sphere.radius() / inside.norm());
}
Vector3d outOf(const CylinderSurface& cylinder, const Vector3d& inside) {
  const double stretch = cylinder.radius() / inside.head<2>().norm();
  return {inside.x() * stretch, inside.y() * stretch, inside.z()};
}

// The objects in play.
class Obstacles {
 public:
  Obstacles(std::span<const ChainObject> objects, const std::array<bool, maxChain>& inPlay) {
    for (std::size_t j = 0; j < objects.size(); ++j) {
      if (!inPlay[j]) continue;
      obstacles_[count_++] = {&objects[j], static_cast<int>(j), reachOf(objects[j].surface)};
    }
  }

  // Out of the object that a corner is in, if any: which one, or −1.
  int pushOut(Vector3d& p_G) const {
    int touched = -1;
    for (std::size_t k = 0; k < count_; ++k) {
      const Obstacle& each = obstacles_[k];
      const ChainObject& object = *each.object;
      if ((p_G - object.p_GS).squaredNorm() > each.reach * each.reach) continue;
      const Vector3d p_S = object.intoFrame(p_G);
      std::visit(
          [&](const auto& surface) {
            if (!(surface.value(p_S) < 0)) return;
            p_G = object.outOfFrame(outOf(surface, p_S));
            touched = each.number;
          },
          object.surface);
    }
    return touched;
  }

 private:
  struct Obstacle {
    const ChainObject* object;
    int number;
    double reach;
  };
  std::array<Obstacle, maxChain> obstacles_;
  std::size_t count_ = 0;
};

// Moves all corners, until none moves by more than `near` or for so many rounds.
void relax(const Obstacles& obstacles, int rounds, double near, Polygon& polygon) {
  const auto last = static_cast<std::size_t>(polygon.numCorners - 1);
  // a corner's place between its neighbours that its sides aim at
  std::array<double, maxCorners> share;
  for (std::size_t i = 1; i < last; ++i) {
    share[i] = polygon.side[i - 1] / (polygon.side[i - 1] + polygon.side[i]);
  }
  // the best factor for a free string of equal sides; a little less, for the contacts
  const double over = 0.95 * 2 / (1 + std::sin(std::numbers::pi / static_cast<double>(last)));
  for (int round = 0; round < rounds; ++round) {
    const double factor = round < 4 ? 1.0 : over;
    double farthest = 0;
    for (std::size_t i = 1; i < last; ++i) {
      Vector3d& p = polygon.corner[i];
      const Vector3d was = p;
      const Vector3d& before = polygon.corner[i - 1];
      p += factor * (before + share[i] * (polygon.corner[i + 1] - before) - p);
      polygon.touched[i] = obstacles.pushOut(p);
      farthest = std::max(farthest, (p - was).squaredNorm());
    }
    if (farthest < near * near) return;
  }
}

// The same with shorter sides near the contacts, for those that are smaller than a side.
Polygon refined(const Polygon& coarse) {
  Polygon fine;
  fine.add(coarse.corner[0], -1);
  const auto last = static_cast<std::size_t>(coarse.numCorners - 1);
  for (std::size_t i = 0; i < last; ++i) {
    const bool isNear = coarse.touched[i] >= 0 || coarse.touched[i + 1] >= 0;
    const bool hasRoom = fine.numCorners + finer + static_cast<int>(last - i) < maxCorners;
    const int pieces = isNear && hasRoom ? finer : 1;
    const Vector3d side = coarse.corner[i + 1] - coarse.corner[i];
    for (int k = 1; k <= pieces; ++k) {
      fine.side[static_cast<std::size_t>(fine.numCorners - 1)] =
          std::max(side.norm(), 1e-9) / pieces;
      fine.add(coarse.corner[i] + side * (static_cast<double>(k) / pieces), -1);
    }
  }
  return fine;
}

}  // namespace

std::array<ContactMemory, maxChain> tautPolygon(const Vector3d& P, const Vector3d& Q,
                                                std::span<const ChainObject> objects,
                                                const std::array<bool, maxChain>& inPlay,
                                                int rounds) {
  const Obstacles obstacles(objects, inPlay);
  Polygon polygon = throughHints(P, Q, objects, inPlay);
  const double near = roughness / rounds * (Q - P).norm();
  relax(obstacles, rounds, near, polygon);
  polygon = refined(polygon);
  relax(obstacles, rounds, near, polygon);
  const auto last = static_cast<std::size_t>(polygon.numCorners - 1);
  std::array<ContactMemory, maxChain> contacts;
  for (std::size_t j = 0; j < objects.size(); ++j) {
    ContactMemory& contact = contacts[j];
    std::size_t previous = 0;
    for (std::size_t i = 1; i < last; ++i) {
      if (polygon.touched[i] != static_cast<int>(j)) continue;
      if (contact.passing == Passing::clear) {
        contact.passing = Passing::touching;
        contact.p_SA = objects[j].intoFrame(polygon.corner[i]);
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
