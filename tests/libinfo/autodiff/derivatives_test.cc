#include "info/autodiff/derivatives.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace info;

/// R^N → R³, coupled and curved in every pair of arguments.
struct Coupled {
  template <class T, int N>
  Vector<T, 3> operator()(const Vector<T, N>& z) const {
    using std::cos, std::exp, std::sin;
    T sum(0.0), wave(0.0), product(1.0);
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      const T scaled = z[i] * (1.0 + 0.1 * double(i));
      sum += scaled;
      wave += sin(scaled) * z[0];
      product *= 1.0 + 0.2 * z[i];
    }
    const T argument = -0.3 * sum;
    const T decay = exp(argument);
    Vector<T, 3> y;
    y << decay * product, wave * sum, cos(sum) + z[0] * product;
    return y;
  }
};

/// Central differences of central differences.
/// @param relativeStep h > 0; 1e-4 ≈ ε^(1/4) balances truncation and rounding
template <class F, int N, int Rows>
Matrix<double, N, N> finiteDifferenceHessian(const F& function, const Vector<double, N>& z,
                                             const Vector<double, Rows>& w,
                                             double relativeStep = 1e-4) {
  const auto gradient = [&](const Vector<double, N>& at) {
    const auto scalar = [&](const Vector<double, N>& y) {
      return Vector<double, 1>(w.dot(function(y)));
    };
    return Vector<double, N>(finiteDifferenceJacobian(scalar, at, relativeStep).transpose());
  };
  const Matrix<double, N, N> rough = finiteDifferenceJacobian(gradient, z, relativeStep);
  return 0.5 * (rough + rough.transpose());
}

template <int N>
Vector<double, N> point(Eigen::Index size) {
  Vector<double, N> z(size);
  for (Eigen::Index i = 0; i < size; ++i) z[i] = 0.3 * std::cos(1.7 * double(i));
  return z;
}

template <class Size>
class Derivatives : public testing::Test {};
/// few directions, several blocks of directions with a remainder, a size known at run time
template <int Fixed, int Length>
struct SizeOf {
  static constexpr int fixed = Fixed, length = Length;
};
using Sizes = testing::Types<SizeOf<3, 3>, SizeOf<11, 11>, SizeOf<Eigen::Dynamic, 6>>;
TYPED_TEST_SUITE(Derivatives, Sizes);

TYPED_TEST(Derivatives, JacobianEqualsItsFiniteDifferenceTwin) {
  const auto z = point<TypeParam::fixed>(TypeParam::length);
  const auto exact = differentiate(Coupled{}, z);
  const auto rough = finiteDifferenceJacobian(Coupled{}, z);
  EXPECT_LT((exact.value - Coupled{}(z)).norm(), 1e-15);
  EXPECT_LT((exact.jacobian - rough).cwiseAbs().maxCoeff(), 1e-9);
}

TYPED_TEST(Derivatives, ContractedHessianEqualsItsFiniteDifferenceTwinAndIsSymmetric) {
  const auto z = point<TypeParam::fixed>(TypeParam::length);
  const Vector<double, 3> w{0.7, -1.1, 0.4};
  const auto exact = contractedHessian(Coupled{}, z, w);
  EXPECT_LT((exact - finiteDifferenceHessian(Coupled{}, z, w)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((exact - exact.transpose()).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Derivatives, OfAKnownFunctionAreKnown) {
  const auto function = []<class T>(const Vector<T, 2>& z) {
    Vector<T, 1> y;
    y << z[0] * z[0] * z[1];
    return y;
  };
  const Vector<double, 2> z{3.0, 5.0};
  EXPECT_EQ(jacobian(function, z), (Matrix<double, 1, 2>(30.0, 9.0)));
  EXPECT_EQ(contractedHessian(function, z, Vector<double, 1>(2.0)),
            (Matrix<double, 2, 2>{{20.0, 12.0}, {12.0, 0.0}}));
}

TEST(FiniteDifferences, OfASystemAreOfSecondOrderInTheirStep) {
  const auto z = point<3>(3);
  const auto exact = jacobian(Coupled{}, z);
  const double coarse = (finiteDifferenceJacobian(Coupled{}, z, 2e-2) - exact).norm();
  const double fine = (finiteDifferenceJacobian(Coupled{}, z, 1e-2) - exact).norm();
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.02);
}

}  // namespace
