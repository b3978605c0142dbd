#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "bio/observation/observed_motion.h"
#include "bio/observation/parameter_information.h"

namespace bio {

/// Something that could be measured, and how well.
struct ChannelCandidate {
  Observable what;
  double sd;  ///< noise of a sample, in unitOf(what) [> 0]
};

/// All that can be measured of a system, with noise that is usual in a laboratory: angles 0.5°,
/// shifts 1 mm, their speeds 5°/s and 10 mm/s, moments 0.5 N·m, forces 2 N, fibre lengths 1 mm,
/// tendon forces 10 N, activations 0.05, markers 2 mm. Prescribed coordinates are inputs: of them
/// only the moment.
std::vector<ChannelCandidate> usualChannels(const MusculoskeletalSystem& system);

/// Information that a further channel would add to what is known of the parameters.
struct ChannelGain {
  ChannelCandidate channel;
  double information = 0;        ///< ½ log det(I_with + Λ)/det(I_without + Λ) [nats]
  std::string parameter;         ///< the one whose joint bound falls most
  double before = 0, after = 0;  ///< its joint bounds, without and with the channel
};

/// Fisher information ΓᵀΓ/σ² of each candidate, sampled at these times [s] of a motion.
/// @param motion with sensitivities of muscles and reactions
/// @throws std::invalid_argument what ObservedMotion throws, or a noise that is not > 0
std::vector<Eigen::MatrixXd> informationOf(const MusculoskeletalSystem& system,
                                           const std::vector<ChannelCandidate>& candidates,
                                           const std::vector<double>& times,
                                           const SensitivityTrajectory& motion);

/// Gain of each candidate alone beside what is measured, the most informative first.
/// @param known       with the Fisher information I of what is measured and the priors Λ
/// @param candidates  as many as `information`
/// @param information of each candidate, of all motions together
/// @throws std::invalid_argument if sizes differ
std::vector<ChannelGain> channelGains(const ParameterInformation& before,
                                      const std::vector<ChannelCandidate>& candidates,
                                      const std::vector<Eigen::MatrixXd>& information);

}  // namespace bio
