#pragma once

#include <vector>

#include "bio/model_review.h"
#include "bio/trial.h"

namespace bio {

/// Lists what is allowed but unusual in a trial.
///
/// Unequal sampling (an interval more than 1 % off the median one); rows further apart than 0.1 s;
/// excitations that are 0 or 1 throughout, or that jump by more than 0.5 between rows; a measured
/// angle beyond 4π rad (degrees?) or jumping by more than 0.5 rad between neighbours; a measured
/// coordinate outside its range in the model; measurements that begin more than 0.1 s after the
/// excitations; a torque or force from outside above 50 N·m or N, 0 throughout, or jumping by more
/// than 5 between rows.
std::vector<Remark> reviewTrial(const Trial& trial, const Model& model);

}  // namespace bio
