#include "bio/path/length_function.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

namespace bio {
namespace {

/// The polynomial of order `order` in the arguments from `k` on.
/// @param end  behind its last coefficient; becomes its first one
void nestedHorner(std::size_t k, std::size_t dimension, int order, const double* x,
                  const double*& end, PolynomialValue& out) {
  const double x_k = x[k];
  if (k + 1 == dimension) {
    double value = 0, slope = 0, halfCurvature = 0;
    for (int e = order; e >= 0; --e) {
      halfCurvature = halfCurvature * x_k + slope;
      slope = slope * x_k + value;
      value = value * x_k + *--end;
    }
    out.value = value;
    out.first[k] = slope;
    out.second[k][k] = 2 * halfCurvature;
    return;
  }
  out = {};
  PolynomialValue inner;
  for (int e = order; e >= 0; --e) {
    nestedHorner(k + 1, dimension, order - e, x, end, inner);
    out.second[k][k] = out.second[k][k] * x_k + 2 * out.first[k];
    out.first[k] = out.first[k] * x_k + out.value;
    for (std::size_t i = k + 1; i < dimension; ++i) {
      out.second[k][i] = out.second[k][i] * x_k + out.first[i];
      out.first[i] = out.first[i] * x_k + inner.first[i];
      for (std::size_t j = i; j < dimension; ++j) {
        out.second[i][j] = out.second[i][j] * x_k + inner.second[i][j];
      }
    }
    out.value = out.value * x_k + inner.value;
  }
}

PolynomialValue valueOf(const FunctionEvaluator& function, const double* x) {
  const CurveValue y = function.evaluate(x[0]);
  PolynomialValue out;
  out.value = y.value;
  out.first[0] = y.slope;
  out.second[0][0] = y.curvature;
  return out;
}

std::size_t argumentsOf(const PathFunction& given) {
  const auto* polynomial = std::get_if<MultivariatePolynomial>(&given.length);
  if (polynomial) polynomial->requireRules();
  return polynomial ? static_cast<std::size_t>(polynomial->dimension) : 1;
}

}  // namespace

PolynomialValue evaluate(const MultivariatePolynomial& polynomial, const double* x) {
  PolynomialValue out;
  const auto dimension = static_cast<std::size_t>(polynomial.dimension);
  const double* end = polynomial.coefficients.data() + polynomial.coefficients.size();
  nestedHorner(0, dimension, polynomial.order, x, end, out);
  for (std::size_t i = 0; i < dimension; ++i) {
    for (std::size_t j = 0; j < i; ++j) out.second[i][j] = out.second[j][i];
  }
  return out;
}

LengthFunction::LengthFunction(const PathFunction& given, const Skeleton& skeleton)
    : function_(MultivariatePolynomial{}) {
  if (const auto* plain = std::get_if<Function>(&given.length)) {
    function_ = FunctionEvaluator(*plain);
  } else {
    function_ = std::get<MultivariatePolynomial>(given.length);
  }
  if (argumentsOf(given) != given.coordinates.size()) {
    throw std::invalid_argument(
        fmt::format("a length function of {} arguments is given {} "
                    "coordinates, must be as many",
                    argumentsOf(given), given.coordinates.size()));
  }
  std::set<int> support;
  for (const std::string& name : given.coordinates) {
    const Skeleton::CoordinateSource& source = skeleton.sourceOf(name);
    arguments_.push_back({-1, source.freeIndex, source.value, source.coupling});
    if (source.freeIndex >= 0) support.insert(source.freeIndex);
  }
  support_.assign(support.begin(), support.end());
  for (Argument& argument : arguments_) {
    if (argument.freeIndex < 0) continue;
    const auto at = std::lower_bound(support_.begin(), support_.end(), argument.freeIndex);
    argument.slot = static_cast<int>(at - support_.begin());
  }
}

LengthFunction::Value LengthFunction::at(const double* q) const {
  std::array<double, PolynomialValue::most> x{};
  std::array<CurveValue, PolynomialValue::most> inner{};
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    const Argument& argument = arguments_[i];
    if (argument.slot >= 0) inner[i] = argument.coupling.evaluate(q[argument.freeIndex]);
    x[i] = argument.slot >= 0 ? inner[i].value : argument.constant;
  }
  const auto* polynomial = std::get_if<MultivariatePolynomial>(&function_);
  const PolynomialValue p = polynomial ? evaluate(*polynomial, x.data())
                                       : valueOf(std::get<FunctionEvaluator>(function_), x.data());
  Value out;
  out.length = p.value;
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    if (arguments_[i].slot < 0) continue;
    const auto a = static_cast<std::size_t>(arguments_[i].slot);
    out.first[a] += p.first[i] * inner[i].slope;
    out.second[a][a] += p.first[i] * inner[i].curvature;
    for (std::size_t j = 0; j < arguments_.size(); ++j) {
      if (arguments_[j].slot < 0) continue;
      const auto b = static_cast<std::size_t>(arguments_[j].slot);
      out.second[a][b] += p.second[i][j] * inner[i].slope * inner[j].slope;
    }
  }
  return out;
}

}  // namespace bio
