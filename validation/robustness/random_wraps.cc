#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>

#include "bio/path/surface/wrap_cylinder.h"
#include "bio/path/surface/wrap_sphere.h"

// Random wraps against a geodesic that is integrated: from P along the tangent that the wrap
// claims, straight until the surface is touched, over the surface by the geodesic equation
//     x″ = −κ n,   κ = (curvature of the surface along x′)
// in Runge–Kutta steps for what is left of the claimed length, and straight to Q. Whether a path
// touches at all is judged by where the straight line runs.
//     random_wraps COUNT SEED
namespace {

using bio::Span;
using V = bio::Vec3<double>;

struct Surface {
  bool sphere;
  double radius;

  // From the axis or the centre.
  V across(const V& x) const { return sphere ? x : V(x.x(), x.y(), 0); }
  // x″ on a geodesic.
  V bending(const V& x, const V& t) const {
    return -across(t).squaredNorm() / across(x).squaredNorm() * across(x);
  }
};

struct Ray {
  V x, t;
};

// Over the surface by length s.
Ray integrated(const Surface& surface, Ray ray, double s) {
  const auto steps = static_cast<int>(std::ceil(s / surface.radius / 0.02)) + 1;
  const double h = s / steps;
  const auto rate = [&](const Ray& r) { return Ray{r.t, surface.bending(r.x, r.t)}; };
  const auto moved = [](const Ray& r, const Ray& k, double by) {
    return Ray{r.x + by * k.x, r.t + by * k.t};
  };
  for (int i = 0; i < steps; ++i) {
    const Ray a = rate(ray), b = rate(moved(ray, a, h / 2)), c = rate(moved(ray, b, h / 2)),
              d = rate(moved(ray, c, h));
    ray.x += h / 6 * (a.x + 2 * b.x + 2 * c.x + d.x);
    ray.t += h / 6 * (a.t + 2 * b.t + 2 * c.t + d.t);
  }
  return ray;
}

// How far along the ray it comes nearest to the axis or the centre.
double nearest(const Surface& surface, const Ray& ray) {
  return -surface.across(ray.x).dot(surface.across(ray.t)) / surface.across(ray.t).squaredNorm();
}

struct Case {
  Surface surface;
  bool other;  ///< the cylinder's clockwise side, the sphere's longer way
  V P, Q;
  Span<double> span() const {
    return surface.sphere
               ? wrapSphere(surface.radius, other ? bio::Way::longer : bio::Way::shorter, P, Q)
               : wrapCylinder(surface.radius,
                              other ? bio::Side::clockwise : bio::Side::counterclockwise, P, Q);
  }
  // Whether the straight line will not do: it enters the surface, or passes on the wrong side.
  bool mustWrap() const {
    const double s = std::clamp(nearest(surface, {P, Q - P}), 0.0, 1.0);
    if (surface.across(P + s * (Q - P)).norm() < surface.radius) return true;
    if (surface.sphere) return other;
    const double turn = P.x() * Q.y() - P.y() * Q.x();
    return other ? turn > 0 : turn < 0;
  }
};

Case randomCase(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  const auto between = [&](double low, double high) {
    return low * std::pow(high / low, unit(random));
  };
  Case c{{unit(random) < 0.5, between(1e-3, 0.2)}, unit(random) < 0.5, {}, {}};
  for (V* end : {&c.P, &c.Q}) {
    const V direction(normal(random), normal(random), normal(random));
    const double distance = c.surface.radius * (1 + between(1e-4, 30));
    *end = direction * (distance / c.surface.across(direction).norm());
    if (!c.surface.sphere) end->z() = c.surface.radius * 10 * (unit(random) - 0.5);
  }
  return c;
}

struct Worst {
  double end = 0, tangent = 0, touch = 0;  ///< relative to the length, 1, and the radius
  long wrapped = 0, straight = 0, disagreements = 0;
};

void examine(const Case& c, Worst& worst) {
  const Span<double> span = c.span();
  if (span.touches != c.mustWrap()) {
    ++worst.disagreements;
    return;
  }
  ++(span.touches ? worst.wrapped : worst.straight);
  const Ray start{c.P, -span.dL_dP}, back{c.Q, -span.dL_dQ};
  Ray end = start;
  if (span.touches) {
    const double a = nearest(c.surface, start), b = nearest(c.surface, back);
    const Ray contact{c.P + a * start.t, start.t};
    const double gap = std::abs(c.surface.across(contact.x).norm() / c.surface.radius - 1);
    worst.touch = std::max(worst.touch, gap);
    end = integrated(c.surface, contact, span.length - a - b);
    end.x += b * end.t;
  } else {
    end.x += span.length * end.t;
  }
  worst.end = std::max(worst.end, (end.x - c.Q).norm() / span.length);
  worst.tangent = std::max(worst.tangent, (end.t - span.dL_dQ).norm());
}

}  // namespace

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::atol(argv[1]) : 1'000'000;
  std::mt19937_64 random(argc > 2 ? static_cast<std::uint64_t>(std::atoll(argv[2])) : 1);
  Worst worst;
  for (long i = 0; i < count; ++i) examine(randomCase(random), worst);
  fmt::print(
      "{} wraps: {} touch, {} are straight, {} decided otherwise than the straight line says\n",
      count, worst.wrapped, worst.straight, worst.disagreements);
  fmt::print(
      "largest miss of the end {:.1e} of the length, of its tangent {:.1e}, of the surface "
      "{:.1e} of the radius\n",
      worst.end, worst.tangent, worst.touch);
  const bool good = worst.disagreements == 0 && worst.end < 1e-6 && worst.tangent < 1e-6 &&
                    worst.touch < 1e-6 && worst.wrapped > count / 4 && worst.straight > count / 20;
  return good ? 0 : 1;
}
