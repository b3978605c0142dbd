#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "bio/model/model.h"
#include "bio/muscle/curves/curves.h"
#include "bio/skeleton/skeleton.h"

namespace bio {

/// Value, slopes and second derivatives of a function of a few numbers.
struct PolynomialValue {
  static constexpr std::size_t most = MultivariatePolynomial::maxDimension;
  double value = 0;
  std::array<double, most> first{};                     ///< ∂/∂x_i
  std::array<std::array<double, most>, most> second{};  ///< ∂²/∂x_i∂x_j
};

/// The polynomial at x by Horner's rule in each argument, nested: with p_e the polynomial of the
/// later arguments that multiplies x₁^e,
///     p = (…(p_n x₁ + p_(n−1)) x₁ + …) x₁ + p₀
/// and so for each p_e. Exact derivatives by the product rule; allocates nothing.
/// @param x  as many numbers as it has arguments
PolynomialValue evaluate(const MultivariatePolynomial& polynomial, const double* x);

/// The length of a path as a function of coordinates (PathFunction), over the free coordinates of a
/// skeleton: its arguments may be free, locked, or coupled to free ones.
class LengthFunction {
 public:
  /// @throws std::invalid_argument unknown coordinates, what
  ///   MultivariatePolynomial::requireRules throws, a number of
  ///   coordinates that is not the number of arguments
  LengthFunction(const PathFunction& given, const Skeleton& skeleton);

  /// Indices of the free coordinates that change it, rising.
  const std::vector<int>& support() const { return support_; }

  struct Value {
    double length = 0;  ///< [m]
    /// Over the support [m/rad] and [m/rad²].
    std::array<double, PolynomialValue::most> first{};
    std::array<std::array<double, PolynomialValue::most>, PolynomialValue::most> second{};
  };
  /// By the chain rule through the couplers. Allocates nothing.
  /// @param q  of all free coordinates
  Value at(const double* q) const;

 private:
  struct Argument {
    int slot = -1;  ///< in the support, −1: constant
    int freeIndex = -1;
    double constant = 0;
    FunctionEvaluator coupling;
  };
  std::variant<MultivariatePolynomial, FunctionEvaluator> function_;
  std::vector<Argument> arguments_;
  std::vector<int> support_;
};

}  // namespace bio
