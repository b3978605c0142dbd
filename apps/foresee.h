#pragma once

#include <string>
#include <vector>

#include "bio/discover/elbow_disagreement.h"
#include "info/discover/discover.h"

namespace app {

/// What an experiment that has not been done yet would tell.
struct ForeseenExperiment {
  std::string sentence;      ///< what to do
  std::vector<double> nats;  ///< the first of Verdict::rivals against each of the others
  double least() const;      ///< the smallest of them
};

/// Simulates the planned experiments (bio/discover/planned.h) with all that cannot be told apart;
/// the best first. What leaves the range of the coordinate, or cannot be simulated, is left out.
/// Empty where nothing is ambiguous.
std::vector<ForeseenExperiment> foresee(const bio::Model& model, const bio::ArmOptions& arm,
                                        const bio::Trial& trial,
                                        const bio::discover::ElbowOptions& options,
                                        const bio::discover::ElbowDisagreement& data,
                                        const info::discover::Verdict& verdict);

/// "tilt + visc" of one of Verdict::rivals, without what the first of them has, too.
std::string rivalName(const info::discover::Disagreement& data,
                      const info::discover::Verdict& verdict, std::size_t rival);

/// The first of the foreseen experiments in a sentence, if it would tell: more than 5 nats against
/// every rival; else empty.
std::string foreseenSentence(const std::vector<ForeseenExperiment>& foreseen,
                             const info::discover::Disagreement& data,
                             const info::discover::Verdict& verdict);

}  // namespace app
