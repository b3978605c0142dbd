#pragma once

#include <string>
#include <vector>

#include "bio/discovery/musculoskeletal_problem.h"
#include "info/discovery/discover.h"

namespace bio::discover {

/// A planned experiment and its expected log Bayes factors.
struct PredictedExperiment {
  std::string sentence;      ///< what to do
  std::vector<double> nats;  ///< expected log Bayes factors of the first of Verdict::rivals against
                             ///< each of the others
  double least() const;      ///< the smallest of them
};

/// Simulates the planned experiments (planned.h, passive_motion.h) with each of the effects that
/// these data cannot distinguish (info/discovery/judgement/separation.h); the best experiment
/// first. Experiments that leave the range of the coordinate or cannot be simulated are left out.
/// Empty if no effects are in question.
/// @param trial trial to repeat
std::vector<PredictedExperiment> predictExperiments(const Trial& trial,
                                                    const MusculoskeletalProblem& data,
                                                    const info::discover::Verdict& verdict);

}  // namespace bio::discover
