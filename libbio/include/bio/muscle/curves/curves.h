#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "bio/muscle/curves/function.h"
#include "info/autodiff/dual.h"

namespace bio {

using info::plainValue;

/// A function of one variable with its first three derivatives.
struct CurveValue {
  double value;
  double slope;
  double curvature;
  double third;  ///< third derivative: piecewise constant for a cubic
};

/// Cubic polynomials between knots, any polynomial of degree ≤ 3 outside them.
///
///     y(x) = value + t·(slope + t·(quadratic + t·cubic)),   t = x − start
///
/// with the coefficients of the segment that contains x. NaN gives NaN. No allocation and no state,
/// so it can be shared between threads.
class PiecewiseCubic {
 public:
  struct Segment {
    double start = 0;
    double value = 0;
    double slope = 0;
    double quadratic = 0;
    double cubic = 0;
  };

  /// segments.size() = knots.size() + 1: before the first knot, between, after the last.
  PiecewiseCubic(std::vector<double> knots, std::vector<Segment> segments);

  /// y(x) for any scalar type, including those of automatic differentiation.
  template <class T>
  T value(const T& x) const {
    const Segment& s = segmentAt(plainValue(x));
    const T t = x - T(s.start);
    const T linear = T(s.quadratic) + t * T(s.cubic);
    const T inner = T(s.slope) + t * linear;
    return T(s.value) + t * inner;
  }

  /// A segment of a curve with its borders; initially empty, containing no x.
  struct Piece {
    double lower = std::numeric_limits<double>::infinity();
    double upper = -std::numeric_limits<double>::infinity();
    const Segment* segment = nullptr;
    bool holds(double x) const { return lower <= x && x < upper; }
  };

  /// y, dy/dx, d²y/dx² and d³y/dx³.
  CurveValue evaluate(double x) const { return evaluate(segmentAt(x), x); }

  /// Value and derivatives without a search if x is still in the segment that contained it last.
  CurveValue evaluate(double x, Piece& last) const {
    if (!last.holds(x)) last = pieceAt(x);
    return evaluate(*last.segment, x);
  }

  /// The segment that contains x; a knot belongs to the segment on its right.
  const Segment& segmentAt(double x) const { return segments_[indexAt(x)]; }
  Piece pieceAt(double x) const;

  /// The index of that segment in segments(): knots()[index − 1] ≤ x < knots()[index].
  std::size_t indexAt(double x) const {
    // Branch-free bisection for the last knot below x.
    const double* first = knots_.data();
    std::size_t left = knots_.size();
    while (left > 1) {
      const std::size_t half = left / 2;
      first += first[half - 1] <= x ? half : 0;
      left -= half;
    }
    const auto before = static_cast<std::size_t>(first - knots_.data());
    return before + (left == 1 && *first <= x ? 1 : 0);
  }

  const std::vector<double>& knots() const { return knots_; }
  const std::vector<Segment>& segments() const { return segments_; }

 private:
  static CurveValue evaluate(const Segment& s, double x) {
    const double t = x - s.start;
    return {s.value + t * (s.slope + t * (s.quadratic + t * s.cubic)),
            s.slope + t * (2 * s.quadratic + t * 3 * s.cubic), 2 * s.quadratic + 6 * t * s.cubic,
            6 * s.cubic};
  }

  std::vector<double> knots_;
  std::vector<Segment> segments_;
};

/// Interpolating cubic spline through the points of a SplineFunction, C² between the end points.
///
/// End conditions of Forsythe, Malcolm and Moler (1977): the third derivative on the first and last
/// interval is that of the cubic through the four points at that end. Three points give their
/// parabola, two their line. Outside the points the spline continues linearly. A point given twice
/// (same x and y) makes the spline flat there, with a jump in curvature: the limit of two points
/// close together, as in OpenSim's SimmSpline. At the ends it counts once.
///
/// @throws std::invalid_argument for fewer than two different points, values that are not finite,
///         knots that fall, or two values at one knot
class CubicSpline : public PiecewiseCubic {
 public:
  explicit CubicSpline(const SplineFunction& points);
};

/// Piecewise linear interpolation, C⁰, extrapolated linearly.
/// @throws std::invalid_argument as CubicSpline does
class PiecewiseLinear : public PiecewiseCubic {
 public:
  explicit PiecewiseLinear(const PiecewiseLinearFunction& points);
};

/// Evaluates any function that a model file can hold: scale·shape(x), constant below Function::low
/// and above Function::high.
class FunctionEvaluator {
 public:
  /// @throws std::invalid_argument for points that a spline or polyline cannot go through
  explicit FunctionEvaluator(const Function& function);

  CurveValue evaluate(double x) const;

  /// Whether it was constructed as f(x) = x.
  bool isIdentity() const;
  /// scale·(value + slope·x)
  struct Line {
    double scale = 1, value = 0, slope = 1;
  };
  /// The function as a line, if it is one for all x.
  std::optional<Line> line() const;

  template <class T>
  T value(const T& x) const {
    if (const auto* curve = std::get_if<PiecewiseCubic>(&shape_)) {
      return T(scale_) * curve->value(x);
    }
    const T within = plainValue(x) < low_ ? T(low_) : plainValue(x) > high_ ? T(high_) : x;
    if (const auto* sine = std::get_if<SineFunction>(&shape_)) {
      using std::sin;
      const T angle = T(sine->omega) * within + T(sine->phase);
      return T(scale_) * (T(sine->amplitude) * sin(angle) + T(sine->offset));
    }
    T sum(0.0);
    for (const double c : std::get<PolynomialFunction>(shape_).coefficients) {
      const T shifted = sum * within;
      sum = shifted + T(c);
    }
    return T(scale_) * sum;
  }

 private:
  double scale_;
  /// A piecewise cubic is held itself.
  std::variant<PiecewiseCubic, PolynomialFunction, SineFunction> shape_;
  double low_, high_;  ///< hold the others
};

}  // namespace bio
