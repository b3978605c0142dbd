#include "bio/muscle/curves/curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "support/elbow_curves.h"
#include "support/finite_difference.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

// The same spline by brute force: four unknown coefficients on each interval, all conditions in one
// dense system.
class DenseSpline {
 public:
  explicit DenseSpline(const SplineFunction& p) : x_(p.x) {
    const Eigen::Index pieces = static_cast<Eigen::Index>(p.x.size()) - 1;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4 * pieces, 4 * pieces);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(4 * pieces);
    Eigen::Index row = 0;
    for (Eigen::Index i = 0; i < pieces; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double h = p.x[k + 1] - p.x[k];
      A(row, 4 * i) = 1;
      b(row++) = p.y[k];
      A.block(row, 4 * i, 1, 4) << 1, h, h * h, h * h * h;
      b(row++) = p.y[k + 1];
      if (i + 1 < pieces) {
        A.block(row, 4 * i, 1, 8) << 0, 1, 2 * h, 3 * h * h, 0, -1, 0, 0;
        A.block(row + 1, 4 * i, 1, 8) << 0, 0, 2, 6 * h, 0, 0, -2, 0;
        row += 2;
      }
    }
    const std::size_t n = p.x.size();
    A(row, 3) = 1;
    b(row++) = cubicThrough(p, 0);
    A(row, 4 * pieces - 1) = 1;
    b(row++) = cubicThrough(p, n - 4);
    c_ = A.fullPivLu().solve(b);
  }
  double operator()(double x) const {
    std::size_t i = 0;
    while (i + 2 < x_.size() && x >= x_[i + 1]) ++i;
    const Eigen::Vector4d c = c_.segment<4>(4 * static_cast<Eigen::Index>(i));
    const double t = x - x_[i];
    return c[0] + c[1] * t + c[2] * t * t + c[3] * t * t * t;
  }

 private:
  // Leading coefficient of the cubic through points i … i+3.
  static double cubicThrough(const SplineFunction& p, std::size_t i) {
    Eigen::Matrix4d V;
    Eigen::Vector4d y;
    for (std::size_t j = 0; j < 4; ++j) {
      const double t = p.x[i + j] - p.x[i];
      V.row(static_cast<Eigen::Index>(j)) << 1, t, t * t, t * t * t;
      y[static_cast<Eigen::Index>(j)] = p.y[i + j];
    }
    return V.fullPivLu().solve(y)[3];
  }
  std::vector<double> x_;
  Eigen::VectorXd c_;
};

TEST(CubicSpline, PassesThroughItsPoints) {
  const SchutteParameters p = support::elbowCurves();
  for (const SplineFunction& f :
       {p.tendonForceLength, p.activeForceLength, *p.passiveForceLength}) {
    const CubicSpline spline(f);
    for (std::size_t i = 0; i < f.x.size(); ++i) EXPECT_NEAR(spline.value(f.x[i]), f.y[i], 1e-12);
  }
}

TEST(CubicSpline, IsTheCubicThroughFourPoints) {
  const auto cubic = [](double x) { return 2 - x + 0.5 * x * x - 3 * x * x * x; };
  const SplineFunction f{{-1, 0.5, 1, 3}, {cubic(-1), cubic(0.5), cubic(1), cubic(3)}};
  const CubicSpline spline(f);
  for (double x = -1; x <= 3; x += 0.1) EXPECT_NEAR(spline.value(x), cubic(x), 1e-12);
}

TEST(CubicSpline, AgreesWithTheDenseSystemOfItsConditions) {
  SplineFunction f{{0, 0.3, 1, 1.2, 2, 2.7, 3.1}, {1, -2, 0.5, 0.7, 3, 2.9, -1}};
  const CubicSpline spline(f);
  const DenseSpline dense(f);
  for (double x = 0; x <= 3.1; x += 0.01) EXPECT_NEAR(spline.value(x), dense(x), 1e-12);
  // the elbow's tendon curve, knots between 0.0005 and 10 apart
  const SplineFunction tendon = support::elbowCurves().tendonForceLength;
  const CubicSpline tendonSpline(tendon);
  const DenseSpline tendonDense(tendon);
  for (double x = 0; x <= 0.05; x += 0.0001) {
    EXPECT_NEAR(tendonSpline.value(x), tendonDense(x), 1e-9);  // measured 2e-12
  }
}

TEST(CubicSpline, GivesTheParabolaOfThreePointsAndTheLineOfTwo) {
  const CubicSpline parabola(SplineFunction{{0, 1, 3}, {1, 2, 10}});
  for (double x = 0; x <= 3; x += 0.25) EXPECT_NEAR(parabola.value(x), 1 + x * x, 1e-13);
  const CubicSpline line(SplineFunction{{1, 2}, {5, 3}});
  for (double x = -4; x <= 4; x += 0.5) EXPECT_NEAR(line.value(x), 7 - 2 * x, 1e-13);
}

TEST(CubicSpline, GoesOnStraightOutsideItsPoints) {
  const CubicSpline spline(SplineFunction{{0, 1, 2, 4}, {0, 1, 8, 64}});  // x³
  EXPECT_NEAR(spline.value(5.0), 64 + 48, 1e-11);
  EXPECT_NEAR(spline.evaluate(5.0).slope, 48, 1e-11);
  EXPECT_EQ(spline.evaluate(5.0).curvature, 0);
  EXPECT_NEAR(spline.value(-2.0), 0, 1e-12);
}

// facts measured on these curves: active peak 1.0004 at 1.0075, tendon force 1 at a strain of
// 0.0322
TEST(CubicSpline, HasTheKnownFeaturesOfTheElbowCurves) {
  const SchutteParameters p = support::elbowCurves();
  const CubicSpline active(p.activeForceLength);
  EXPECT_NEAR(active.value(1.0075), 1.0004, 5e-5);
  EXPECT_NEAR(active.evaluate(1.0075).slope, 0, 5e-3);
  const CubicSpline tendon(p.tendonForceLength);
  EXPECT_NEAR(tendon.value(0.0322), 1, 4e-3);
}

TEST(CubicSpline, IsFlatAtAPointGivenTwice) {
  const CubicSpline twice(SplineFunction{{0, 1, 2, 2, 4, 5}, {0, 1, 8, 8, 64, 3}});
  const double h = 1e-6;  // two points close together
  const CubicSpline close(SplineFunction{{0, 1, 2 - h, 2, 4, 5}, {0, 1, 8, 8, 64, 3}});
  for (double x = -1; x <= 6; x += 0.1) EXPECT_NEAR(close.value(x), twice.value(x), 1e-3) << x;
  EXPECT_NEAR(twice.evaluate(2).slope, 0, 1e-4);
  EXPECT_NEAR(twice.evaluate(2 - 1e-12).slope, 0, 1e-4);
  EXPECT_DOUBLE_EQ(twice.value(2), 8);
}

TEST(CubicSpline, CountsAPointGivenTwiceAtAnEndOnce) {
  const CubicSpline once(SplineFunction{{0, 1, 2, 4, 5}, {0, 1, 8, 64, 3}});
  const CubicSpline twice(SplineFunction{{0, 0, 1, 2, 4, 5, 5}, {0, 0, 1, 8, 64, 3, 3}});
  for (double x = -1; x <= 6; x += 0.1) EXPECT_EQ(once.value(x), twice.value(x));
}

TEST(CubicSpline, HasContinuousSlopeAndCurvatureInside) {
  const SplineFunction f = support::elbowCurves().activeForceLength;
  const CubicSpline spline(f);
  for (std::size_t i = 1; i + 1 < f.x.size(); ++i) {
    const double tiny = 1e-12;
    const CurveValue left = spline.evaluate(f.x[i] - tiny);
    const CurveValue right = spline.evaluate(f.x[i] + tiny);
    EXPECT_NEAR(left.slope, right.slope, 1e-8);
    EXPECT_NEAR(left.curvature, right.curvature, 1e-5);
  }
}

TEST(CubicSpline, DerivativesAgreeWithDifferencesAndWithTheScalarType) {
  const CubicSpline spline(support::elbowCurves().activeForceLength);
  const auto value = [&](double x) { return spline.value(x); };
  const auto slope = [&](double x) { return spline.evaluate(x).slope; };
  using First = info::Dual<1>;
  using Second = info::Dual<1, First>;
  for (double x = 0.45; x < 1.6; x += 0.0317) {
    const CurveValue y = spline.evaluate(x);
    EXPECT_EQ(y.value, spline.value(x));
    EXPECT_NEAR(y.slope, support::centralDifference(value, x, 1e-5), 1e-8);
    EXPECT_NEAR(y.curvature, support::centralDifference(slope, x, 1e-5), 1e-6);
    const Second t(First(x, 1, 0), 1, 0);
    const Second dual = spline.value(t);
    EXPECT_NEAR(dual.value().derivatives()[0], y.slope, 1e-12);
    EXPECT_NEAR(dual.derivatives()[0].derivatives()[0], y.curvature, 1e-11);
  }
}

TEST(CubicSpline, NanInGivesNanOut) {
  const CubicSpline spline(support::elbowCurves().activeForceLength);
  const CurveValue y = spline.evaluate(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(std::isnan(y.value));
  EXPECT_TRUE(std::isnan(spline.value(std::numeric_limits<double>::quiet_NaN())));
}

TEST(CubicSpline, RefusesPointsThatNoCurveCanHave) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const SplineFunction& points, const char* words) {
    support::throwsSaying([&] { CubicSpline{points}; }, words);
  };
  refused({{0}, {0}}, "needs at least 2 different points, has 1");
  refused({{1, 1}, {2, 2}}, "needs at least 2 different points, has 1");
  refused({{0, 1}, {0}}, "2 values of x but 1 of y");
  refused({{0, 2, 1}, {0, 1, 2}}, "x must rise, but 1 follows 2 at point 3");
  refused({{0, 1, 1}, {0, 1, 2}}, "two values, 1 and 2, at x = 1");
  refused({{0, nan}, {0, 1}}, "point 2 is (nan, 1), must be finite");
  refused({{0, 1}, {0, nan}}, "point 2 is (1, nan), must be finite");
}

TEST(PiecewiseLinear, ConnectsItsPointsAndGoesOnOutside) {
  const PiecewiseLinear f(PiecewiseLinearFunction{{-1, 0, 2}, {3, 1, 2}});
  EXPECT_DOUBLE_EQ(f.value(-0.5), 2);
  EXPECT_DOUBLE_EQ(f.value(1.0), 1.5);
  EXPECT_DOUBLE_EQ(f.value(4.0), 3);
  EXPECT_DOUBLE_EQ(f.value(-2.0), 5);
  EXPECT_DOUBLE_EQ(f.evaluate(-0.5).slope, -2);
  EXPECT_DOUBLE_EQ(f.evaluate(1.5).slope, 0.5);
  EXPECT_EQ(f.evaluate(1.5).curvature, 0);
}

TEST(FunctionEvaluator, EvaluatesEveryKindWithItsScale) {
  const double x = 0.7;
  const auto at = [&](double scale, auto shape) {
    return FunctionEvaluator(Function{scale, shape}).evaluate(x);
  };
  const CurveValue constant = at(2, ConstantFunction{3});
  EXPECT_DOUBLE_EQ(constant.value, 6);
  EXPECT_EQ(constant.slope, 0);
  const CurveValue linear = at(-2, LinearFunction{3, 0.5});
  EXPECT_DOUBLE_EQ(linear.value, -2 * (3 * x + 0.5));
  EXPECT_DOUBLE_EQ(linear.slope, -6);
  const CurveValue polynomial = at(2, PolynomialFunction{{1, -2, 0.5, 4, -1}});
  EXPECT_NEAR(polynomial.value, 2 * (std::pow(x, 4) - 2 * std::pow(x, 3) + 0.5 * x * x + 4 * x - 1),
              1e-14);
  EXPECT_NEAR(polynomial.slope, 2 * (4 * std::pow(x, 3) - 6 * x * x + x + 4), 1e-14);
  EXPECT_NEAR(polynomial.curvature, 2 * (12 * x * x - 12 * x + 1), 1e-13);
  const CurveValue spline = at(3, SplineFunction{{0, 1, 2, 4}, {0, 1, 8, 64}});
  EXPECT_NEAR(spline.value, 3 * x * x * x, 1e-13);
  EXPECT_NEAR(spline.slope, 9 * x * x, 1e-12);
  EXPECT_NEAR(spline.curvature, 18 * x, 1e-12);
  const CurveValue sine = at(2, SineFunction{0.5, 3, 0.2, 1});
  EXPECT_NEAR(sine.value, 2 * (0.5 * std::sin(3 * x + 0.2) + 1), 1e-14);
  EXPECT_NEAR(sine.slope, 3 * std::cos(3 * x + 0.2), 1e-14);
  EXPECT_NEAR(sine.curvature, -9 * std::sin(3 * x + 0.2), 1e-14);
  EXPECT_NEAR(sine.third, -27 * std::cos(3 * x + 0.2), 1e-13);
  const CurveValue polyline = at(3, PiecewiseLinearFunction{{0, 1}, {0, 2}});
  EXPECT_NEAR(polyline.value, 6 * x, 1e-14);
  EXPECT_NEAR(polyline.slope, 6, 1e-14);
}

TEST(FunctionEvaluator, GivesTheSameThroughTheScalarType) {
  using First = info::Dual<1>;
  for (const Function& f : {Function{2, ConstantFunction{3}}, Function{-1, LinearFunction{2, 1}},
                            Function{2, PolynomialFunction{{1, -2, 0.5, 4, -1}}},
                            Function{2, SineFunction{0.5, 3, 0.2, 1}},
                            Function{0.5, SplineFunction{{0, 1, 2, 4, 5}, {0, 1, 8, 64, 2}}},
                            Function{1.5, PiecewiseLinearFunction{{0, 1, 2}, {0, 2, 1}}}}) {
    const FunctionEvaluator evaluator(f);
    for (const double x : {-0.3, 0.7, 1.9, 6.0}) {
      const CurveValue y = evaluator.evaluate(x);
      const First dual = evaluator.value(First(x, 1, 0));
      EXPECT_NEAR(dual.value(), y.value, 1e-12 * (1 + std::abs(y.value)));
      EXPECT_NEAR(dual.derivatives()[0], y.slope, 1e-12 * (1 + std::abs(y.slope)));
    }
  }
}

TEST(FunctionEvaluator, HoldsItsArgumentWithinLowAndHigh) {
  using First = info::Dual<1>;
  const std::vector<Function> functions{{0.5, SplineFunction{{0, 1, 2, 4, 5}, {0, 1, 8, 64, 2}}},
                                        {2, LinearFunction{3, 1}},
                                        {1, SineFunction{0.5, 3, 0.2, 1}},
                                        {1, PolynomialFunction{{1, -2, 0.5, 4, -1}}}};
  for (const Function& free : functions) {
    for (const auto& [low, high] : {std::pair{0.5, 4.5}, {1.2, 1.8}, {-1.0, 2.0}}) {
      Function held = free;
      held.low = low;
      held.high = high;
      const FunctionEvaluator evaluator(held), unheld(free);
      for (const double x : {-3.0, 0.7, 1.25, 1.5, 1.75, 4.6, 9.0}) {
        const bool isInside = low <= x && x <= high;
        const CurveValue y = evaluator.evaluate(x);
        const CurveValue expected = unheld.evaluate(std::clamp(x, low, high));
        EXPECT_NEAR(y.value, expected.value, 1e-14 * (1 + std::abs(expected.value))) << x;
        EXPECT_EQ(y.slope, isInside ? expected.slope : 0) << x;
        const First dual = evaluator.value(First(x, 1, 0));
        EXPECT_NEAR(dual.value(), y.value, 1e-12 * (1 + std::abs(y.value)));
        EXPECT_NEAR(dual.derivatives()[0], y.slope, 1e-12 * (1 + std::abs(y.slope)));
      }
    }
  }
  Function wrong = functions[0];
  wrong.low = 2;
  wrong.high = 1;
  support::throwsSaying([&] { FunctionEvaluator{wrong}; }, "must not fall");
}

// Steps and leaps over splines, a polyline and a curve without knots; borders, ends, no number.
TEST(PiecewiseCubic, IsTheSameWhicheverPieceHeldTheLastX) {
  const SchutteParameters p = support::elbowCurves();
  const PiecewiseCubic endless({}, {{1, 2, 3, 4, 5}});
  const double infinity = std::numeric_limits<double>::infinity();
  for (const PiecewiseCubic& curve :
       {PiecewiseCubic(CubicSpline(p.tendonForceLength)),
        PiecewiseCubic(CubicSpline(p.activeForceLength)),
        PiecewiseCubic(PiecewiseLinear({{0, 1, 3}, {2, -1, 0}})), endless}) {
    PiecewiseCubic::Piece last;
    EXPECT_FALSE(last.holds(0));
    std::vector<double> xs;
    for (const double knot : curve.knots()) {
      for (const double x : {knot, std::nextafter(knot, -9), knot, knot + 0.3, knot - 0.01}) {
        xs.push_back(x);
      }
    }
    xs.insert(xs.end(), {-5, -5.1, 40, 41, -infinity, 0.7, infinity, 0.7});
    for (const double x : xs) {
      const CurveValue expected = curve.evaluate(x), found = curve.evaluate(x, last);
      EXPECT_EQ(last.segment, &curve.segmentAt(x)) << x;
      if (!std::isfinite(x)) continue;
      EXPECT_EQ(found.value, expected.value) << x;
      EXPECT_EQ(found.slope, expected.slope) << x;
      EXPECT_EQ(found.curvature, expected.curvature) << x;
      EXPECT_EQ(found.third, expected.third) << x;
      EXPECT_TRUE(last.holds(x)) << x;
      EXPECT_TRUE(std::isnan(curve.evaluate(std::nan(""), last).value));
      curve.evaluate(x, last);
    }
  }
}

}  // namespace
}  // namespace bio
