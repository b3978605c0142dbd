#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "info/discovery/likelihood/fitted_numbers.h"
#include "info/discovery/search/shorter_steps.h"
#include "robots/robot_problem.h"

namespace info::robot {

/// The channels of a robot.
/// @param system double-pendulum or suspended-mass
/// @throws std::invalid_argument for another one
std::vector<Channel> channelsOf(const std::string& system);

/// The model of a robot for these trials: saturation of a load cell may begin within the range of
/// the measured forces.
/// @throws std::invalid_argument for an unknown system, or a force that is constant in all trials
Model modelFor(const std::string& system, const std::vector<Trial>& trials);

/// An effect that a robot is known to have.
struct KnownEffect {
  std::string id;
  std::map<std::string, double> values;  ///< of all its quantities, by name
};

/// Builds effects into a model: the values of their quantities become the nominal ones. An error of
/// a parameter stays a candidate, from its new value; every other effect does not.
/// @return the ids of those that are no candidates any more
/// @throws std::invalid_argument for an effect that is not in the catalogue, a quantity without a
///   value or with one outside its bounds
std::vector<std::string> buildIn(const std::vector<KnownEffect>& effects, Model& model);

/// Question to a search for an effect that a robot's model lacks.
struct DiscoveryRequest {
  Model model;
  std::vector<Trial> trials;    ///< those held out last
  std::size_t numHeldOut = 0;   ///< < trials.size(); tested by only
  std::optional<double> step;   ///< [s]; empty: that of `problem`, halved if need be
  DisagreementOptions problem;  ///< its `sds` also give the noise of the search
  discover::Options search;     ///< heldOut and sds are set by discover()
};

/// Findings of such a search.
struct DiscoveryResult {
  std::unique_ptr<RobotProblem> data;
  discover::SteppedVerdict found;
  std::vector<discover::FittedNumber> fitted;
};

/// Searches for effects that a robot's model lacks: discover::searchTrials on a RobotProblem.
/// @throws std::invalid_argument for a step longer than a trial, and what RobotProblem and
///   searchTrials throw
DiscoveryResult discover(const DiscoveryRequest& request);

}  // namespace info::robot
