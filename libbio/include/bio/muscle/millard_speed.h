#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "bio/muscle/bezier_curve.h"
#include "bio/muscle/hill_shape.h"

namespace bio::muscles {

/// v with its slopes in P and A, from the curve's value f and slope there.
template <class R, class T, class U>
[[gnu::always_inline]] inline FibreSpeed<R> speedAt(const R& v, const R& f, const R& slope,
                                                    const T& B, const U& A) {
  const R byForce = 1.0 / (A * slope + B);
  return {v, byForce, -(f * byForce), R(0.0)};
}
/// v where the curve is a straight line.
template <class R, class End, class T, class U>
[[gnu::always_inline]] inline FibreSpeed<R> speedOnLine(const End& end, const T& B, const U& P,
                                                        const U& A) {
  const R v = end.x + (P - A * end.y - B * end.x) / (A * end.slope + B);
  const R f = end.y + end.slope * (v - end.x);
  return speedAt<R>(v, f, R(end.slope), B, A);
}

/// A part of a section of the curve: its ends, and the slopes of x and y there per cell.
template <class N>
struct SpeedCell {
  N lowX, lowY, highX, highY;
  N lowSpeedX, lowSpeedY, highSpeedX, highSpeedY;
  N lowest;  ///< u where it begins
  N width;   ///< in u
};

/// The point of a section with A·y + B·x = P, in the cell that holds it.
template <class Plane, class N>
[[gnu::always_inline]] inline SectionPoint<N> solveInCell(const SpeedCell<N>& s,
                                                          const std::array<Plane, 6>& plane,
                                                          const N& P, const N& A, const N& B) {
  using std::abs;
  constexpr double nearEnough = 2e-5;
  const N low = A * s.lowY + B * s.lowX;
  const N d = A * s.highY + B * s.highX - low;
  // u(G) in units of a cell: slopes d/G′ at its ends, none above 3 so that the piece rises
  const Plane slopes =
      d / (A * Plane{s.lowSpeedY, s.highSpeedY} + B * Plane{s.lowSpeedX, s.highSpeedX});
  const N m = choose(3.0 < slopes[0], N(3.0), N(slopes[0]));
  const N n = choose(3.0 < slopes[1], N(3.0), N(slopes[1]));
  const N f = (P - low) / d;
  const N start = f * (m + f * (3 - 2 * m - n + f * (m + n - 2)));
  const N highest = s.lowest + s.width;
  N u = s.lowest + start * s.width;
  const auto sum = [&](const Plane& z) { return N(A * z[1] + B * z[0]); };
  for (int k = 0;; ++k) {
    const CurvePoint<Plane> q = quintic(plane, u);
    const CurvePoint<N> g{sum(q.value), sum(q.slope), sum(q.curvature)};
    const N perSlope = 1 / g.slope;
    // most starts are so near that the next step and the point there follow from what is known here
    const auto near = abs(g.value - P) * perSlope < nearEnough;
    if (everywhere(near) || k == 8) {
      const Plane third = quinticThird(plane, u);
      const N step = nearStep(N(g.value - P), perSlope, g.curvature, sum(third));
      return sectionBeside(q, third, u, step);
    }
    const N next = u + halleyStep(g, P);
    const N within = choose(next < s.lowest, s.lowest, choose(highest < next, highest, next));
    u = choose(near, u, within);
  }
}

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
    const Section& first = sections_[0];
    const Section& last = sections_[sections - 1];
    const bool below = !(p > a * first.nodeY[0] + b * first.nodeX[0]);
    if (below || !(p < a * last.nodeY[cells] + b * last.nodeX[cells])) {
      return speedOnLine<R>(below ? curve.first() : curve.last(), B, P, A);
    }
    const std::size_t i = sectionOf(p, a, b);
    const SectionPoint<double> c = solveIn(i, curve, p, a, b);
    if constexpr (std::is_same_v<R, double>) {
      return speedAt<R>(c.x, c.y.value, c.y.slope, B, A);
    } else {
      const auto& s = curve.sections()[i];
      R u = R(c.u);
      for (int k = 0; k < derivativeOrder<R>; ++k) {
        const CurvePoint<R> x = quintic(s.x, u), y = quintic(s.y, u);
        u = u - (A * y.value + B * x.value - P) / (A * y.slope + B * x.slope);
      }
      const CurvePoint<R> x = quintic(s.x, u), y = quintic(s.y, u);
      return speedAt<R>(x.value, y.value, y.slope / x.slope, B, A);
    }
  }

  /// A cell by its place in the curve, for P within all of them.
  struct Cell {
    std::size_t section, cell;
  };
  Cell cellAt(double P, double A, double B) const {
    const std::size_t i = sectionOf(P, A, B);
    return {i, cellIn(sections_[i], P, A, B)};
  }
  /// Its borders.
  SpeedCell<double> at(const Cell& place) const {
    return cellOf(sections_[place.section], place.cell);
  }
  static constexpr Cell firstCell() { return {0, 0}; }
  static constexpr Cell lastCell() { return {sections - 1, cells - 1}; }

 private:
  static constexpr std::size_t sections = 4;
  static constexpr std::size_t cells = 16;
  /// A section with its values at the borders of the cells, and its slopes there per cell.
  struct Section {
    std::array<double, cells + 1> nodeX, nodeY, speedX, speedY;
  };

  std::size_t sectionOf(double P, double A, double B) const {
    std::size_t i = 0;
    for (std::size_t k = 1; k < sections; ++k) {
      i += A * sections_[k].nodeY[0] + B * sections_[k].nodeX[0] <= P ? 1 : 0;
    }
    return i;
  }

  static std::size_t cellIn(const Section& s, double P, double A, double B) {
    const auto isPassed = [&](std::size_t node) -> std::size_t {
      return A * s.nodeY[node] + B * s.nodeX[node] <= P ? 1 : 0;
    };
    const std::size_t cell = 4 * (isPassed(4) + isPassed(8) + isPassed(12));
    return cell + isPassed(cell + 1) + isPassed(cell + 2) + isPassed(cell + 3);
  }

  static SpeedCell<double> cellOf(const Section& s, std::size_t cell) {
    return {s.nodeX[cell],      s.nodeY[cell],      s.nodeX[cell + 1],
            s.nodeY[cell + 1],  s.speedX[cell],     s.speedY[cell],
            s.speedX[cell + 1], s.speedY[cell + 1], static_cast<double>(cell) / cells,
            1.0 / cells};
  }

  SectionPoint<double> solveIn(std::size_t i, const BezierCurve<T, 4>& curve, double P, double A,
                               double B) const {
    const Section& s = sections_[i];
    return solveInCell(cellOf(s, cellIn(s, P, A, B)), curve.plane(i), P, A, B);
  }

  std::array<Section, sections> sections_;
};

}  // namespace bio::muscles
