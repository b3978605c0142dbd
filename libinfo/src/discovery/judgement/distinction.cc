#include "info/discovery/judgement/distinction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "info/discovery/likelihood/hypothesis.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

void check(const DiscoveryProblem& planned, const PresentEffect& effect) {
  if (effect.candidate >= planned.candidates().size())
    throw std::invalid_argument("distinction: no such candidate");
  const Candidate& c = planned.candidates()[effect.candidate];
  if (effect.values.size() != static_cast<Index>(c.quantities.size()))
    throw std::invalid_argument(
        fmt::format("distinction: {} must have {} values", c.id, c.quantities.size()));
  if (!effect.values.allFinite() ||
      effect.values[0] == planned.quantities()[c.quantities[0]].nominal)
    throw std::invalid_argument(fmt::format(
        "distinction: amplitude of {} must be finite and differ from its nominal value", c.id));
}

// One effect in one trial.
struct Seen {
  VectorXd change;    // Δ
  MatrixXd adjusted;  // Γ of its own quantities in units of their priors, the amplitude along Δ
};

Seen seenOf(const DiscoveryProblem& planned, int trial, const PresentEffect& effect,
            const VectorXd& base) {
  const Candidate& c = planned.candidates()[effect.candidate];
  VectorXd values = nominalValues(planned);
  for (std::size_t i = 0; i < c.quantities.size(); ++i)
    values[static_cast<Index>(c.quantities[i])] = effect.values[static_cast<Index>(i)];
  const std::vector<std::size_t> shapes(c.quantities.begin() + 1, c.quantities.end());
  const auto there = planned.predict(trial, values, {}, shapes, false);
  if (!there.outputs.allFinite() || !there.gamma.allFinite())
    throw std::domain_error(fmt::format("the system with {} cannot be simulated", c.id));
  const Hypothesis own = makeHypothesis(planned, {effect.candidate}, {trial});
  const auto slopeOf = [&](std::size_t quantity) {
    const int at = own.indexOf(quantity);
    if (at < 0) return 0.0;
    const FreeQuantity& q = own.free[static_cast<std::size_t>(at)];
    return q.slope(q.coordinate(values[static_cast<Index>(quantity)]));
  };
  Seen seen;
  seen.change = there.outputs - base;
  seen.adjusted.resize(base.size(), static_cast<Index>(c.quantities.size()));
  const double amplitude = effect.values[0] - planned.quantities()[c.quantities[0]].nominal;
  seen.adjusted.col(0) = seen.change * (slopeOf(c.quantities[0]) / amplitude);
  for (std::size_t i = 0; i < shapes.size(); ++i)
    seen.adjusted.col(static_cast<Index>(i) + 1) =
        there.gamma.col(static_cast<Index>(i)) * slopeOf(shapes[i]);
  return seen;
}

// ½ Δᵀ S⁻¹ Δ with S = 1 + FFᵀ, the cost of Δ after adjustment of everything in `free`, both in σ.
double remaining(const VectorXd& change, const MatrixXd& free) {
  MatrixXd inner = free.transpose() * free;
  inner.diagonal().array() += 1;
  const VectorXd along = free.transpose() * change;
  return 0.5 * (change.squaredNorm() - along.dot(inner.llt().solve(along)));
}

}  // namespace

double Distinction::least() const {
  return std::min(firstOverSecond, secondOverFirst);
}

Distinction distinction(const DiscoveryProblem& planned, const PresentEffect& first,
                        const PresentEffect& second, const Whitening& sds) {
  check(planned, first);
  check(planned, second);
  if (first.candidate == second.candidate)
    throw std::invalid_argument("distinction: the two effects must differ");
  if (!sds.isPositive())
    throw std::invalid_argument(fmt::format("distinction: noise = {}, must be > 0", sds.sd(0)));
  std::vector<int> trials;
  Index samples = 0;
  for (int t = 0; t < planned.numTrials(); ++t) {
    trials.push_back(t);
    samples += static_cast<Index>(planned.times(t).size());
  }
  const Hypothesis nuisances = makeHypothesis(planned, {}, trials);
  std::vector<std::size_t> wanted;
  for (const FreeQuantity& q : nuisances.free) wanted.push_back(q.quantity);
  const auto p = static_cast<Index>(wanted.size());
  const auto ownOf = [&](const PresentEffect& e) { return e.values.size(); };

  VectorXd changeA(samples), changeB(samples);
  MatrixXd freeA(samples, p + ownOf(second)), freeB(samples, p + ownOf(first));
  Index row = 0;
  for (const int t : trials) {
    const auto n = static_cast<Index>(planned.times(t).size());
    const auto whitened = [&](MatrixXd rows) {
      sds.whiten(planned.outputOfSample(t), rows);
      return rows;
    };
    const auto base = planned.predict(t, nominalValues(planned), {}, wanted, false);
    if (!base.outputs.allFinite() || !base.gamma.allFinite())
      throw std::domain_error("the base model cannot be simulated");
    const Seen a = seenOf(planned, t, first, base.outputs);
    const Seen b = seenOf(planned, t, second, base.outputs);
    MatrixXd gamma = base.gamma;
    for (Index i = 0; i < p; ++i) {
      const FreeQuantity& q = nuisances.free[static_cast<std::size_t>(i)];
      gamma.col(i) *= q.slope(q.coordinate(q.nominal));
    }
    changeA.segment(row, n) = whitened(a.change);
    changeB.segment(row, n) = whitened(b.change);
    gamma = whitened(std::move(gamma));
    freeA.middleRows(row, n) << gamma, whitened(b.adjusted);
    freeB.middleRows(row, n) << gamma, whitened(a.adjusted);
    row += n;
  }
  Distinction result;
  result.firstOverSecond = remaining(changeA, freeA);
  result.secondOverFirst = remaining(changeB, freeB);
  const auto sd = [&](const PresentEffect& e, double nats) {
    const std::size_t amplitude = planned.candidates()[e.candidate].quantities[0];
    return std::abs(e.values[0] - planned.quantities()[amplitude].nominal) / std::sqrt(2 * nats);
  };
  result.firstDeviation = sd(first, result.firstOverSecond);
  result.secondDeviation = sd(second, result.secondOverFirst);
  return result;
}

}  // namespace info::discover
