#pragma once

#include <limits>
#include <variant>
#include <vector>

/// Functions of one variable, as model files give them.
namespace bio {

struct ConstantFunction {
  double value = 0;
  friend bool operator==(const ConstantFunction&, const ConstantFunction&) = default;
};
/// slope·x + intercept
struct LinearFunction {
  double slope = 1;
  double intercept = 0;
  friend bool operator==(const LinearFunction&, const LinearFunction&) = default;
};
/// Interpolating cubic spline with Forsythe–Malcolm–Moler ends, linear outside (curves.h).
struct SplineFunction {
  std::vector<double> x;  ///< strictly rising, at least 2
  std::vector<double> y;
  friend bool operator==(const SplineFunction&, const SplineFunction&) = default;
};
/// Straight lines between the points, extended outside.
struct PiecewiseLinearFunction {
  std::vector<double> x;  ///< strictly rising, at least 2
  std::vector<double> y;
  friend bool operator==(const PiecewiseLinearFunction&, const PiecewiseLinearFunction&) = default;
};
/// Σ_i c_i x^(n−i): highest power first, as OpenSim writes it.
struct PolynomialFunction {
  std::vector<double> coefficients;
  friend bool operator==(const PolynomialFunction&, const PolynomialFunction&) = default;
};

/// amplitude·sin(omega·x + phase) + offset
struct SineFunction {
  double amplitude = 1;
  double omega = 1;  ///< [rad per unit of x]
  double phase = 0;  ///< [rad]
  double offset = 0;
  friend bool operator==(const SineFunction&, const SineFunction&) = default;
};

/// scale · shape(x), x held within low … high; nested MultiplierFunctions are multiplied out into
/// `scale`.
struct Function {
  double scale = 1;
  std::variant<ConstantFunction, LinearFunction, SplineFunction, PiecewiseLinearFunction,
               PolynomialFunction, SineFunction>
      shape;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  friend bool operator==(const Function&, const Function&) = default;
};

}  // namespace bio
