#pragma once

#include <string>
#include <vector>

#include "bio/discover/elbow_disagreement.h"
#include "info/discover/discover.h"

namespace bio::discover {

/// What an experiment that has not been done yet would tell.
struct ForeseenExperiment {
  std::string sentence;      ///< what to do
  std::vector<double> nats;  ///< the first of Verdict::rivals against each of the others
  double least() const;      ///< the smallest of them
};

/// Simulates the planned experiments (planned.h, passive_motion.h) with all that cannot be told
/// apart (info/discover/separation.h); the best first. What leaves the range of the coordinate, or
/// cannot be simulated, is left out. Empty where nothing is ambiguous.
/// @param trial    what is repeated
/// @param options  those of `data`
std::vector<ForeseenExperiment> foresee(const Model& model, const ArmOptions& arm,
                                        const Trial& trial, const ElbowOptions& options,
                                        const ElbowDisagreement& data,
                                        const info::discover::Verdict& verdict);

}  // namespace bio::discover
