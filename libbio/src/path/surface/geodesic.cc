#include "bio/path/surface/geodesic.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "extrapolation.h"

namespace bio {
namespace {

using namespace detail;
using Eigen::Vector3d;

JacobiMotion motionOf(const GeodesicPoint& p) {
  return {{p.x[0], p.x[1], p.x[2], p.a, p.r, p.u[0], p.u[1], p.u[2], p.aSlope, p.rSlope}};
}
GeodesicPoint pointOf(const JacobiMotion& m) {
  return {{m.position(0), m.position(1), m.position(2)},
          {m.slope(0), m.slope(1), m.slope(2)},
          m.position(3),
          m.slope(3),
          m.position(4),
          m.slope(4)};
}
GeodesicPoint geodesicStart(const Vector3d& x, const Vector3d& u) {
  return {x, u, 1, 0, 0, 1};
}

// Two numbers side by side: two rows are computed at once, each waiting for its own divisions.
using Pair = double __attribute__((vector_size(16)));

// Rows 2k and 2k + 1 by Störmer's rule in summed form, for accelerations of the position alone:
// n = 2k + 1 and 2k + 2 substeps of h/n.
template <class Flow>
void stoermer(const Flow& flow, const JacobiMotion& start, const double* f0, double h, int k,
              JacobiMotion* rows) {
  const int n = 2 * k + 2;
  const Pair H = {h / (n - 1), h / n};
  const Pair perH = {(n - 1) / h, n / h};
  const Pair square = H * H;
  Pair d[numPositions], f[numPositions], position[numPositions];
  for (int i = 0; i < numPositions; ++i) {
    d[i] = H * (start.slope(i) + 0.5 * H * f0[i]);
    position[i] = start.position(i) + d[i];
  }
  for (int substep = 1;; ++substep) {
    const Pair curvature = flow.accelerate(position, f);
    f[3] = -curvature * position[3];
    f[4] = -curvature * position[4];
    if (substep >= n - 1) {
      const int lane = substep - (n - 1);
      for (int i = 0; i < numPositions; ++i) {
        const Pair slope = d[i] * perH + 0.5 * H * f[i];
        rows[lane].position(i) = position[i][lane];
        rows[lane].slope(i) = slope[lane];
      }
      if (lane == 1) return;
    }
    for (int i = 0; i < numPositions; ++i) {
      d[i] += square * f[i];
      position[i] += d[i];
    }
  }
}

// Steps by a surface's Flow.
template <class S>
class FlowStepper {
 public:
  static constexpr double reach = S::Flow::reach;
  FlowStepper(const S& surface, const GeodesicPoint& start)
      : flow_(surface, start.x, start.u), perSize_(1 / surface.size()) {}
  bool step(GeodesicPoint& p, double h, double tolerance) const {
    const JacobiMotion start = motionOf(p);
    double f0[numPositions];
    const double curvature = flow_.accelerate(start.number, f0);
    f0[3] = -curvature * start.position(3);
    f0[4] = -curvature * start.position(4);
    JacobiMotion end;
    JacobiMotion rows[2];
    const auto row = [&](int k) {
      if (k % 2 == 0) stoermer(flow_, start, f0, h, k / 2, rows);
      return rows[k % 2];
    };
    if (!extrapolate(row, perSize_, tolerance, end)) return false;
    p = pointOf(end);
    return true;
  }

 private:
  typename S::Flow flow_;
  double perSize_;
};

// Steps by the derivatives of g alone.
template <class S>
class DerivativeStepper {
 public:
  static constexpr double reach = 0.5;
  DerivativeStepper(const S& surface, const GeodesicPoint&)
      : surface_(surface), perSize_(1 / surface.size()) {}
  bool step(GeodesicPoint& p, double h, double tolerance) const {
    const JacobiMotion start = motionOf(p);
    JacobiMotion end;
    const auto row = [&](int k) { return midpoint(start, h, 2 * (k + 1)); };
    if (!extrapolate(row, perSize_, tolerance, end)) return false;
    p = pointOf(end);
    return true;
  }

 private:
  JacobiMotion rate(const JacobiMotion& m) const {
    const Vector3d x(m.position(0), m.position(1), m.position(2));
    const Vector3d u(m.slope(0), m.slope(1), m.slope(2));
    const SurfaceFrame frame = surfaceFrame(surface_, x, u);
    const double curvature = frame.normal * frame.sideways - frame.twist * frame.twist;
    JacobiMotion rate;
    for (int i = 0; i < numPositions; ++i) rate.position(i) = m.slope(i);
    for (int i = 0; i < 3; ++i) rate.slope(i) = frame.normal * u.squaredNorm() * frame.n[i];
    for (int i = 3; i < numPositions; ++i) rate.slope(i) = -curvature * m.position(i);
    return rate;
  }
  static JacobiMotion moved(const JacobiMotion& m, const JacobiMotion& rate, double h) {
    JacobiMotion to;
    for (int i = 0; i < numPositions; ++i) {
      to.position(i) = m.position(i) + h * rate.position(i);
      to.slope(i) = m.slope(i) + h * rate.slope(i);
    }
    return to;
  }
  // The midpoint rule with Gragg's smoothing.
  JacobiMotion midpoint(const JacobiMotion& start, double h, int n) const {
    const double H = h / n;
    JacobiMotion before = start;
    JacobiMotion now = moved(start, rate(start), H);
    for (int k = 1; k < n; ++k) {
      const JacobiMotion next = moved(before, rate(now), 2 * H);
      before = now;
      now = next;
    }
    const JacobiMotion after = moved(before, rate(now), H);
    for (int i = 0; i < numPositions; ++i) {
      now.position(i) = 0.5 * (now.position(i) + after.position(i));
      now.slope(i) = 0.5 * (now.slope(i) + after.slope(i));
    }
    return now;
  }
  const S& surface_;
  double perSize_;
};

// Great circle.
class SphereStepper {
 public:
  static constexpr double reach = 1;
  SphereStepper(const SphereSurface& surface, const GeodesicPoint&) : radius_(surface.radius()) {}
  bool step(GeodesicPoint& p, double h, double) const {
    const double c = std::cos(h / radius_), s = std::sin(h / radius_);
    const GeodesicPoint was = p;
    p.x = was.x * c + was.u * (radius_ * s);
    p.u = was.u * c - was.x * (s / radius_);
    p.a = was.a * c + was.aSlope * radius_ * s;
    p.aSlope = was.aSlope * c - was.a * s / radius_;
    p.r = was.r * c + was.rSlope * radius_ * s;
    p.rSlope = was.rSlope * c - was.r * s / radius_;
    return true;
  }

 private:
  double radius_;
};

// Helix.
class CylinderStepper {
 public:
  static constexpr double reach = 1;
  CylinderStepper(const CylinderSurface& surface, const GeodesicPoint& start)
      : perSquare_(1 / (surface.radius() * surface.radius())),
        turning_((start.x[0] * start.u[1] - start.x[1] * start.u[0]) * perSquare_) {}
  bool step(GeodesicPoint& p, double h, double) const {
    const double c = std::cos(turning_ * h), s = std::sin(turning_ * h);
    p.x = Vector3d(p.x[0] * c - p.x[1] * s, p.x[0] * s + p.x[1] * c, p.x[2] + h * p.u[2]);
    p.u = Vector3d(p.u[0] * c - p.u[1] * s, p.u[0] * s + p.u[1] * c, p.u[2]);
    p.a += h * p.aSlope;
    p.r += h * p.rSlope;
    return true;
  }

 private:
  double perSquare_, turning_;
};

// The step of a surface.
inline SphereStepper stepperOf(const SphereSurface& s, const GeodesicPoint& p) {
  return {s, p};
}
inline CylinderStepper stepperOf(const CylinderSurface& s, const GeodesicPoint& p) {
  return {s, p};
}
template <class S>
FlowStepper<S> stepperOf(const S& s, const GeodesicPoint& p) {
  return {s, p};
}

// The distance over which ∇g changes by itself, in the mean of along the path and at the most:
// extrapolation is likely to reach in steps of `reach` times that.
template <class S>
double naturalStep(const S& surface, const GeodesicPoint& p) {
  double most = 0;
  for (int i = 0; i < 3; ++i) {
    most = std::max(most, surface.hessianTimes(p.x, Vector3d::Unit(i)).squaredNorm());
  }
  const double along = surface.hessianTimes(p.x, p.u).squaredNorm();
  const double slope = surface.gradient(p.x).squaredNorm();
  return std::sqrt(slope / std::sqrt(std::max(along * most, 1e-12 * most * most)));
}

// From p over length s; `visit(p, h)` before each step that is taken.
template <class S, class Stepper, class Visit>
void walk(const S& surface, const Stepper& stepper, GeodesicPoint& p, double s, double tolerance,
          const Visit& visit) {
  double left = s;
  for (int i = 0; i < 400 && left != 0; ++i) {
    const double likely = Stepper::reach * naturalStep(surface, p);
    // equal steps, rather than a small last one
    double h = left / std::max(1.0, std::ceil(std::min(std::abs(left) / likely, 1e6)));
    GeodesicPoint to = p;
    int halvings = 0;
    while (!stepper.step(to, h, tolerance) && halvings < 12) {
      h /= 2;
      ++halvings;
    }
    if (halvings == 12 || !std::isfinite(to.x.sum())) break;
    visit(p, h);
    p = to;
    left = std::abs(left - h) < 1e-15 * std::abs(s) ? 0 : left - h;
  }
  if (left != 0) p.x.setConstant(std::numeric_limits<double>::quiet_NaN());
}

constexpr auto visitNothing = [](const GeodesicPoint&, double) {};

// Gauss's rule on [0, 1].
struct GaussPoint {
  double at, weight;
};
constexpr GaussPoint gaussRule[8] = {
    {0.019855071751231884, 0.050614268145188130}, {0.101666761293186631, 0.111190517226687235},
    {0.237233795041835507, 0.156853322938943644}, {0.408282678752175098, 0.181341891689180991},
    {0.591717321247824902, 0.181341891689180991}, {0.762766204958164493, 0.156853322938943644},
    {0.898333238706813369, 0.111190517226687235}, {0.980144928248768116, 0.050614268145188130}};

// F of one number, and its changes as the point moves sideways and the direction with it.
template <class S>
struct Integrand {
  double force, perShift, perTurn;  // F; D_bF + τ F_u·n; F_u·b
  Integrand(const S& surface, const SurfaceFrame& frame, const Vector3d& x, int i) {
    const Vector3d gradient = surface.gradient(x);
    const double perSquare = 1 / gradient.squaredNorm();
    const Vector3d bent = surface.hessianTimes(x, frame.u);
    const double bending = bent.dot(frame.u);
    const NumberDerivative d = surface.ofNumber(x, i);
    force = -bending * d.value * perSquare;
    perShift = -(surface.thirdTwice(x, frame.u).dot(frame.b) * d.value +
                 bending * d.gradient.dot(frame.b)) *
                   perSquare +
               2 * bending * d.value * gradient.dot(surface.hessianTimes(x, frame.b)) * perSquare *
                   perSquare;
    const double perDirection = -2 * d.value * perSquare;
    perShift += perDirection * frame.twist * bent.dot(frame.n);
    perTurn = perDirection * bent.dot(frame.b);
  }
};

template <class S>
std::array<NumberIntegral, maxSurfaceNumbers> integrate(const S& surface, const Vector3d& x,
                                                        const Vector3d& u, double s) {
  constexpr double tolerance = 1e-13;
  std::array<NumberIntegral, maxSurfaceNumbers> result{};
  GeodesicPoint p = geodesicStart(x, u);
  const auto stepper = stepperOf(surface, p);
  const auto addPanel = [&](const GeodesicPoint& from, double h) {
    GeodesicPoint at = from;
    double reached = 0;
    for (const GaussPoint& node : gaussRule) {
      if (!stepper.step(at, (node.at - reached) * h, tolerance)) {
        at.x.setConstant(std::numeric_limits<double>::quiet_NaN());
      }
      reached = node.at;
      const SurfaceFrame frame = surfaceFrame(surface, at.x, at.u);
      for (int i = 0; i < S::numNumbers; ++i) {
        const Integrand<S> f(surface, frame, at.x, i);
        NumberIntegral& sum = result[static_cast<std::size_t>(i)];
        const double weight = node.weight * h;
        sum.length += weight * f.force;
        sum.sideways += weight * (f.perShift * at.a + f.perTurn * at.aSlope);
        sum.turned += weight * (f.perShift * at.r + f.perTurn * at.rSlope);
      }
    }
  };
  const SurfaceFrame first = surfaceFrame(surface, p.x, p.u);
  for (int i = 0; i < S::numNumbers; ++i) {
    result[static_cast<std::size_t>(i)].first = Integrand<S>(surface, first, p.x, i).force;
  }
  walk(surface, stepper, p, s, tolerance, addPanel);
  const SurfaceFrame last = surfaceFrame(surface, p.x, p.u);
  for (int i = 0; i < S::numNumbers; ++i) {
    result[static_cast<std::size_t>(i)].last = Integrand<S>(surface, last, p.x, i).force;
  }
  return result;
}

}  // namespace

GeodesicPoint shootGeodesic(const Surface& surface, const Vector3d& x, const Vector3d& u, double s,
                            double tolerance) {
  return std::visit(
      [&](const auto& shape) {
        GeodesicPoint p = geodesicStart(x, u);
        walk(shape, stepperOf(shape, p), p, s, tolerance, visitNothing);
        return p;
      },
      surface);
}

template <ImplicitSurface S>
GeodesicPoint shootByDerivatives(const S& surface, const Vector3d& x, const Vector3d& u, double s,
                                 double tolerance) {
  GeodesicPoint p = geodesicStart(x, u);
  walk(surface, DerivativeStepper<S>(surface, p), p, s, tolerance, visitNothing);
  return p;
}
template GeodesicPoint shootByDerivatives(const EllipsoidSurface&, const Vector3d&, const Vector3d&,
                                          double, double);
template GeodesicPoint shootByDerivatives(const TorusSurface&, const Vector3d&, const Vector3d&,
                                          double, double);
template GeodesicPoint shootByDerivatives(const SphereSurface&, const Vector3d&, const Vector3d&,
                                          double, double);
template GeodesicPoint shootByDerivatives(const CylinderSurface&, const Vector3d&, const Vector3d&,
                                          double, double);

std::array<NumberIntegral, maxSurfaceNumbers> numberIntegrals(const Surface& surface,
                                                              const Vector3d& x, const Vector3d& u,
                                                              double s) {
  return std::visit([&](const auto& shape) { return integrate(shape, x, u, s); }, surface);
}

}  // namespace bio
