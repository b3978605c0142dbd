#include "bio/path/surface/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace bio {
namespace {

using Eigen::Vector3d;

void requirePositive(const char* what, double value) {
  if (!(value > 0)) {
    throw std::invalid_argument(fmt::format("{} is {} m, must be > 0", what, value));
  }
}

// Where on the segment from x to y, 0 … 1: the forms of g are quadratic along a line.
template <class S>
double lowestShare(const S& surface, const Vector3d& x, const Vector3d& y) {
  const Vector3d d = y - x;
  const double bend = d.dot(surface.hessianTimes(x, d));
  const double slope = d.dot(surface.gradient(x));
  if (!(bend > 0)) return 0.5;
  return std::clamp(-slope / bend, 0.0, 1.0);
}

double lowestShare(const TorusSurface& surface, const Vector3d& x, const Vector3d& y) {
  constexpr int numSamples = 32;
  const Vector3d d = y - x;
  double best = 0, least = surface.value(x);
  for (int i = 1; i <= numSamples; ++i) {
    const double share = static_cast<double>(i) / numSamples;
    const double value = surface.value(x + share * d);
    if (value < least) {
      least = value;
      best = share;
    }
  }
  // Newton's steps towards slope 0, while they lead downwards
  for (int i = 0; i < 8; ++i) {
    const Vector3d p = x + best * d;
    const double bend = d.dot(surface.hessianTimes(p, d));
    if (!(bend > 0)) break;
    const double share = std::clamp(best - d.dot(surface.gradient(p)) / bend, 0.0, 1.0);
    if (!(surface.value(x + share * d) < surface.value(p))) break;
    best = share;
  }
  return best;
}

}  // namespace

SphereSurface::SphereSurface(double radius) : radius_(radius) {
  requirePositive("a sphere's radius", radius);
}

CylinderSurface::CylinderSurface(double radius) : radius_(radius) {
  requirePositive("a cylinder's radius", radius);
}

EllipsoidSurface::EllipsoidSurface(const Vector3d& semiAxes) : semiAxes_(semiAxes) {
  for (int i = 0; i < 3; ++i) requirePositive("an ellipsoid's semi-axis", semiAxes[i]);
  weights_ = semiAxes.cwiseProduct(semiAxes).cwiseInverse();
  size_ = std::cbrt(semiAxes.prod());
}

TorusSurface::TorusSurface(double ringRadius, double tubeRadius)
    : ring_(ringRadius), tube_(tubeRadius) {
  requirePositive("a torus's tube radius", tubeRadius);
  if (!(ringRadius > tubeRadius)) {
    throw std::invalid_argument(
        fmt::format("a torus's ring radius is {} m, must be > its tube radius of {} m", ringRadius,
                    tubeRadius));
  }
}

int numNumbersOf(const Surface& surface) {
  return std::visit([](const auto& s) { return std::decay_t<decltype(s)>::numNumbers; }, surface);
}

double sizeOf(const Surface& surface) {
  return std::visit([](const auto& s) { return s.size(); }, surface);
}

LowestPoint lowestOnSegment(const Surface& surface, const Vector3d& x, const Vector3d& y) {
  return std::visit(
      [&](const auto& s) {
        const Vector3d point = x + lowestShare(s, x, y) * (y - x);
        const double slope = std::max(s.gradient(point).norm(), 1e-300);
        return LowestPoint{s.value(point) / slope, point};
      },
      surface);
}

bool isInside(const Surface& surface, const Vector3d& x) {
  return std::visit(
      [&](const auto& s) { return !(s.value(x) > 1e-12 * s.gradient(x).norm() * s.size()); },
      surface);
}

}  // namespace bio
