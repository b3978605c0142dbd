#include "info/autodiff/dual.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/AutoDiff>

namespace {

using info::Dual;

/// Every operation once, in ordinary arithmetic.
struct Everything {
  template <class T>
  T operator()(const T& x, const T& y) const {
    using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos, std::cosh, std::exp,
        std::log, std::pow, std::sin, std::sinh, std::sqrt, std::tan, std::tanh;
    const T sum = 2.0 + x - y * 0.5 + 3.0 * x * y;
    const T quotient = (1.0 - x) / (y + 2.0) + 1.0 / (x + 4.0) - (y - 1.0) / 3.0;
    const T circular = sin(x) * cos(y) + tan(0.3 * x) + asin(0.4 * y) - acos(0.2 * x * y);
    const T angle = atan(x * y) + atan2(x - 0.1, y) + atan2(y, -x);
    const T growth = exp(0.2 * x) + log(3.0 + y) + sqrt(x * x + y * y) + pow(2.0 + x, 1.7);
    const T hyperbolic = sinh(0.5 * x) * cosh(y) + tanh(x - y) + abs(-x) + abs(y);
    T assigned = x;
    assigned += y;
    assigned *= x;
    assigned -= 2.0;
    assigned /= y;
    assigned *= 1.5;
    assigned /= 0.7;
    assigned += 0.1;
    assigned -= x;
    return sum * quotient + circular - angle * growth + hyperbolic / (4.0 + x) - (-assigned);
  }
};

constexpr double x0 = 0.6, y0 = 0.9;

TEST(Dual, HasTheFirstDerivativesOfEigensScalar) {
  using Eigens = Eigen::AutoDiffScalar<Eigen::Vector2d>;
  // Eigen's expressions have no atan2, abs or pow of an expression: one sample of what both know
  const auto common = []<class T>(const T& x, const T& y) -> T {
    using std::cos, std::exp, std::log, std::sin, std::sqrt, std::tanh;
    const T a = sin(x) * cos(y) + exp(x * y) / (y + 2.0);
    const T b = log(x + 3.0) - sqrt(x * x + y * y) * tanh(x - y);
    return a * b + 2.0 * x - y / 3.0;
  };
  const Eigens eigens = common(Eigens(x0, 2, 0), Eigens(y0, 2, 1));
  const Dual<2> ours = common(Dual<2>(x0, 2, 0), Dual<2>(y0, 2, 1));
  EXPECT_NEAR(ours.value(), eigens.value(), 1e-15);
  EXPECT_LT((ours.derivatives() - eigens.derivatives()).norm(), 1e-14);
}

TEST(Dual, HasTheDerivativesOfEveryOperation) {
  const Everything f;
  const Dual<2> image = f(Dual<2>(x0, 2, 0), Dual<2>(y0, 2, 1));
  EXPECT_EQ(image.value(), f(x0, y0));
  const double h = 1e-6;
  EXPECT_NEAR(image.derivatives()[0], (f(x0 + h, y0) - f(x0 - h, y0)) / (2 * h), 1e-8);
  EXPECT_NEAR(image.derivatives()[1], (f(x0, y0 + h) - f(x0, y0 - h)) / (2 * h), 1e-8);
}

TEST(Dual, NestsToSecondAndThirdDerivatives) {
  using One = Dual<2>;
  using Two = Dual<2, One>;
  using Three = Dual<1, Two>;
  const Everything f;
  const auto at = [&](double x, double y) {
    return f(Two(One(x, 2, 0), 2, 0), Two(One(y, 2, 1), 2, 1));
  };
  const Two image = at(x0, y0);
  const double h = 1e-5;
  const auto first = [&](double x, double y) {
    return f(One(x, 2, 0), One(y, 2, 1)).derivatives();
  };
  for (int j = 0; j < 2; ++j) {
    const double hx = j == 0 ? h : 0, hy = j == 1 ? h : 0;
    const Eigen::Vector2d column = (first(x0 + hx, y0 + hy) - first(x0 - hx, y0 - hy)) / (2 * h);
    for (int i = 0; i < 2; ++i)
      EXPECT_NEAR(image.derivatives()[j].derivatives()[i], column[i], 1e-7) << i << j;
  }
  EXPECT_NEAR(image.derivatives()[0].derivatives()[1], image.derivatives()[1].derivatives()[0],
              1e-13);
  const Three third = f(Three(Two(One(x0, 2, 0), 2, 0), 1, 0), Three(Two(One(y0, 2, 1), 2, 1)));
  EXPECT_NEAR(third.derivatives()[0].derivatives()[0].derivatives()[1],
              (at(x0 + h, y0) - at(x0 - h, y0)).derivatives()[0].derivatives()[1] / (2 * h), 1e-6);
}

TEST(Dual, OfAConstantHasNoDerivatives) {
  const Dual<3> x(2.0, 3, 1);
  const Dual<3> constant = 7.0;
  EXPECT_EQ(constant.derivatives(), Eigen::Vector3d::Zero());
  EXPECT_EQ((constant * x).derivatives(), Eigen::Vector3d(0, 7, 0));
  EXPECT_EQ((constant / 2 - 1 + 3 * constant).derivatives(), Eigen::Vector3d::Zero());
}

TEST(Dual, IsComparedByItsValue) {
  const Dual<1> small(1.0, 1, 0), large(2.0);
  EXPECT_TRUE(small < large && large > small && small <= 1.0 && 1.5 > small && small != large);
  EXPECT_TRUE(small == Dual<1>(1.0));
  EXPECT_FALSE(Dual<1>(std::numeric_limits<double>::quiet_NaN()) < large);
  EXPECT_FALSE(isfinite(Dual<1>(std::numeric_limits<double>::infinity())));
  EXPECT_TRUE(isnan(Dual<1>(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_EQ(std::max(small, large).value(), 2.0);
}

TEST(Dual, GoesThroughEigensLinearAlgebra) {
  // d(A⁻¹b)/dt = −A⁻¹ A′ A⁻¹ b
  using D = Dual<1>;
  const Eigen::Matrix2d A{{2, 0.5}, {-0.3, 1}}, slope{{0.2, -1}, {0.7, 0.1}};
  const Eigen::Vector2d b{1, -2};
  info::Matrix<D, 2, 2> moving;
  for (int i = 0; i < 4; ++i)
    moving.data()[i] = D(A.data()[i], Eigen::Matrix<double, 1, 1>(slope.data()[i]));
  const info::Vector<D, 2> solution = moving.partialPivLu().solve(b.cast<D>());
  const Eigen::Vector2d expected = -A.inverse() * slope * A.inverse() * b;
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(solution[i].derivatives()[0], expected[i], 1e-14);
  const info::Vector<D, 2> scaled = 2.0 * solution;
  EXPECT_NEAR(scaled.norm().value(), 2 * (A.inverse() * b).norm(), 1e-14);
}

}  // namespace
