#include "info/design/robust_design.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace info {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

CandidatesCost candidatesCost(RobustRule rule, const InformationWeights& weights,
                              const std::vector<MatrixXd>& information, double repeatedTolerance) {
  if (information.empty()) throw std::invalid_argument("candidates: 0 of them, must be ≥ 1");
  const bool worst = rule == RobustRule::worst && information.size() > 1;
  if (worst && weights.d > 0)
    throw std::domain_error(
        fmt::format("worst case: weight of D in the objective is {}, must be 0, because −ln det I "
                    "may be negative; use the average",
                    weights.d));
  CandidatesCost out{0, {}};
  std::vector<double> costs;
  double largest = 0;
  for (const MatrixXd& one : information) {
    InformationCost cost = informationCost(weights, one, repeatedTolerance);
    costs.push_back(cost.value);
    largest = std::max(largest, cost.value);
    out.dvalue_dI.push_back(std::move(cost.dvalue_dI));
  }
  const double count = static_cast<double>(costs.size());
  if (!worst) {
    for (std::size_t s = 0; s < costs.size(); ++s) {
      out.value += costs[s] / count;
      out.dvalue_dI[s] /= count;
    }
    return out;
  }
  if (largest == 0) return out;
  // in units of the largest, so that no power overflows; dM/dφ_s = (φ_s/M)^{q−1}
  constexpr double q = 20;
  double sum = 0;
  for (double cost : costs) sum += std::pow(cost / largest, q);
  out.value = largest * std::pow(sum, 1 / q);
  for (std::size_t s = 0; s < costs.size(); ++s)
    out.dvalue_dI[s] *= std::pow(costs[s] / out.value, q - 1);
  return out;
}

namespace {

// Sizes of one candidate and their number.
struct Layout {
  Index n, m, p, h, count;

  VectorXd state(const VectorXd& x, Index s) const { return x.segment(s * n, n); }
  MatrixXd psi(const MatrixXd& all, Index s) const { return all.middleRows(s * n, n); }
  // Row of ψ_ij of candidate s in vec ψ of all.
  Index psiRow(Index s, Index j) const { return j * count * n + s * n; }

  // d(x, vec ψ) of all by (x, inputs), from one candidate's.
  template <class Derivatives>
  void place(const Derivatives& derivatives, Index s, Derivatives& all) const {
    const Index inputs = derivatives.x.cols() - n;
    all.x.block(s * n, s * n, n, n) = derivatives.x.leftCols(n);
    all.x.block(s * n, count * n, n, inputs) = derivatives.x.rightCols(inputs);
    for (Index j = 0; j < p; ++j) {
      all.psi.block(psiRow(s, j), s * n, n, n) = derivatives.psi.block(j * n, 0, n, n);
      all.psi.block(psiRow(s, j), count * n, n, inputs) =
          derivatives.psi.block(j * n, n, n, inputs);
    }
  }
  template <class Derivatives>
  Derivatives zero(Index inputs) const {
    return {MatrixXd::Zero(count * n, count * n + inputs),
            MatrixXd::Zero(count * n * p, count * n + inputs)};
  }
};

template <class Extended>
Layout layoutOf(const std::vector<Extended>& candidates) {
  if (candidates.empty()) throw std::invalid_argument("candidates: 0 of them, must be ≥ 1");
  const Dimensions d = candidates.front().dimensions;
  for (const Extended& extended : candidates)
    if (extended.dimensions.state != d.state || extended.dimensions.input != d.input ||
        extended.dimensions.parameter != d.parameter || extended.dimensions.output != d.output ||
        extended.candidates != 1)
      throw std::invalid_argument(
          "candidates: sizes differ or one is a stack itself, must be the same system at several "
          "values of its parameters");
  return {d.state, d.input, d.parameter, d.output, static_cast<Index>(candidates.size())};
}

template <class Extended>
Extended stackHead(const std::shared_ptr<const std::vector<Extended>>& all, const Layout& l) {
  Extended out{};
  out.dimensions = all->front().dimensions;
  out.dimensions.state *= static_cast<int>(l.count);
  out.dimensions.output *= static_cast<int>(l.count);
  out.parameterNames = all->front().parameterNames;
  out.candidates = static_cast<int>(l.count);
  out.output.gamma = [=](const VectorXd& x, const MatrixXd& psi, const VectorXd& u) {
    MatrixXd gamma(l.count * l.h, l.p);
    for (Index s = 0; s < l.count; ++s)
      gamma.middleRows(s * l.h, l.h) =
          (*all)[std::size_t(s)].output.gamma(l.state(x, s), l.psi(psi, s), u);
    return gamma;
  };
  out.output.gradient = [=](const VectorXd& x, const MatrixXd& psi, const VectorXd& u,
                            const MatrixXd& P) {
    ExtendedOutput::Gradient sum{VectorXd(l.count * l.n), MatrixXd(l.count * l.n, l.p),
                                 VectorXd::Zero(l.m)};
    for (Index s = 0; s < l.count; ++s) {
      const auto one = (*all)[std::size_t(s)].output.gradient(l.state(x, s), l.psi(psi, s), u,
                                                              P.middleRows(s * l.h, l.h));
      sum.x.segment(s * l.n, l.n) = one.x;
      sum.psi.middleRows(s * l.n, l.n) = one.psi;
      sum.u += one.u;
    }
    return sum;
  };
  return out;
}

}  // namespace

ExtendedStepMap stack(std::vector<ExtendedStepMap> candidates) {
  const Layout l = layoutOf(candidates);
  const auto all = std::make_shared<const std::vector<ExtendedStepMap>>(std::move(candidates));
  ExtendedStepMap out = stackHead(all, l);
  out.step = [=](const VectorXd& x, const MatrixXd& psi, const VectorXd& u0, const VectorXd& u1) {
    ExtendedStepMap::Next next{VectorXd(l.count * l.n), MatrixXd(l.count * l.n, l.p), true};
    for (Index s = 0; s < l.count; ++s) {
      const auto one = (*all)[std::size_t(s)].step(l.state(x, s), l.psi(psi, s), u0, u1);
      next.x.segment(s * l.n, l.n) = one.x;
      next.psi.middleRows(s * l.n, l.n) = one.psi;
      next.converged = next.converged && one.converged;
    }
    return next;
  };
  out.derivatives = [=](const VectorXd& x, const MatrixXd& psi, const VectorXd& u0,
                        const VectorXd& u1) {
    auto d = l.zero<ExtendedStepMap::Derivatives>(2 * l.m);
    for (Index s = 0; s < l.count; ++s)
      l.place((*all)[std::size_t(s)].derivatives(l.state(x, s), l.psi(psi, s), u0, u1), s, d);
    return d;
  };
  return out;
}

ExtendedFlow stack(std::vector<ExtendedFlow> candidates) {
  const Layout l = layoutOf(candidates);
  const auto all = std::make_shared<const std::vector<ExtendedFlow>>(std::move(candidates));
  ExtendedFlow out = stackHead(all, l);
  out.rate = [=](const VectorXd& x, const MatrixXd& psi, const VectorXd& u) {
    ExtendedFlow::Rate rate{VectorXd(l.count * l.n), MatrixXd(l.count * l.n, l.p)};
    for (Index s = 0; s < l.count; ++s) {
      const auto one = (*all)[std::size_t(s)].rate(l.state(x, s), l.psi(psi, s), u);
      rate.x.segment(s * l.n, l.n) = one.x;
      rate.psi.middleRows(s * l.n, l.n) = one.psi;
    }
    return rate;
  };
  out.derivatives = [=](const VectorXd& x, const MatrixXd& psi, const VectorXd& u) {
    auto d = l.zero<ExtendedFlow::Derivatives>(l.m);
    for (Index s = 0; s < l.count; ++s)
      l.place((*all)[std::size_t(s)].derivatives(l.state(x, s), l.psi(psi, s), u), s, d);
    return d;
  };
  return out;
}

}  // namespace info
