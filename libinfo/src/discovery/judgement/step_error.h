#pragma once

#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"
#include "info/discovery/likelihood/whitening.h"

// Not public.

namespace info::discover {

/// The largest change of an output at half the time step, max_k |y_h(t_k) − y_{h/2}(t_k)|/σ_y.
struct StepError {
  double largest = 0;  ///< [σ_y]; 0: the problem does not offer it (refinedOutputs)
  int trial = 0;       ///< in which it is
};
StepError stepError(const DiscoveryProblem& data, const std::vector<int>& trials,
                    const Eigen::VectorXd& values, const Whitening& sds);

}  // namespace info::discover
