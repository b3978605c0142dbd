#pragma once

// Not public.

#include <vector>

#include "info/discovery/discover.h"

namespace info::discover {

/// Estimates of the wanted quantities by a fit; those that it holds fixed are left out.
std::vector<Estimate> estimatesOf(const Fit& fit, const std::vector<std::size_t>& wanted,
                                  const DiscoveryProblem& data);

/// The one with the largest |priorZ| of those that all trials share; null if there is none.
const Estimate* farthestFromPrior(const std::vector<Estimate>& estimates,
                                  const DiscoveryProblem& data);

/// The error of a parameter that is evident without a comparison of candidates; empty if no
/// candidate is that parameter's.
std::vector<NamedEffect> evidentError(const Estimate& estimate, const DiscoveryProblem& data);

/// Sets Estimate::moves of a fit's estimates: √(Σ (Γ_i ξ_i)²/n) over all samples of the fitted
/// trials.
void addMoves(const Likelihood& likelihood, const Fit& fit, std::vector<Estimate>& estimates);

/// RMS error of the nominal model, only the initial states fitted (ExcessError::nominal); infinite
/// if it does not reach the end of a trial.
double nominalError(const Likelihood& likelihood, const Noise& noise);

}  // namespace info::discover
