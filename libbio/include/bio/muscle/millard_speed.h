#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "bio/muscle/bezier_curve.h"
#include "bio/muscle/hill_shape.h"

namespace bio::muscles {

/// Solves A·f_v(v) + B·v = P for v, f_v being Millard's curve: A ≥ 0, B ≥ 0, not both 0.
///
/// In the parameter u of the curve's section the left-hand side is itself a quintic polynomial,
///     G(u) = A·y(u) + B·x(u),
/// and rises, so that no inverse of the curve is needed: the section and a sixteenth of it are
/// found among G's values at fixed u, a cubic Hermite piece of u(G) gives the start and a step of
/// third order, after some of Halley's method where the start is farther away, the root. Outside −1
/// … 1 the curve is straight.
template <class T>
class MillardSpeed {
 public:
  explicit MillardSpeed(const BezierCurve<T, 4>& curve) {
    for (std::size_t i = 0; i < sections; ++i) {
      Section& s = sections_[i];
      for (std::size_t k = 0; k <= cells; ++k) {
        const double u = static_cast<double>(k) / cells;
        const CurvePoint<PlanePoint> q = quintic(curve.plane(i), u);
        s.nodeX[k] = q.value[0];
        s.nodeY[k] = q.value[1];
        s.speedX[k] = q.slope[0] / cells;
        s.speedY[k] = q.slope[1] / cells;
      }
    }
  }

  /// v with its slopes; the curve is the one this was made from.
  template <class U>
  FibreSpeed<Joint<T, U>> solve(const BezierCurve<T, 4>& curve, const T& B, const U& P,
                                const U& A) const {
    using R = Joint<T, U>;
    const double p = plainValue(P), a = plainValue(A), b = plainValue(B);
    R v, f, slope;
    const Section& first = sections_[0];
    const Section& last = sections_[sections - 1];
    const bool below = !(p > a * first.nodeY[0] + b * first.nodeX[0]);
    if (below || !(p < a * last.nodeY[cells] + b * last.nodeX[cells])) {
      const auto& end = below ? curve.first() : curve.last();
      v = end.x + (P - A * end.y - B * end.x) / (A * end.slope + B);
      f = end.y + end.slope * (v - end.x);
      slope = R(end.slope);
    } else {
      std::size_t i = 0;
      for (std::size_t k = 1; k < sections; ++k) {
        i += a * sections_[k].nodeY[0] + b * sections_[k].nodeX[0] <= p ? 1 : 0;
      }
      if constexpr (std::is_same_v<R, double>) {
        const SectionPoint c = solveIn(sections_[i], curve.plane(i), p, a, b);
        v = c.x;
        f = c.y.value;
        slope = c.y.slope;
      } else {
        const auto& s = curve.sections()[i];
        R u = R(solveIn(sections_[i], curve.plane(i), p, a, b).u);
        for (int k = 0; k < derivativeOrder<R>; ++k) {
          const CurvePoint<R> x = quintic(s.x, u), y = quintic(s.y, u);
          u = u - (A * y.value + B * x.value - P) / (A * y.slope + B * x.slope);
        }
        const CurvePoint<R> x = quintic(s.x, u), y = quintic(s.y, u);
        v = x.value;
        f = y.value;
        slope = y.slope / x.slope;
      }
    }
    const R byForce = 1.0 / (A * slope + B);
    return {v, byForce, -(f * byForce), R(0.0)};
  }

 private:
  static constexpr std::size_t sections = 4;
  static constexpr std::size_t cells = 16;
  /// A section with its values at the borders of the cells, and its slopes there per cell.
  struct Section {
    std::array<double, cells + 1> nodeX, nodeY, speedX, speedY;
  };

  static SectionPoint solveIn(const Section& s, const PlaneQuintic& plane, double P, double A,
                              double B) {
    const auto isPassed = [&](std::size_t node) -> std::size_t {
      return A * s.nodeY[node] + B * s.nodeX[node] <= P ? 1 : 0;
    };
    std::size_t cell = 4 * (isPassed(4) + isPassed(8) + isPassed(12));
    cell += isPassed(cell + 1) + isPassed(cell + 2) + isPassed(cell + 3);
    const double low = A * s.nodeY[cell] + B * s.nodeX[cell];
    const double d = A * s.nodeY[cell + 1] + B * s.nodeX[cell + 1] - low;
    // u(G) in units of a cell: slopes d/G′ at its ends, none above 3 so that the piece rises
    const PlanePoint slopes = d / (A * PlanePoint{s.speedY[cell], s.speedY[cell + 1]} +
                                   B * PlanePoint{s.speedX[cell], s.speedX[cell + 1]});
    const double m = std::min(slopes[0], 3.0), n = std::min(slopes[1], 3.0);
    const double f = (P - low) / d;
    const double start = f * (m + f * (3 - 2 * m - n + f * (m + n - 2)));
    constexpr double width = 1.0 / cells;
    const double lowest = static_cast<double>(cell) * width;
    double u = lowest + start * width;
    const auto sum = [A, B](const PlanePoint& z) { return A * z[1] + B * z[0]; };
    for (int k = 0;; ++k) {
      const CurvePoint<PlanePoint> q = quintic(plane, u);
      const CurvePoint<double> g{sum(q.value), sum(q.slope), sum(q.curvature)};
      const double perSlope = 1 / g.slope;
      // most starts are so near that the next step and the point there follow from what is known
      // here
      if (std::abs(g.value - P) * perSlope < nearEnough || k == 8) {
        const PlanePoint third = quinticThird(plane, u);
        const double step = nearStep(g.value - P, perSlope, g.curvature, sum(third));
        return sectionBeside(q, third, u, step);
      }
      u = std::clamp(u + halleyStep(g, P), lowest, lowest + width);
    }
  }

  static constexpr double nearEnough = 2e-5;

  std::array<Section, sections> sections_;
};

}  // namespace bio::muscles
