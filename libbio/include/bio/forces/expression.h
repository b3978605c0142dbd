#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bio {

/// A formula in named variables, as ExpressionBasedCoordinateForce gives it: numbers, + − * / ^,
/// parentheses, and sqrt exp log sin cos tan asin acos atan sinh cosh tanh abs min max step
/// pow2-style powers (x^2). `step(x)` is 1 for x ≥ 0, else 0, as in OpenSim.
///
/// Compiled once into a postfix program and evaluated for any scalar type, including those of
/// automatic differentiation.
class Expression {
 public:
  /// @param text       the formula, e.g. "-10*q-5*qdot"
  /// @param variables  names in the order of `values` in evaluate()
  /// @throws std::invalid_argument syntax error or unknown name, with the position in the text
  Expression(const std::string& text, const std::vector<std::string>& variables);

  /// @param values one per variable
  template <class T>
  T evaluate(const T* values) const {
    T stack[maxDepth];
    std::size_t top = 0;
    for (const Instruction& instruction : program_) run(instruction, values, stack, top);
    return stack[0];
  }

  /// Whether the value is 0 for any values of the unknown variables, as long as every part of the
  /// formula is finite.
  /// @param known one per variable; empty: unknown
  bool vanishes(const std::vector<std::optional<double>>& known) const;

  const std::string& text() const { return text_; }

 private:
  static constexpr std::size_t maxDepth = 32;
  enum class Code {
    number,
    variable,
    negate,
    add,
    subtract,
    multiply,
    divide,
    power,
    sqrt,
    exp,
    log,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    sinh,
    cosh,
    tanh,
    abs,
    min,
    max,
    step
  };
  struct Instruction {
    Code code;
    double number = 0;
    std::size_t variable = 0;
  };
  class Parser;

  template <class T>
  static void run(const Instruction& instruction, const T* values, T* stack, std::size_t& top) {
    using std::acos, std::asin, std::cos, std::exp, std::log, std::sin, std::sqrt, std::tan;
    const auto unary = [&](auto&& function) { stack[top - 1] = T(function(stack[top - 1])); };
    const auto binary = [&](auto&& function) {
      stack[top - 2] = T(function(stack[top - 2], stack[top - 1]));
      --top;
    };
    switch (instruction.code) {
      case Code::number:
        stack[top++] = T(instruction.number);
        break;
      case Code::variable:
        stack[top++] = values[instruction.variable];
        break;
      case Code::negate:
        unary([](const T& x) { return T(-x); });
        break;
      case Code::add:
        binary([](const T& x, const T& y) { return T(x + y); });
        break;
      case Code::subtract:
        binary([](const T& x, const T& y) { return T(x - y); });
        break;
      case Code::multiply:
        binary([](const T& x, const T& y) { return T(x * y); });
        break;
      case Code::divide:
        binary([](const T& x, const T& y) { return T(x / y); });
        break;
      case Code::power:
        unary([&](const T& x) { return integerOrRealPower(x, instruction.number); });
        break;
      case Code::sqrt:
        unary([](const T& x) { return T(sqrt(x)); });
        break;
      case Code::exp:
        unary([](const T& x) { return T(exp(x)); });
        break;
      case Code::log:
        unary([](const T& x) { return T(log(x)); });
        break;
      case Code::sin:
        unary([](const T& x) { return T(sin(x)); });
        break;
      case Code::cos:
        unary([](const T& x) { return T(cos(x)); });
        break;
      case Code::tan:
        unary([](const T& x) { return T(tan(x)); });
        break;
      case Code::asin:
        unary([](const T& x) { return T(asin(x)); });
        break;
      case Code::acos:
        unary([](const T& x) { return T(acos(x)); });
        break;
      case Code::atan:
        unary([](const T& x) { return T(asin(x / sqrt(1.0 + x * x))); });
        break;
      case Code::sinh:
        unary([](const T& x) { return T(0.5 * (exp(x) - exp(-x))); });
        break;
      case Code::cosh:
        unary([](const T& x) { return T(0.5 * (exp(x) + exp(-x))); });
        break;
      case Code::tanh:
        unary([](const T& x) { return hyperbolicTangent(x); });
        break;
      case Code::abs:
        unary([](const T& x) { return x < 0.0 ? T(-x) : x; });
        break;
      case Code::min:
        binary([](const T& x, const T& y) { return y < x ? y : x; });
        break;
      case Code::max:
        binary([](const T& x, const T& y) { return x < y ? y : x; });
        break;
      case Code::step:
        unary([](const T& x) { return T(x < 0.0 ? 0.0 : 1.0); });
        break;
    }
  }

  /// Repeated products for whole exponents (exact derivatives at 0), else exp(n log x).
  template <class T>
  static T integerOrRealPower(const T& x, double exponent) {
    using std::exp, std::log;
    const double whole = std::round(exponent);
    if (whole != exponent || std::abs(whole) > 32) return T(exp(exponent * log(x)));
    T product(1.0);
    for (int i = 0; i < std::abs(static_cast<int>(whole)); ++i) product = T(product * x);
    return whole < 0 ? T(1.0 / product) : product;
  }

  /// 1 − 2/(e^{2x} + 1), which does not overflow to NaN.
  template <class T>
  static T hyperbolicTangent(const T& x) {
    using std::exp;
    if (x < 0.0) return T(2.0 / (exp(-2.0 * x) + 1.0) * -1.0 + 1.0) * -1.0;
    return T(2.0 / (exp(2.0 * x) + 1.0) * -1.0 + 1.0);
  }

  std::string text_;
  std::vector<Instruction> program_;
};

}  // namespace bio
