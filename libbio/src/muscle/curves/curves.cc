#include "bio/muscle/curves/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace bio {
namespace {

struct Points {
  std::vector<double> x;
  std::vector<double> y;
};

// SimmSpline's shortest interval: what it takes a doubled point to be apart.
constexpr double shortestInterval = 1e-7;

double interval(double from, double to) {
  return std::max(shortestInterval, to - from);
}

// The points, checked; one that is given twice stays twice if `keepDoubled`, except at the ends.
Points checkedPoints(const char* kind, const std::vector<double>& x, const std::vector<double>& y,
                     bool keepDoubled) {
  if (x.size() != y.size()) {
    throw std::invalid_argument(
        fmt::format("{}: {} values of x but {} of y", kind, x.size(), y.size()));
  }
  Points points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) {
      throw std::invalid_argument(
          fmt::format("{}: point {} is ({}, {}), must be finite", kind, i + 1, x[i], y[i]));
    }
    if (!points.x.empty() && x[i] == points.x.back()) {
      const std::size_t n = points.x.size();
      const bool inside = n > 1 && x[i] != x.back();
      const bool third = n > 1 && points.x[n - 2] == x[i];
      if (y[i] == points.y.back() && keepDoubled && inside && !third) {
        points.x.push_back(x[i]);
        points.y.push_back(y[i]);
        continue;
      }
      if (y[i] == points.y.back()) continue;
      throw std::invalid_argument(
          fmt::format("{}: two values, {} and {}, at x = {}", kind, points.y.back(), y[i], x[i]));
    }
    if (!points.x.empty() && x[i] < points.x.back()) {
      throw std::invalid_argument(fmt::format("{}: x must rise, but {} follows {} at point {}",
                                              kind, x[i], points.x.back(), i + 1));
    }
    points.x.push_back(x[i]);
    points.y.push_back(y[i]);
  }
  if (points.x.size() < 2) {
    throw std::invalid_argument(
        fmt::format("{}: needs at least 2 different points, has {}", kind, points.x.size()));
  }
  return points;
}

// Newton's third divided difference over points i … i+3.
double thirdDifference(const Points& p, std::size_t i) {
  const auto first = [&](std::size_t j) {
    return (p.y[j + 1] - p.y[j]) / interval(p.x[j], p.x[j + 1]);
  };
  const auto second = [&](std::size_t j) {
    return (first(j + 1) - first(j)) / (p.x[j + 2] - p.x[j]);
  };
  return (second(i + 1) - second(i)) / (p.x[i + 3] - p.x[i]);
}

// Second derivatives M_i of the spline at its knots: the C¹ conditions
//   h_{i−1} M_{i−1} + 2(h_{i−1}+h_i) M_i + h_i M_{i+1} = 6 (slope_i − slope_{i−1})
// with the given third derivatives on the first and last interval.
std::vector<double> secondDerivatives(const Points& p) {
  const std::size_t n = p.x.size();
  if (n == 2) return {0, 0};
  std::vector<double> h(n - 1), slope(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    h[i] = interval(p.x[i], p.x[i + 1]);
    slope[i] = (p.y[i + 1] - p.y[i]) / h[i];
  }
  const double thirdFirst = n > 3 ? 6 * thirdDifference(p, 0) : 0;
  const double thirdLast = n > 3 ? 6 * thirdDifference(p, n - 4) : 0;

  // With M_0 = M_1 − h_0·thirdFirst and M_{n−1} = M_{n−2} + h·thirdLast the inner rows form a
  // tridiagonal, diagonally dominant system.
  std::vector<double> diagonal(n), right(n);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    diagonal[i] = 2 * (h[i - 1] + h[i]);
    right[i] = 6 * (slope[i] - slope[i - 1]);
  }
  diagonal[1] += h[0];
  right[1] += h[0] * h[0] * thirdFirst;
  diagonal[n - 2] += h[n - 2];
  right[n - 2] -= h[n - 2] * h[n - 2] * thirdLast;
  for (std::size_t i = 2; i + 1 < n; ++i) {
    const double factor = h[i - 1] / diagonal[i - 1];
    diagonal[i] -= factor * h[i - 1];
    right[i] -= factor * right[i - 1];
  }
  std::vector<double> M(n);
  M[n - 2] = right[n - 2] / diagonal[n - 2];
  for (std::size_t i = n - 2; i-- > 1;) M[i] = (right[i] - h[i] * M[i + 1]) / diagonal[i];
  M[0] = M[1] - h[0] * thirdFirst;
  M[n - 1] = M[n - 2] + h[n - 2] * thirdLast;
  return M;
}

PiecewiseCubic throughPoints(const Points& p, const std::vector<double>& M) {
  const std::size_t n = p.x.size();
  std::vector<PiecewiseCubic::Segment> segments(n + 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double h = interval(p.x[i], p.x[i + 1]);
    const double slope = (p.y[i + 1] - p.y[i]) / h - h * (2 * M[i] + M[i + 1]) / 6;
    segments[i + 1] = {p.x[i], p.y[i], slope, M[i] / 2, (M[i + 1] - M[i]) / (6 * h)};
  }
  const double h = p.x[n - 1] - p.x[n - 2];
  const double lastSlope = (p.y[n - 1] - p.y[n - 2]) / h + h * (M[n - 2] + 2 * M[n - 1]) / 6;
  segments[0] = {p.x[0], p.y[0], segments[1].slope, 0, 0};
  segments[n] = {p.x[n - 1], p.y[n - 1], lastSlope, 0, 0};
  return {p.x, std::move(segments)};
}

PiecewiseCubic spline(const SplineFunction& function) {
  const Points points = checkedPoints("spline", function.x, function.y, true);
  return throughPoints(points, secondDerivatives(points));
}

PiecewiseCubic polyline(const PiecewiseLinearFunction& function) {
  const Points points = checkedPoints("piecewise linear function", function.x, function.y, false);
  return throughPoints(points, std::vector<double>(points.x.size(), 0.0));
}

std::variant<PiecewiseCubic, PolynomialFunction, SineFunction> compileShape(
    const Function& function) {
  struct Compile {
    using Result = std::variant<PiecewiseCubic, PolynomialFunction, SineFunction>;
    Result operator()(const ConstantFunction& f) const {
      return PiecewiseCubic({}, {{0, f.value, 0, 0, 0}});
    }
    Result operator()(const LinearFunction& f) const {
      return PiecewiseCubic({}, {{0, f.intercept, f.slope, 0, 0}});
    }
    Result operator()(const SplineFunction& f) const { return spline(f); }
    Result operator()(const PiecewiseLinearFunction& f) const { return polyline(f); }
    Result operator()(const PolynomialFunction& f) const { return f; }
    Result operator()(const SineFunction& f) const { return f; }
  };
  return std::visit(Compile{}, function.shape);
}

// The curve between low and high, its value there beyond them.
PiecewiseCubic held(const PiecewiseCubic& curve, double low, double high) {
  std::vector<double> knots{low};
  std::vector<PiecewiseCubic::Segment> segments{{low, curve.evaluate(low).value, 0, 0, 0},
                                                curve.segmentAt(low)};
  for (const double knot : curve.knots()) {
    if (!(low < knot && knot < high)) continue;
    knots.push_back(knot);
    segments.push_back(curve.segmentAt(knot));
  }
  knots.push_back(high);
  segments.push_back({high, curve.evaluate(high).value, 0, 0, 0});
  return {std::move(knots), std::move(segments)};
}

}  // namespace

PiecewiseCubic::PiecewiseCubic(std::vector<double> knots, std::vector<Segment> segments)
    : knots_(std::move(knots)), segments_(std::move(segments)) {
  if (segments_.size() != knots_.size() + 1) {
    throw std::invalid_argument(fmt::format("a curve with {} knots has {} segments, must be {}",
                                            knots_.size(), segments_.size(), knots_.size() + 1));
  }
}

PiecewiseCubic::Piece PiecewiseCubic::pieceAt(double x) const {
  const std::size_t index = indexAt(x);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {index == 0 ? -infinity : knots_[index - 1],
          index == knots_.size() ? infinity : knots_[index], &segments_[index]};
}

CubicSpline::CubicSpline(const SplineFunction& points) : PiecewiseCubic(spline(points)) {}

PiecewiseLinear::PiecewiseLinear(const PiecewiseLinearFunction& points)
    : PiecewiseCubic(polyline(points)) {}

FunctionEvaluator::FunctionEvaluator(const Function& function)
    : scale_(function.scale),
      shape_(compileShape(function)),
      low_(function.low),
      high_(function.high) {
  if (!std::isfinite(low_) && !std::isfinite(high_)) return;
  if (!(low_ <= high_)) {
    throw std::invalid_argument(
        fmt::format("a function is held within {} to {}, must not fall", low_, high_));
  }
  if (const auto* curve = std::get_if<PiecewiseCubic>(&shape_)) {
    constexpr double most = std::numeric_limits<double>::max();
    shape_ = held(*curve, std::max(low_, -most), std::min(high_, most));
  }
}

bool FunctionEvaluator::isIdentity() const {
  const auto* curve = std::get_if<PiecewiseCubic>(&shape_);
  if (!curve || !curve->knots().empty()) return false;
  const PiecewiseCubic::Segment& s = curve->segments().front();
  return s.start == 0 && s.value == 0 && scale_ * s.slope == 1 && s.quadratic == 0 && s.cubic == 0;
}

std::optional<FunctionEvaluator::Line> FunctionEvaluator::line() const {
  const auto* curve = std::get_if<PiecewiseCubic>(&shape_);
  if (!curve || !curve->knots().empty()) return {};
  const PiecewiseCubic::Segment& s = curve->segments().front();
  if (s.start != 0 || s.quadratic != 0 || s.cubic != 0) return {};
  return Line{scale_, s.value, s.slope};
}

CurveValue FunctionEvaluator::evaluate(double x) const {
  if (const auto* curve = std::get_if<PiecewiseCubic>(&shape_)) {
    const CurveValue y = curve->evaluate(x);
    return {scale_ * y.value, scale_ * y.slope, scale_ * y.curvature, scale_ * y.third};
  }
  if (x < low_ || x > high_) {
    return {this->value(std::clamp(x, low_, high_)), 0, 0, 0};
  }
  if (const auto* sine = std::get_if<SineFunction>(&shape_)) {
    const double w = sine->omega, angle = w * x + sine->phase;
    const double by = scale_ * sine->amplitude, s = std::sin(angle), c = std::cos(angle);
    return {by * s + scale_ * sine->offset, by * w * c, -by * w * w * s, -by * w * w * w * c};
  }
  // Horner's scheme for the polynomial and its first three derivatives.
  double value = 0, slope = 0, halfCurvature = 0, sixthThird = 0;
  for (const double c : std::get<PolynomialFunction>(shape_).coefficients) {
    sixthThird = sixthThird * x + halfCurvature;
    halfCurvature = halfCurvature * x + slope;
    slope = slope * x + value;
    value = value * x + c;
  }
  return {scale_ * value, scale_ * slope, scale_ * 2 * halfCurvature, scale_ * 6 * sixthThird};
}

}  // namespace bio
