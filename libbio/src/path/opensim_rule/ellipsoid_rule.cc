#include "path/opensim_rule/ellipsoid_rule.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bio::opensim_rule {
namespace {

using Eigen::Vector3d;

constexpr double leastBlend = 0.7073, mostBlend = 0.9, endBlend = 0.3;
constexpr int numSamples = 300;
constexpr double chord = 1e-3;  // [m]

/// The closest point of an ellipsoid, or of its section with the plane x_flat = const taken as the
/// principal one: x_i = a_i² u_i/(a_i² + t) with the largest root t of Σ (x_i/a_i)² = 1.
Vector3d closestPoint(const Vector3d& a, const Vector3d& u, int flat = -1) {
  if (flat < 0) {
    double narrowest = 0;
    for (int i = 0; i < 3; ++i) {
      const double sum = a.sum() - a[i];
      if (std::abs(u[i]) <= 2e-13 && (flat < 0 || sum < narrowest)) {
        flat = i;
        narrowest = sum;
      }
    }
  }
  double low = -1e300;
  for (int i = 0; i < 3; ++i) {
    if (i == flat) continue;
    low = std::max(low, -a[i] * a[i] + a[i] * std::abs(u[i]));
  }
  // the sum falls and is convex there: Newton's steps from its left never pass the root
  double t = low;
  for (int step = 0; step < 100; ++step) {
    double excess = -1, slope = 0;
    for (int i = 0; i < 3; ++i) {
      if (i == flat) continue;
      const double perSum = 1 / (a[i] * a[i] + t);
      const double x = a[i] * u[i] * perSum;
      excess += x * x;
      slope -= 2 * x * x * perSum;
    }
    if (!(excess > 1e-15) || !(slope < 0)) break;
    t -= excess / slope;
  }
  Vector3d x = u;
  for (int i = 0; i < 3; ++i) {
    if (i != flat) x[i] = a[i] * a[i] * u[i] / (a[i] * a[i] + t);
  }
  return x;
}

/// Where the chord cuts the ellipsoid: r1 nearer to Q in OpenSim's order of roots.
struct Cut {
  Vector3d r1, r2;
};
std::optional<Cut> cutOf(const Vector3d& a, const Vector3d& p1, const Vector3d& p2) {
  const Vector3d d = p1 - p2;
  const Vector3d f1 = d.cwiseQuotient(a), f2 = p2.cwiseQuotient(a);
  const double aa = f1.dot(f1), bb = 2 * f1.dot(f2), cc = f2.dot(f2) - 1;
  const double square = bb * bb - 4 * aa * cc;
  if (square < 0) return std::nullopt;
  const double l1 = (-bb + std::sqrt(square)) / (2 * aa), l2 = (-bb - std::sqrt(square)) / (2 * aa);
  if (!(0 < l1 && l1 < 1) || !(0 < l2 && l2 < 1)) return std::nullopt;
  return Cut{p2 + l1 * d, p2 + l2 * d};
}

/// The point of the surface that fixes the plane, before the quadrant has a say; how much of it is
/// the mean of closest points; the cosine that decided.
struct Direction {
  Vector3d c;
  double ofMean = -1;  ///< < 0: not used
  double cosine = 0;
};

Vector3d meanOfClosest(const Vector3d& a, const Cut& cut) {
  const Vector3d along = cut.r2 - cut.r1;
  Vector3d sum = Vector3d::Zero();
  for (int i = 1; i < numSamples - 1; ++i) {
    const Vector3d on = cut.r1 + along * (static_cast<double>(i) / numSamples);
    sum += (closestPoint(a, on) - on).normalized();
  }
  return closestPoint(a, cut.r1 + 0.5 * along + sum.normalized());
}

Direction directionOver(const Vector3d& a, const Vector3d& p1, const Vector3d& p2, const Cut& cut) {
  const Vector3d cosines = (p2 - p1).normalized().cwiseAbs();
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (cosines[i] > cosines[axis]) axis = i;
  }
  const Vector3d along = cut.r2 - cut.r1;
  const double share = -cut.r1[axis] / along[axis];
  Direction direction;
  direction.cosine = cosines[axis];
  if (direction.cosine > leastBlend) {
    double faded = 1;
    if (share < 0 || share > 1) {
      faded = 0;
    } else if (share < endBlend) {
      faded = share / endBlend;
    } else if (share > 1 - endBlend) {
      faded = (1 - share) / endBlend;
    }
    direction.cosine = leastBlend + faded * (direction.cosine - leastBlend);
  }
  if (direction.cosine > leastBlend) {
    direction.c = closestPoint(a, cut.r1 + share * along, axis);
  }
  if (direction.cosine < mostBlend) {
    const Vector3d mean = meanOfClosest(a, cut);
    if (direction.cosine <= leastBlend) {
      direction.c = mean;
      direction.ofMean = 1;
    } else {
      const double ofAxis = (direction.cosine - leastBlend) / (mostBlend - leastBlend);
      direction.c = closestPoint(a, ofAxis * direction.c + (1 - ofAxis) * mean);
      direction.ofMean = 1 - ofAxis;
    }
  }
  return direction;
}

/// c on the quadrant's side.
Vector3d toQuadrant(const Vector3d& a, const Vector3d& side, const Direction& direction) {
  Vector3d c = direction.c;
  if (!(side.norm() > 0)) return c;
  int axis = 0;
  side.cwiseAbs().maxCoeff(&axis);
  if (c[axis] * side[axis] > 0 || (c[axis] == 0 && side[axis] > 0)) return c;
  c[axis] = -c[axis];
  double ofMean = direction.ofMean < 0
                      ? 1 - (direction.cosine - leastBlend) / (mostBlend - leastBlend)
                      : direction.ofMean;
  ofMean = std::min(ofMean, 1.0);
  if (ofMean > 0) {
    c[axis] -= ofMean * c[axis];  // towards the middle of both, which is 0
    c = closestPoint(a, c);
  }
  return c;
}

/// The plane's section, an ellipse, in coordinates in which it is the unit circle.
struct Section {
  Vector3d centre, e1, e2;  ///< x = centre + e1 cos φ + e2 sin φ, e1 ⟂ e2 in the scaled space
  Section(const Vector3d& a, const Vector3d& p1, const Vector3d& normal) {
    // y = x/a: the unit sphere, and the plane m·y = h
    const Vector3d m = normal.cwiseProduct(a);
    const double h = normal.dot(p1) / m.norm();
    const Vector3d unit = m.normalized();
    const double radius = std::sqrt(std::max(0.0, 1 - h * h));
    const Vector3d u = unit.unitOrthogonal(), v = unit.cross(u);
    centre = (h * unit).cwiseProduct(a);
    e1 = (radius * u).cwiseProduct(a);
    e2 = (radius * v).cwiseProduct(a);
    scale = a;
    perRadius = 1 / radius;
    axis1 = u;
    axis2 = v;
    middle = h * unit;
  }
  double angleOf(const Vector3d& x) const {
    const Vector3d y = x.cwiseQuotient(scale) - middle;
    return std::atan2(y.dot(axis2), y.dot(axis1));
  }
  /// Half the angle that the two tangents from x span at the centre.
  double halfAngle(const Vector3d& x) const {
    const double far = (x.cwiseQuotient(scale) - middle).norm() * perRadius;
    return std::acos(std::min(1.0, 1 / far));
  }
  Vector3d at(double angle) const { return centre + e1 * std::cos(angle) + e2 * std::sin(angle); }

 private:
  Vector3d scale, axis1, axis2, middle;
  double perRadius;
};

/// The difference of two angles in (−π, π].
double turn(double from, double to) {
  return std::remainder(to - from, 2 * std::numbers::pi);
}

/// Sum of chords from r1 to r2, equal angles apart as seen from where the longest component of the
/// plane's normal meets it from the centre.
double sumOfChords(const Vector3d& a, const Vector3d& r1, const Vector3d& r2,
                   const Vector3d& normal, bool isLongWay) {
  const double straight = (r1 - r2).norm();
  const int n = std::min(499, static_cast<int>(straight / chord));
  if (straight < chord || n <= 0) return straight;
  int longest = 0;
  normal.cwiseAbs().maxCoeff(&longest);
  const Vector3d from = Vector3d::Unit(longest) * (normal.dot(r1) / normal[longest]);
  const Vector3d x = (r1 - from).normalized();
  const Vector3d z = x.cross((r2 - from).normalized()).normalized();
  const Vector3d y = z.cross(x);
  const double whole = std::acos(std::clamp(x.dot((r2 - from).normalized()), -1.0, 1.0));
  const double step = (isLongWay ? whole - 2 * std::numbers::pi : whole) / n;
  Vector3d last = r1;
  double sum = 0;
  for (int i = 1; i <= n; ++i) {
    Vector3d next = r2;
    if (i < n) {
      const Vector3d r = x * std::cos(i * step) + y * std::sin(i * step);
      const Vector3d f1 = r.cwiseQuotient(a), f2 = from.cwiseQuotient(a);
      const double aa = f1.dot(f1), bb = f1.dot(f2), cc = f2.dot(f2) - 1;
      next = from + r * ((-bb + std::sqrt(bb * bb - aa * cc)) / aa);
    }
    sum += (next - last).norm();
    last = next;
  }
  return sum;
}

}  // namespace

std::optional<OpenSimWrap> openSimOverEllipsoid(const Vector3d& semiAxes, WrapQuadrant quadrant,
                                                const Vector3d& P, const Vector3d& Q) {
  const double factor = 3 / semiAxes.sum();
  const Vector3d a = factor * semiAxes, p1 = factor * P, p2 = factor * Q;
  const double in1 = p1.cwiseQuotient(a).squaredNorm() - 1;
  const double in2 = p2.cwiseQuotient(a).squaredNorm() - 1;
  if (in1 < -1e-4 || in2 < -1e-4) return std::nullopt;
  if (std::abs(p1.normalized().dot(p2.normalized()) - 1) < 1e-4) return std::nullopt;
  const std::optional<Cut> cut = cutOf(a, p1, p2);
  if (!cut) return std::nullopt;
  const Vector3d side = directionOf(quadrant);
  const Vector3d c = toQuadrant(a, side, directionOver(a, p1, p2, *cut));
  const Vector3d normal = (p1 - p2).cross(p1 - c).normalized();
  const Section section(a, p1, normal);
  // of the two tangents from either end the one that is nearer to c
  const double atC = section.angleOf(c);
  const auto tangent = [&](const Vector3d& p, double in) {
    if (std::abs(in) < 1e-4) return p;
    const double middle = section.angleOf(p), half = section.halfAngle(p);
    const bool isFirst = std::abs(turn(atC, middle + half)) < std::abs(turn(atC, middle - half));
    return section.at(isFirst ? middle + half : middle - half);
  };
  OpenSimWrap wrap;
  wrap.first = tangent(p1, in1) / factor;
  wrap.last = tangent(p2, in2) / factor;
  // the way through c, unless that of less than half a turn is asked for by nobody
  bool isLongWay = false;
  if (side.norm() > 0 && (wrap.first - wrap.last).norm() > 2 * chord) {
    const double from = section.angleOf(factor * wrap.first);
    const double to = section.angleOf(factor * wrap.last);
    const double way = turn(from, to) > 0 ? 1 : -1;
    const Vector3d first = section.at(from + way * 1e-3) - factor * wrap.first;
    const Vector3d last = section.at(to - way * 1e-3) - factor * wrap.last;
    isLongWay = first.dot(p1 - factor * wrap.first) > 0 || last.dot(p2 - factor * wrap.last) > 0;
  }
  wrap.length = sumOfChords(semiAxes, wrap.first, wrap.last, normal, isLongWay);
  return wrap;
}

}  // namespace bio::opensim_rule
