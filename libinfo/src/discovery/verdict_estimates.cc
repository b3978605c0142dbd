#include "discovery/verdict_estimates.h"

#include <algorithm>
#include <cmath>

namespace info::discover {

using Eigen::Index;
using Eigen::VectorXd;

std::vector<Estimate> estimatesOf(const Fit& fit, const std::vector<std::size_t>& wanted,
                                  const DiscoveryProblem& data) {
  std::vector<Estimate> result;
  for (const std::size_t q : wanted) {
    const int i = fit.hypothesis.indexOf(q);
    if (i < 0) continue;
    const auto at = static_cast<std::size_t>(i);
    Estimate e{q, fit.values[static_cast<Index>(q)], fit.sd(at)};
    // the prior z-score refers to the quantity's own prior, not to that of a candidate
    FreeQuantity own = fit.hypothesis.free[at];
    own.sd = data.quantities()[q].sd;
    e.priorZ = own.coordinate(e.value);
    const Quantity& quantity = data.quantities()[q];
    const double margin = 1e-6 * (quantity.upper - quantity.lower);
    e.atBound = e.value - quantity.lower < margin || quantity.upper - e.value < margin;
    result.push_back(e);
  }
  return result;
}

const Estimate* farthestFromPrior(const std::vector<Estimate>& estimates,
                                  const DiscoveryProblem& data) {
  const Estimate* farthest = nullptr;
  for (const Estimate& e : estimates)
    if (data.quantities()[e.quantity].trial < 0 &&
        (farthest == nullptr || std::abs(e.priorZ) > std::abs(farthest->priorZ)))
      farthest = &e;
  return farthest;
}

std::vector<NamedEffect> evidentError(const Estimate& estimate, const DiscoveryProblem& data) {
  const std::vector<Candidate>& candidates = data.candidates();
  const auto at = std::find_if(candidates.begin(), candidates.end(), [&](const Candidate& each) {
    return each.kind == EffectKind::parameter && each.quantities[0] == estimate.quantity;
  });
  if (at == candidates.end()) return {};
  NamedEffect named;
  named.candidate = static_cast<std::size_t>(at - candidates.begin());
  named.estimates = {estimate};
  named.equals = {named.candidate};
  named.equalEvidence = {0};
  return {named};
}

void addMoves(const Likelihood& likelihood, const Fit& fit, std::vector<Estimate>& estimates) {
  VectorXd squares = VectorXd::Zero(fit.xi.size());
  for (std::size_t t = 0; t < likelihood.trials().size(); ++t)
    squares += likelihood.linearise(t, fit, fit.values, {}, false)
                   .gamma.colwise()
                   .squaredNorm()
                   .transpose();
  const auto n = static_cast<double>(likelihood.samples());
  for (Estimate& e : estimates)
    if (const int i = fit.hypothesis.indexOf(e.quantity); i >= 0)
      e.moves = std::abs(fit.xi[i]) * std::sqrt(squares[i] / n);
}

double nominalError(const Likelihood& likelihood, const Noise& noise) {
  const DiscoveryProblem& data = likelihood.data();
  const auto fit =
      likelihood.tryFit(startsOnly(data, likelihood.trials()), noise, nominalValues(data));
  return fit ? likelihood.simulationError(fit->values, noise.output) : HUGE_VAL;
}

VectorXd predictedSd(const DiscoveryProblem& data, const Verdict& verdict, int trial) {
  std::vector<std::size_t> amplitudes;
  VectorXd sd(static_cast<Index>(verdict.effects.size()));
  for (const NamedEffect& effect : verdict.effects) {
    sd[static_cast<Index>(amplitudes.size())] = effect.estimates.front().sd;
    amplitudes.push_back(effect.estimates.front().quantity);
  }
  const auto at = data.predict(trial, verdict.values, {}, amplitudes, false);
  const VectorXd spread = (at.gamma * sd.asDiagonal()).rowwise().squaredNorm();
  const VectorXd noise = verdict.sds.bySample(data.outputOfSample(trial), spread.size());
  return (spread + noise.cwiseAbs2()).cwiseSqrt();
}

}  // namespace info::discover
