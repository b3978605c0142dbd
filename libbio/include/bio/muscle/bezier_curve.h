#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "bio/muscle/number_type.h"

namespace bio::muscles {

/// The control points of a quintic Bézier section that leaves (x₀, y₀) with slope s₀ and arrives in
/// (x₁, y₁) with slope s₁.
template <class T>
struct BezierCorner {
  std::array<T, 6> x, y;
};

/// Throws std::invalid_argument unless the corner's chord is longer than both its legs, squares of
/// lengths given: otherwise the section would turn back (a C-shaped corner).
void requireOpenCorner(double chord, double leftLeg, double rightLeg, double x0, double x1);

/// The corner of Millard's curves (OpenSim 4.6, SegmentedQuinticBezierToolkit; Millard et al.
/// 2013): the tangents of the ends meet in P_c, and
///     P₁ = P₂ = P₀ + c·(P_c − P₀),   P₃ = P₄ = P₅ + c·(P_c − P₅)
/// with c in (0, 1): how close the curve comes to P_c. Since P₁ = P₂ lies on the tangent, the
/// second derivative is 0 at both ends.
/// @throws std::invalid_argument for a corner that turns back
template <class T>
BezierCorner<T> bezierCorner(const T& x0, const T& y0, const T& s0, const T& x1, const T& y1,
                             const T& s1, const T& c) {
  T x_c = 0.5 * (x0 + x1);
  if (std::abs(plainValue(s0) - plainValue(s1)) > 1.4901161193847656e-8) {
    x_c = (y1 - y0 - x1 * s1 + x0 * s0) / (s0 - s1);
  }
  const T y_c = (x_c - x1) * s1 + y1;
  const auto square = [](const T& dx, const T& dy) {
    return plainValue(dx) * plainValue(dx) + plainValue(dy) * plainValue(dy);
  };
  requireOpenCorner(square(x1 - x0, y1 - y0), square(x_c - x0, y_c - y0),
                    square(x_c - x1, y_c - y1), plainValue(x0), plainValue(x1));
  const T x_m = x0 + c * (x_c - x0), y_m = y0 + c * (y_c - y0);
  const T x_n = x1 + c * (x_c - x1), y_n = y1 + c * (y_c - y1);
  return {{x0, x_m, x_m, x_n, x_n, x1}, {y0, y_m, y_m, y_n, y_n, y1}};
}

/// The coefficients of Σ p_i B_i(u), the quintic Bézier polynomial, in powers of u.
template <class T>
std::array<T, 6> powersOf(const std::array<T, 6>& p) {
  return {p[0],
          5.0 * (p[1] - p[0]),
          10.0 * (p[2] - 2.0 * p[1] + p[0]),
          10.0 * (p[3] - 3.0 * p[2] + 3.0 * p[1] - p[0]),
          5.0 * (p[4] - 4.0 * p[3] + 6.0 * p[2] - 4.0 * p[1] + p[0]),
          p[5] - 5.0 * p[4] + 10.0 * p[3] - 10.0 * p[2] + 5.0 * p[1] - p[0]};
}

/// Σ c_k u^k with its first two derivatives in u.
template <class T, class U>
[[gnu::always_inline]] inline CurvePoint<Joint<T, U>> quintic(const std::array<T, 6>& c,
                                                              const U& u) {
  using R = Joint<T, U>;
  const U u2 = u * u;
  // low and high halves side by side: half as long a chain of operations as Horner's
  const R value = (c[0] + c[1] * u) + u2 * ((c[2] + c[3] * u) + u2 * (c[4] + c[5] * u));
  const R slope =
      (c[1] + 2.0 * c[2] * u) + u2 * ((3.0 * c[3] + 4.0 * c[4] * u) + u2 * (5.0 * c[5]));
  const R curvature = (2.0 * c[2] + 6.0 * c[3] * u) + u2 * (12.0 * c[4] + 20.0 * c[5] * u);
  return {value, slope, curvature};
}

/// Abscissa and ordinate side by side: arithmetic on both costs what it costs on one.
using PlanePoint = double __attribute__((vector_size(16)));
/// A section's coefficients in powers of u.
using PlaneQuintic = std::array<PlanePoint, 6>;

// Evaluation within a section, in numbers N of one state (double) or of several side by side, whose
// Plane is a pair of them.

/// Third derivative of the polynomial.
template <class Plane, class N>
[[gnu::always_inline]] inline Plane quinticThird(const std::array<Plane, 6>& c, const N& u) {
  return 6.0 * c[3] + u * (24.0 * c[4] + u * (60.0 * c[5]));
}

/// A point of a section.
template <class N>
struct SectionPoint {
  N u;
  N x;
  CurvePoint<N> y;  ///< y, y′ and y″ over x
};
/// The point at u + δ from the polynomials at u, with δ so small that δ² is nothing (3e-8).
template <class Plane, class N>
[[gnu::always_inline]] inline SectionPoint<N> sectionBeside(const CurvePoint<Plane>& p,
                                                            const Plane& third, const N& perSpeed,
                                                            const N& u, const N& delta) {
  const Plane value = p.value + delta * p.slope;
  const Plane slope = p.slope + delta * p.curvature;
  const Plane curvature = p.curvature + delta * third;
  const N per = perSpeed - delta * p.curvature[0] * perSpeed * perSpeed;
  const N dy = slope[1] * per;
  return {u + delta, value[0], {value[1], dy, (curvature[1] - dy * curvature[0]) * per * per}};
}
/// The point at u + δ to third order, for δ up to about 2e-5.
template <class Plane, class N>
[[gnu::always_inline]] inline SectionPoint<N> sectionBeside(const CurvePoint<Plane>& p,
                                                            const Plane& third, const N& u,
                                                            const N& delta) {
  const Plane bend = p.curvature + (1.0 / 3) * delta * third;
  const Plane value = p.value + delta * (p.slope + 0.5 * delta * bend);
  const Plane slope = p.slope + delta * (p.curvature + 0.5 * delta * third);
  const Plane curvature = p.curvature + delta * third;
  const N per = 1 / slope[0];
  const N dy = slope[1] * per;
  return {u + delta, value[0], {value[1], dy, (curvature[1] - dy * curvature[0]) * per * per}};
}

/// The point of a section whose abscissa is x, from a place u nearby; where that is off by 3e-8 or
/// more, from the place that refine(u) finds to rounding.
template <class Plane, class N, class Refine>
[[gnu::always_inline]] inline CurvePoint<N> sectionAtAbscissa(const std::array<Plane, 6>& s, N u,
                                                              const N& x, const Refine& refine) {
  using std::abs;
  CurvePoint<Plane> p = quintic(s, u);
  N perSpeed = 1 / p.slope[0];
  N delta = (x - p.value[0]) * perSpeed;
  const auto near = abs(delta) < 3e-8;
  if (!everywhere(near)) {
    u = choose(near, u, refine(u));
    p = quintic(s, u);
    perSpeed = 1 / p.slope[0];
    delta = (x - p.value[0]) * perSpeed;
  }
  return sectionBeside(p, quinticThird(s, u), perSpeed, u, delta).y;
}

/// u a fraction f through a cell of a BezierCurve's table.
template <class N>
[[gnu::always_inline]] inline N placeInCell(const std::array<N, 6>& c, const N& f) {
  const N f2 = f * f;
  return (c[0] + c[1] * f) + f2 * ((c[2] + c[3] * f) + f2 * (c[4] + c[5] * f));
}

/// Where y(u) = target near u, `excess` = y(u) − target: δu to third order in excess.
template <class N>
[[gnu::always_inline]] inline N nearStep(const N& excess, const N& perSlope, const N& curvature,
                                         const N& third) {
  const N r = excess * perSlope;
  const N bend = 0.5 * curvature * perSlope;
  return -r * (1 + r * (bend + r * (2 * bend * bend - third * perSlope * (1.0 / 6))));
}

/// Where on the way to a root a safeguarded step of Halley's method leads: δu for y(u) = target.
template <class N>
[[gnu::always_inline]] inline N halleyStep(const CurvePoint<N>& y, const N& target) {
  const N excess = y.value - target;
  return -excess * y.slope / (y.slope * y.slope - 0.5 * excess * y.curvature);
}

/// u in 0 … 1 with x(u) = target for a rising quintic x(u), to rounding: Halley's method from
/// `start`, held in a bracket.
double bezierPlace(const std::array<double, 6>& x, double target, double start);

/// Corners of a curve of n sections end to end; straight lines go on from its ends.
template <class T, std::size_t n>
struct BezierShape {
  std::array<BezierCorner<T>, n> corners;
  T slopeBefore, slopeAfter;
};

/// A curve y(x) of n quintic Bézier sections end to end with straight lines outside; rises in x.
///
/// In the section that holds x, x(u) = x is solved for u in 0 … 1 and
///     y = y(u),   y′ = y_u/x_u,   y″ = (y_uu x_u − y_u x_uu)/x_u³
/// C² where neighbours share value and slope. u starts from a table of 32 cells per section
/// (quintic Hermite pieces of u(x), mostly off by less than 1e-8), after which one or two steps of
/// Newton's method leave no more than rounding. No allocation, no state.
///
/// T: the number type of the control points.
template <class T, std::size_t n>
class BezierCurve {
 public:
  explicit BezierCurve(const BezierShape<T, n>& shape)
      : first_{shape.corners[0].x[0], shape.corners[0].y[0], shape.slopeBefore},
        last_{shape.corners[n - 1].x[5], shape.corners[n - 1].y[5], shape.slopeAfter} {
    const auto& corners = shape.corners;
    for (std::size_t i = 0; i < n; ++i) {
      sections_[i] = {powersOf(corners[i].x), powersOf(corners[i].y)};
      for (std::size_t k = 0; k < 6; ++k) {
        plainX_[i][k] = plainValue(sections_[i].x[k]);
        plane_[i][k] = PlanePoint{plainX_[i][k], plainValue(sections_[i].y[k])};
      }
      knots_[i] = plainValue(corners[i].x[0]);
      knots_[i + 1] = plainValue(corners[i].x[5]);
      perCell_[i] = cells / (knots_[i + 1] - knots_[i]);
    }
    fillTable();
  }

  /// y, y′ and y″ at x.
  template <class U>
  CurvePoint<Joint<T, U>> evaluate(const U& x) const {
    using R = Joint<T, U>;
    const double at = plainValue(x);
    if (!isInside(at)) return straight<R>(isBefore(at) ? first_ : last_, x);
    const std::size_t i = sectionAt(at);
    if constexpr (std::is_same_v<R, double>) {
      return sectionAtAbscissa(plane_[i], nearPlace(i, at), at,
                               [&](double u) { return bezierPlace(plainX_[i], at, u); });
    }
    R u = R(placeIn(i, at));
    for (int k = 0; k < derivativeOrder<R>; ++k) {
      const CurvePoint<R> p = quintic(sections_[i].x, u);
      u = u - (p.value - x) / p.slope;
    }
    const CurvePoint<R> p = quintic(sections_[i].x, u);
    const CurvePoint<R> q = quintic(sections_[i].y, u);
    const R perSpeed = 1.0 / p.slope;
    const R slope = q.slope * perSpeed;
    return {q.value, slope, (q.curvature - slope * p.curvature) * perSpeed * perSpeed};
  }

  struct Section {
    std::array<T, 6> x, y;  ///< in powers of u
  };
  struct End {
    T x, y, slope;
  };
  const std::array<Section, n>& sections() const { return sections_; }
  const PlaneQuintic& plane(std::size_t i) const { return plane_[i]; }
  const End& first() const { return first_; }
  const End& last() const { return last_; }

  /// A cell of the table: the part of a section for x from `lower` on and below `upper`.
  struct Cell {
    double lower, upper;
    std::size_t section;
    double start;                        ///< f = (x − start)·per
    double per;                          ///< [1/x]
    const std::array<double, 6>* place;  ///< u over f, of placeInCell
  };
  /// The one that holds x, for x inside.
  Cell cellAt(double x) const {
    const std::size_t i = sectionAt(x);
    const auto border = [&](int cell) {
      return cell < cells ? knots_[i] + cell / perCell_[i] : knots_[i + 1];
    };
    int cell = std::clamp(static_cast<int>((x - knots_[i]) * perCell_[i]), 0, cells - 1);
    if (x < border(cell)) --cell;
    if (!(x < border(cell + 1))) ++cell;
    return {border(cell),
            border(cell + 1),
            i,
            knots_[i] + cell / perCell_[i],
            perCell_[i],
            &table_[i][static_cast<std::size_t>(cell)]};
  }

  /// Whether a section holds x, none of the straight lines.
  bool isInside(double x) const { return x > knots_[0] && x < knots_[n]; }
  bool isBefore(double x) const { return x <= knots_[0]; }

  /// u of x in section i.
  double placeIn(std::size_t i, double x) const {
    return bezierPlace(plainX_[i], x, nearPlace(i, x));
  }

  /// The section that holds x; a knot belongs to the section on its right.
  std::size_t sectionAt(double x) const {
    std::size_t i = 0;
    for (std::size_t k = 1; k < n; ++k) i += x >= knots_[k] ? 1 : 0;
    return i;
  }

 private:
  static constexpr int cells = 32;

  /// u of x in section i, as the table has it.
  double nearPlace(std::size_t i, double x) const {
    const double t = (x - knots_[i]) * perCell_[i];
    const int cell = std::min(static_cast<int>(t), cells - 1);
    return placeInCell(table_[i][static_cast<std::size_t>(cell)], t - cell);
  }

  template <class R, class U>
  static CurvePoint<R> straight(const End& end, const U& x) {
    return {end.y + end.slope * (x - end.x), R(end.slope), R(0.0)};
  }

  /// u(x) at a border of cells with its first two derivatives over the cell's width.
  CurvePoint<double> nodeOf(std::size_t i, int node, double start) const {
    const double x = knots_[i] + node / perCell_[i];
    const double u = node == cells ? 1 : bezierPlace(plainX_[i], x, start);
    const CurvePoint<double> p = quintic(plainX_[i], u);
    const double slope = 1 / (perCell_[i] * p.slope);
    return {u, slope, -p.curvature / p.slope * slope * slope};
  }

  void fillTable() {
    for (std::size_t i = 0; i < n; ++i) {
      CurvePoint<double> a = nodeOf(i, 0, 0);
      for (int cell = 0; cell < cells; ++cell) {
        const CurvePoint<double> b = nodeOf(i, cell + 1, a.value);
        // the quintic with these values, slopes and curvatures at its ends
        const double d = b.value - a.value - a.slope - 0.5 * a.curvature;
        const double e = b.slope - a.slope - a.curvature, g = b.curvature - a.curvature;
        table_[i][static_cast<std::size_t>(cell)] = {a.value,
                                                     a.slope,
                                                     0.5 * a.curvature,
                                                     10 * d - 4 * e + 0.5 * g,
                                                     -15 * d + 7 * e - g,
                                                     6 * d - 3 * e + 0.5 * g};
        a = b;
      }
    }
  }

  std::array<Section, n> sections_;
  std::array<PlaneQuintic, n> plane_;
  std::array<std::array<double, 6>, n> plainX_;
  std::array<double, n + 1> knots_;
  std::array<double, n> perCell_;
  std::array<std::array<std::array<double, 6>, cells>, n> table_;
  End first_, last_;
};

/// How a curve follows the C numbers that its points are made from: at fixed x
///     ∂y/∂θ = y_θ(u) − y′·x_θ(u),
/// both polynomials with the control points' derivatives, which come from dual numbers.
template <std::size_t C, std::size_t n>
class BezierSensitivity {
 public:
  using D = info::Dual<static_cast<int>(C)>;
  /// The shape in dual numbers, one direction per number.
  explicit BezierSensitivity(const BezierShape<D, n>& shape)
      : first_(endOf(shape.corners[0], 0, shape.slopeBefore)),
        last_(endOf(shape.corners[n - 1], 5, shape.slopeAfter)) {
    for (std::size_t i = 0; i < n; ++i) {
      const auto x = powersOf(shape.corners[i].x), y = powersOf(shape.corners[i].y);
      for (std::size_t k = 0; k < 6; ++k) {
        for (std::size_t j = 0; j < C; ++j) {
          const auto sj = static_cast<int>(j);
          x_[i][k][j] = x[k].derivatives()[sj];
          y_[i][k][j] = y[k].derivatives()[sj];
        }
      }
    }
  }

  /// ∂y/∂θ at x of the curve with the same shape in plain numbers.
  std::array<double, C> at(const BezierCurve<double, n>& curve, double x) const {
    std::array<double, C> d{};
    if (!curve.isInside(x)) {
      const bool before = curve.isBefore(x);
      const End& e = before ? first_ : last_;
      const auto& plain = before ? curve.first() : curve.last();
      for (std::size_t j = 0; j < C; ++j) {
        d[j] = e.y[j] + e.slope[j] * (x - plain.x) - plain.slope * e.x[j];
      }
      return d;
    }
    const std::size_t i = curve.sectionAt(x);
    const double u = curve.placeIn(i, x);
    const auto& s = curve.sections()[i];
    const double slope = quintic(s.y, u).slope / quintic(s.x, u).slope;
    for (std::size_t k = 6; k-- > 0;) {
      for (std::size_t j = 0; j < C; ++j) d[j] = d[j] * u + y_[i][k][j] - slope * x_[i][k][j];
    }
    return d;
  }

 private:
  using Numbers = std::array<double, C>;
  struct End {
    Numbers x, y, slope;
  };
  static End endOf(const BezierCorner<D>& corner, std::size_t k, const D& slope) {
    End e;
    for (std::size_t j = 0; j < C; ++j) {
      const auto sj = static_cast<int>(j);
      e.x[j] = corner.x[k].derivatives()[sj];
      e.y[j] = corner.y[k].derivatives()[sj];
      e.slope[j] = slope.derivatives()[sj];
    }
    return e;
  }

  std::array<std::array<Numbers, 6>, n> x_, y_;
  End first_, last_;
};

}  // namespace bio::muscles
