#pragma once

#include <string>
#include <vector>

#include "bio/discover/elbow_disagreement.h"
#include "info/discover/discover.h"

namespace bio::discover {

/// A planned experiment and its expected log Bayes factors.
struct ForeseenExperiment {
  std::string sentence;      ///< what to do
  std::vector<double> nats;  ///< expected log Bayes factors of the first of Verdict::rivals against
                             ///< each of the others
  double least() const;      ///< the smallest of them
};

/// Simulates the planned experiments (planned.h, passive_motion.h) with each of the effects that
/// these data cannot distinguish (info/discover/separation.h); the best experiment first.
/// Experiments that leave the range of the coordinate or cannot be simulated are left out. Empty if
/// no effects are in question.
/// @param trial trial to repeat
/// @param options  those of `data`
std::vector<ForeseenExperiment> foresee(const Model& model, const ArmOptions& arm,
                                        const Trial& trial, const ElbowOptions& options,
                                        const ElbowDisagreement& data,
                                        const info::discover::Verdict& verdict);

}  // namespace bio::discover
