#include "info/autodiff/recorded_function.h"

#include <gtest/gtest.h>

#include <cmath>

#include "info/autodiff/derivatives.h"

namespace {

using namespace info;

// Eigen's nested scalar has no power; for the reference it is spelt by logarithm and exponential.
Symbol power(const Symbol& x) {
  return pow(x, 2.5);
}
template <class T>
T power(const T& x) {
  using std::exp, std::log;
  const T exponent = 2.5 * log(x);
  return exp(exponent);
}

template <class T>
Vector<T, 1> everyOperation(const Vector<T, 3>& operands) {
  using std::cos, std::exp, std::log, std::sin, std::sqrt, std::tanh;
  const T a = operands[0] * operands[1] - operands[2] / operands[0], b = sin(a) + cos(operands[1]),
          c = exp(-operands[2]) * log(operands[0]);
  const T d = sqrt(operands[1] + 2.0) / (1.0 + operands[2] * operands[2]),
          e = tanh(operands[0] - operands[2]), g = power(operands[1]);
  const T h = 3.0 - operands[0], k = 2.0 / operands[1], l = b * b;
  Vector<T, 1> y;
  y << l + c * d - e * g + h * k;
  return y;
}

const Vector<double, 3> operands{0.7, 1.3, -0.4};

struct Recorded {
  Recording recording;
  Vector<Symbol, 3> x;
  Symbol y;
  Recorded() {
    for (auto& s : x) s = recording.argument();
    y = everyOperation(x)[0];
  }
  double value(const Symbol& s) {
    double out = NAN;
    const Symbol outputs[] = {s};
    RecordedFunction(recording, outputs).evaluate(operands.data(), &out);
    return out;
  }
};

TEST(RecordedFunction, HasTheValueOfTheFunction) {
  Recorded f;
  EXPECT_NEAR(f.value(f.y), everyOperation(operands)[0], 1e-15);
}

TEST(RecordedFunction, DerivativesOfFirstAndSecondOrderEqualAutomaticDifferentiation) {
  Recorded f;
  const auto function = []<class T>(const Vector<T, 3>& at) { return everyOperation(at); };
  const auto gradient = jacobian(function, operands);
  const auto hessian = contractedHessian(function, operands, Vector<double, 1>(1.0));
  for (int i = 0; i < 3; ++i) {
    const Symbol first = f.recording.derivative(f.y, f.x[i]);
    EXPECT_NEAR(f.value(first), gradient(0, i), 1e-12);
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(f.value(f.recording.derivative(first, f.x[j])), hessian(i, j), 1e-12);
  }
}

TEST(RecordedFunction, ThirdDerivativesEqualFiniteDifferencesOfTheSecond) {
  Recorded f;
  const auto function = []<class T>(const Vector<T, 3>& at) { return everyOperation(at); };
  const auto second = [&](const Vector<double, 3>& at) {
    const auto hessian = contractedHessian(function, at, Vector<double, 1>(1.0));
    return Vector<double, 3>(hessian(0, 0), hessian(0, 1), hessian(1, 2));
  };
  const auto expected = finiteDifferenceJacobian(second, operands);
  const int pairs[3][2] = {{0, 0}, {0, 1}, {1, 2}};
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j) {
      const Symbol s = f.recording.derivative(
          f.recording.derivative(f.recording.derivative(f.y, f.x[pairs[k][0]]), f.x[pairs[k][1]]),
          f.x[j]);
      EXPECT_NEAR(f.value(s), expected(k, j), 1e-7 * std::max(1.0, std::abs(expected(k, j))));
    }
}

TEST(RecordedFunction, WritesEveryOperationOnceAndNoneForAZero) {
  Recording r;
  const Symbol a = r.argument(), b = r.argument();
  const Symbol outputs[] = {sin(a) * b + sin(a) * b, b * sin(a), r.derivative(cos(a), b)};
  const RecordedFunction f(r, outputs);
  EXPECT_EQ(f.operationCount(), 3);  // sine, product, sum
  const double in[] = {0.3, 2.0};
  double out[3];
  f.evaluate(in, out);
  EXPECT_DOUBLE_EQ(out[0], 4.0 * std::sin(0.3));
  EXPECT_DOUBLE_EQ(out[1], 2.0 * std::sin(0.3));
  EXPECT_EQ(out[2], 0.0);
}

TEST(RecordedFunction, RefusesTargetsThatDoNotMatchItsOutputs) {
  Recording r;
  const Symbol outputs[] = {r.argument()};
  EXPECT_THROW(RecordedFunction(r, outputs, {0, 1}), std::invalid_argument);
}

}  // namespace
