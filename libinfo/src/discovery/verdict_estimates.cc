#include "discovery/verdict_estimates.h"

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
    Estimate e{q, fit.values[static_cast<Index>(q)], fit.sd(at), 0, false};
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
