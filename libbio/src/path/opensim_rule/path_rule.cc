#include "bio/path/opensim_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "path/opensim_rule/ellipsoid_rule.h"
#include "path/path_reach.h"

namespace bio::opensim_rule {
namespace {

using Eigen::Vector3d;

constexpr int maxRounds = 8;
constexpr double enough = 5e-4;  // [m]

/// A point of the present path in the ground: one of the muscle's, or one of two on an object.
struct Point {
  Vector3d p;
  std::size_t span;     ///< which of the muscle's spans begins here or contains it
  int object = -1;      ///< the surface it lies on
  double arcAfter = 0;  ///< length over the object to the next point, of the first of two
};

enum class Outcome { none, inside, wrapped, mandatory };
struct Tried {
  Outcome outcome = Outcome::none;
  OpenSimWrap wrap;  ///< in the ground
};

/// Where a line comes nearest to the z-axis; its place on the line from P (0) to Q (1).
struct Nearest {
  Vector3d point;
  double share;
};
Nearest nearestToAxis(const Vector3d& P, const Vector3d& Q) {
  const Eigen::Vector2d p = P.head<2>(), d = (Q - P).head<2>();
  const double share = -p.dot(d) / d.squaredNorm();
  return {P + share * (Q - P), share};
}

/// Whether a cylinder may be wrapped: where the line cuts it, or where it passes beyond it, seen
/// from the quadrant.
Outcome mayWrap(const PathSurface& cylinder, const Vector3d& P, const Vector3d& Q) {
  const double r = cylinder.radius;
  if (P.head<2>().norm() < r || Q.head<2>().norm() < r) return Outcome::inside;
  const Nearest nearest = nearestToAxis(P, Q);
  const bool isCut = nearest.point.head<2>().norm() < r && nearest.share > 0 && nearest.share < 1;
  const Vector3d side = directionOf(cylinder.quadrant);
  if (!(side.norm() > 0)) return isCut ? Outcome::mandatory : Outcome::none;
  const bool isPOnSide = P.dot(side) > 0, isQOnSide = Q.dot(side) > 0;
  if (!isPOnSide && !isQOnSide) return Outcome::wrapped;
  if (isCut) return Outcome::mandatory;
  const bool isBeyond = isPOnSide != isQOnSide && !(nearest.point.dot(side) > 0);
  return isBeyond ? Outcome::wrapped : Outcome::none;
}

/// A point from which tangents go to a circle about the z-axis: to the contact ahead of it
/// counter-clockwise, and to the one behind.
struct Tangents {
  Vector3d ahead, behind;
  double length;  ///< seen along z
  Tangents(double r, const Vector3d& p) {
    const double far = p.head<2>().norm();
    const Vector3d u(p.x() / far, p.y() / far, 0), v(-u.y(), u.x(), 0);
    const double sine = r / far;
    const double cosine = std::sqrt(1 - sine * sine);
    ahead = r * (sine * u + cosine * v);
    behind = r * (sine * u - cosine * v);
    length = far * cosine;
  }
};

/// Whether OpenSim goes round counter-clockwise: by which of the four contacts lie on the
/// quadrant's side.
bool goesCounterclockwise(const PathSurface& cylinder, const Tangents& p, const Tangents& q) {
  const Vector3d side = directionOf(cylinder.quadrant);
  const auto angle = [](const Vector3d& a, const Vector3d& b) {
    return std::acos(std::clamp(a.dot(b) / (a.norm() * b.norm()), -1.0, 1.0));
  };
  if (!(side.norm() > 0)) return angle(p.ahead, q.behind) < angle(p.behind, q.ahead);
  const bool isAhead = p.ahead.dot(side) > 0, isBehind = p.behind.dot(side) > 0;
  if (isAhead != isBehind) return isAhead;
  if (q.ahead.dot(side) > 0) return false;
  if (isAhead || q.behind.dot(side) > 0) return true;
  return angle(p.ahead, q.behind) > angle(p.behind, q.ahead);
}

/// The angle between the contacts counts as wrapped even where they lie past each other.
Tried overCylinder(const PathSurface& cylinder, const Vector3d& P, const Vector3d& Q) {
  const Outcome outcome = mayWrap(cylinder, P, Q);
  if (outcome != Outcome::mandatory && outcome != Outcome::wrapped) return {outcome, {}};
  const double r = cylinder.radius;
  const Tangents p(r, P), q(r, Q);
  const bool isForward = goesCounterclockwise(cylinder, p, q);
  Vector3d A = isForward ? p.ahead : p.behind, B = isForward ? q.behind : q.ahead;
  double angle = std::acos(std::clamp(A.dot(B) / (r * r), -1.0, 1.0));
  const Vector3d away = (A - Vector3d(P.x(), P.y(), 0)) + (B - Vector3d(Q.x(), Q.y(), 0));
  const bool isConstrained = directionOf(cylinder.quadrant).norm() > 0;
  if (isConstrained && (A + B).dot(away) < 0) angle = 2 * std::numbers::pi - angle;
  const double rise = (Q.z() - P.z()) / (p.length + r * angle + q.length);
  A.z() = P.z() + rise * p.length;
  B.z() = Q.z() - rise * q.length;
  if (std::abs(A.z()) > cylinder.halfLength && std::abs(B.z()) > cylinder.halfLength) return {};
  return {outcome, {A, B, std::hypot(r * angle, B.z() - A.z())}};
}

Tried overSphere(const PathSurface& sphere, const SpanSurface& way, const Vector3d& P,
                 const Vector3d& Q) {
  const double r = sphere.radius;
  if (P.norm() < r || Q.norm() < r) return {Outcome::inside, {}};
  const auto contact = wrapSphereContact(r, way.way, P, Q);
  if (!(contact.angle > 0)) return {};
  const bool isCut = closestApproach(sphere, P, Q) < 1;
  return {isCut ? Outcome::mandatory : Outcome::wrapped,
          {contact.p_CA, contact.p_CB, r * contact.angle}};
}

class Path {
 public:
  Path(const CompiledPath& path, const Posture& posture) : path_(path), posture_(posture) {
    const auto q = Eigen::Map<const Eigen::VectorXd>(posture.q.data(),
                                                     static_cast<Eigen::Index>(posture.q.size()));
    variant_ = &activeVariant(path, q);
    for (std::size_t i = 0; i < variant_->all.size(); ++i) {
      points_.push_back({position(variant_->all[i].a), i});
    }
    points_.push_back({position(variant_->all.back().b), variant_->all.size()});
  }

  double solve() {
    std::vector<std::size_t> order(path_.surfaces.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return path_.surfaces[a].wrap < path_.surfaces[b].wrap;
    });
    double last = std::numeric_limits<double>::infinity();
    const int rounds = order.size() < 2 ? 1 : maxRounds;
    for (int round = 0; round < rounds; ++round) {
      std::vector<Outcome> outcomes;
      for (const std::size_t surface : order) outcomes.push_back(lead(surface));
      const double now = length();
      if (std::abs(now - last) < enough) break;
      last = now;
      if (round == 0 && order.size() > 1 && outcomes[0] == Outcome::none &&
          outcomes[1] == Outcome::inside) {
        std::swap(order[0], order[1]);
        for (const std::size_t surface : order) remove(surface);
      }
    }
    return length();
  }

 private:
  Vector3d position(std::size_t node) const {
    return nodePosition(path_, path_.nodes[node], posture_);
  }

  const SpanSurface* wayOver(std::size_t span, std::size_t surface) const {
    if (span >= variant_->all.size()) return nullptr;
    for (const SpanSurface& way : variant_->all[span].surfaces) {
      if (way.surface == surface) return &way;
    }
    return nullptr;
  }

  Tried tryOver(std::size_t surface, const SpanSurface& way, const Vector3d& P_G,
                const Vector3d& Q_G) const {
    const PathSurface& s = path_.surfaces[surface];
    const Vector3d P = seenFrom(posture_, s.segment, s.X_SC, P_G);
    const Vector3d Q = seenFrom(posture_, s.segment, s.X_SC, Q_G);
    Tried tried;
    if (s.general) {
      const auto& ellipsoid = std::get<EllipsoidSurface>(*s.general);
      const auto wrap = openSimOverEllipsoid(ellipsoid.semiAxes(), s.quadrant, P, Q);
      const auto isInside = [&](const Vector3d& p) { return ellipsoid.value(p) < -5e-5; };
      if (!wrap) return {isInside(P) || isInside(Q) ? Outcome::inside : Outcome::none, {}};
      tried = {Outcome::mandatory, *wrap};
    } else {
      tried = s.isSphere ? overSphere(s, way, P, Q) : overCylinder(s, P, Q);
    }
    const Placement<double> X_GC = posture_.placements[s.segment] * s.X_SC;
    for (Vector3d* p : {&tried.wrap.first, &tried.wrap.last}) *p = X_GC.R * *p + X_GC.p;
    return tried;
  }

  void remove(std::size_t surface) {
    std::erase_if(points_, [&](const Point& p) { return p.object == static_cast<int>(surface); });
  }

  // Over the first segment that it cuts, or the one that it lengthens least.
  Outcome lead(std::size_t surface) {
    remove(surface);
    Outcome last = Outcome::none;
    Tried best;
    std::size_t at = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      const Point &a = points_[i], &b = points_[i + 1];
      if (a.object >= 0 && a.object == b.object) continue;
      const SpanSurface* way = wayOver(a.span, surface);
      if (way == nullptr) continue;
      const Tried tried = tryOver(surface, *way, a.p, b.p);
      last = tried.outcome;
      if (tried.outcome == Outcome::mandatory) {
        best = tried;
        at = i;
        break;
      }
      if (tried.outcome != Outcome::wrapped) continue;
      const double longer = (tried.wrap.first - a.p).norm() + tried.wrap.length +
                            (b.p - tried.wrap.last).norm() - (b.p - a.p).norm();
      if (!(longer < least)) continue;
      least = longer;
      best = tried;
      at = i;
    }
    if (best.outcome == Outcome::none) return last;
    const int object = static_cast<int>(surface);
    const std::size_t span = points_[at].span;
    const auto where = points_.begin() + static_cast<std::ptrdiff_t>(at) + 1;
    points_.insert(where, {Point{best.wrap.first, span, object, best.wrap.length},
                           Point{best.wrap.last, span, object, 0}});
    return last;
  }

  double length() const {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      const Point &a = points_[i], &b = points_[i + 1];
      const bool isArc = a.object >= 0 && a.object == b.object;
      sum += isArc ? a.arcAfter : (b.p - a.p).norm();
    }
    return sum;
  }

  const CompiledPath& path_;
  const Posture& posture_;
  const PathVariant* variant_;
  std::vector<Point> points_;
};

}  // namespace
}  // namespace bio::opensim_rule

namespace bio {

std::optional<double> openSimLength(const CompiledPath& path, const Posture& posture) {
  if (path.function) return std::nullopt;
  for (const PathSurface& surface : path.surfaces) {
    if (surface.general && !std::holds_alternative<EllipsoidSurface>(*surface.general)) {
      return std::nullopt;
    }
  }
  return opensim_rule::Path(path, posture).solve();
}

}  // namespace bio
