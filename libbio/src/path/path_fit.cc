#include "bio/path/path_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "bio/path/length_function.h"

namespace bio {
namespace {

constexpr double slopeWeight = 0.25;
constexpr std::size_t mostTerms = 1300;

using Exponents = std::array<int, MultivariatePolynomial::maxDimension>;

/// In the order of MultivariatePolynomial.
std::vector<Exponents> exponentsOf(std::size_t dimension, int order) {
  std::vector<Exponents> all;
  Exponents e{};
  const auto add = [&](const auto& self, std::size_t k, int left) -> void {
    if (k == dimension) return all.push_back(e);
    for (e[k] = 0; e[k] <= left; ++e[k]) self(self, k + 1, left - e[k]);
    e[k] = 0;
  };
  add(add, 0, order);
  return all;
}

/// Legendre's polynomials and their slopes at u: P′_(n+1) = P′_(n−1) + (2n + 1) P_n.
struct Legendre {
  std::array<double, 10> value{}, slope{};
  Legendre(double u, int order) {
    value[0] = 1;
    if (order == 0) return;
    value[1] = u;
    slope[1] = 1;
    for (std::size_t n = 1; n < static_cast<std::size_t>(order); ++n) {
      const auto x = static_cast<double>(n);
      value[n + 1] = ((2 * x + 1) * u * value[n] - x * value[n - 1]) / (x + 1);
      slope[n + 1] = slope[n - 1] + (2 * x + 1) * value[n];
    }
  }
};

/// u = (q − middle)/half
struct Scale {
  double middle = 0, half = 1;
};

std::vector<Scale> scalesOf(const SampledPath& path) {
  std::vector<Scale> scales;
  for (Eigen::Index i = 0; i < path.q.cols(); ++i) {
    const double low = path.q.col(i).minCoeff(), high = path.q.col(i).maxCoeff();
    if (!(high > low)) {
      throw std::invalid_argument(fmt::format("coordinate '{}' does not vary",
                                              path.coordinates[static_cast<std::size_t>(i)]));
    }
    scales.push_back({(low + high) / 2, (high - low) / 2});
  }
  return scales;
}

/// The equations of a posture: its length, and its slopes if they are known.
class Equations {
 public:
  Equations(const SampledPath& path, const std::vector<Scale>& scales, int order)
      : path_(path), scales_(scales), order_(order), terms_(exponentsOf(scales.size(), order)) {}

  std::size_t numTerms() const { return terms_.size(); }

  /// Coefficients of products of Legendre's polynomials.
  Eigen::VectorXd solve() const {
    constexpr Eigen::Index block = 512;
    const auto n = static_cast<Eigen::Index>(terms_.size());
    const Eigen::Index perPosture = 1 + path_.slope.rows() / path_.q.rows() * path_.q.cols();
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd rows(n, block);  // an equation in each column
    Eigen::VectorXd wanted(block);
    Eigen::Index used = 0;
    const auto flush = [&] {
      normal.selfadjointView<Eigen::Lower>().rankUpdate(rows.leftCols(used));
      right.noalias() += rows.leftCols(used) * wanted.head(used);
      used = 0;
    };
    for (Eigen::Index k = 0; k < path_.q.rows(); ++k) {
      if (used + perPosture > block) flush();
      used += add(k, rows, wanted, used);
    }
    flush();
    return normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
  }

 private:
  Eigen::Index add(Eigen::Index k, Eigen::MatrixXd& rows, Eigen::VectorXd& wanted,
                   Eigen::Index from) const {
    const std::size_t d = scales_.size();
    std::vector<Legendre> at;
    for (std::size_t i = 0; i < d; ++i) {
      const double q = path_.q(k, static_cast<Eigen::Index>(i));
      at.emplace_back((q - scales_[i].middle) / scales_[i].half, order_);
    }
    const std::size_t equations = path_.slope.rows() > 0 ? d + 1 : 1;
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      for (std::size_t equation = 0; equation < equations; ++equation) {
        double product = equation == 0 ? 1 : slopeWeight;
        for (std::size_t i = 0; i < d; ++i) {
          const auto e = static_cast<std::size_t>(terms_[t][i]);
          product *= equation == i + 1 ? at[i].slope[e] : at[i].value[e];
        }
        rows(static_cast<Eigen::Index>(t), from + static_cast<Eigen::Index>(equation)) = product;
      }
    }
    wanted[from] = path_.length[k];
    for (std::size_t i = 0; i + 1 < equations; ++i) {
      const auto c = static_cast<Eigen::Index>(i);
      wanted[from + 1 + c] = slopeWeight * scales_[i].half * path_.slope(k, c);
    }
    return static_cast<Eigen::Index>(equations);
  }

  const SampledPath& path_;
  const std::vector<Scale>& scales_;
  int order_;
  std::vector<Exponents> terms_;
};

/// Row n: P_n((q − middle)/half) as coefficients of 1, q, q², …
std::vector<std::vector<double>> powersOf(const Scale& scale, int order) {
  const auto size = static_cast<std::size_t>(order) + 1;
  std::vector<std::vector<double>> P(size, std::vector<double>(size, 0.0));
  const double a = 1 / scale.half, b = -scale.middle / scale.half;  // u = a q + b
  P[0][0] = 1;
  if (order == 0) return P;
  P[1][0] = b;
  P[1][1] = a;
  for (std::size_t n = 1; n + 1 < size; ++n) {
    const auto x = static_cast<double>(n);
    for (std::size_t k = 0; k <= n + 1; ++k) {
      const double uP = b * P[n][k] + (k > 0 ? a * P[n][k - 1] : 0);
      P[n + 1][k] = ((2 * x + 1) * uP - x * P[n - 1][k]) / (x + 1);
    }
  }
  return P;
}

/// One argument after the other, from Legendre's polynomials to powers.
std::vector<double> inPowers(const Eigen::VectorXd& coefficients, const std::vector<Scale>& scales,
                             int order) {
  const std::vector<Exponents> terms = exponentsOf(scales.size(), order);
  std::map<Exponents, std::size_t> indices;
  for (std::size_t t = 0; t < terms.size(); ++t) indices[terms[t]] = t;
  std::vector<double> now(coefficients.begin(), coefficients.end());
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const auto P = powersOf(scales[i], order);
    std::vector<double> next(now.size(), 0.0);
    for (std::size_t t = 0; t < terms.size(); ++t) {
      Exponents lower = terms[t];
      for (int k = 0; k <= terms[t][i]; ++k) {
        lower[i] = k;
        next[indices.at(lower)] +=
            now[t] * P[static_cast<std::size_t>(terms[t][i])][static_cast<std::size_t>(k)];
      }
    }
    now = std::move(next);
  }
  return now;
}

/// Adds the errors over a path's postures; rms holds sums of squares.
void addErrors(const MultivariatePolynomial& polynomial, const SampledPath& path, PathFit& fit) {
  for (Eigen::Index k = 0; k < path.q.rows(); ++k) {
    const Eigen::VectorXd q = path.q.row(k);
    const PolynomialValue p = evaluate(polynomial, q.data());
    const double off = std::abs(p.value - path.length[k]);
    fit.length.rms += off * off;
    fit.length.largest = std::max(fit.length.largest, off);
    for (Eigen::Index i = 0; i < path.slope.cols() && path.slope.rows() > 0; ++i) {
      const double askew = std::abs(p.first[static_cast<std::size_t>(i)] - path.slope(k, i));
      fit.arm.rms += askew * askew;
      fit.arm.largest = std::max(fit.arm.largest, askew);
    }
  }
}

PathFit judged(MultivariatePolynomial polynomial, const SampledPath& fitted,
               const SampledPath& held, double tolerance) {
  PathFit fit;
  addErrors(polynomial, fitted, fit);
  addErrors(polynomial, held, fit);
  fit.postures = static_cast<std::size_t>(fitted.q.rows() + held.q.rows());
  fit.length.rms = std::sqrt(fit.length.rms / static_cast<double>(fit.postures));
  const auto arms = static_cast<double>(fitted.slope.size() + held.slope.size());
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  fit.arm =
      arms > 0 ? FitError{std::sqrt(fit.arm.rms / arms), fit.arm.largest} : FitError{nan, nan};
  fit.meetsTolerance = fit.length.largest <= tolerance;
  fit.function = {fitted.coordinates, std::move(polynomial)};
  return fit;
}

}  // namespace

PathFit fitPolynomial(const SampledPath& fitted, const SampledPath& held,
                      const PathFitOptions& options) {
  const auto dimension = static_cast<int>(fitted.coordinates.size());
  if (dimension < 1 || dimension > MultivariatePolynomial::maxDimension) {
    throw std::invalid_argument(fmt::format("{} coordinates change it, must be 1 to {}", dimension,
                                            MultivariatePolynomial::maxDimension));
  }
  if (!(options.tolerance > 0) || options.maxOrder < 1 || options.maxOrder > 9) {
    throw std::invalid_argument(fmt::format("tolerance {} m, order {}: must be > 0, 1 to 9",
                                            options.tolerance, options.maxOrder));
  }
  const auto equations = static_cast<std::size_t>(fitted.length.size() + fitted.slope.size());
  const auto fits = [&](int order) {
    const std::size_t terms = *MultivariatePolynomial::numTerms(dimension, order);
    return terms <= mostTerms && 2 * terms <= equations;
  };
  if (!fits(1)) {
    throw std::invalid_argument(
        fmt::format("{} postures are too few for {} coordinates", fitted.length.size(), dimension));
  }
  const std::vector<Scale> scales = scalesOf(fitted);
  PathFit best;
  for (int order = 1; order <= options.maxOrder && fits(order); ++order) {
    const Eigen::VectorXd solved = Equations(fitted, scales, order).solve();
    PathFit fit = judged({dimension, order, inPowers(solved, scales, order)}, fitted, held,
                         options.tolerance);
    if (!(fit.length.largest >= best.length.largest) || order == 1) best = std::move(fit);
    if (best.meetsTolerance) break;
  }
  return best;
}

}  // namespace bio
