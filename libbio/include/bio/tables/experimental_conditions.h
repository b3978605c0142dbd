#pragma once

#include <map>
#include <string>
#include <vector>

namespace bio {

/// Experimental conditions that the experimenter set for a whole trial. In a file: lines
/// `known_mass_in_hand_kg=1` and `known_arm_turn_deg=-45` of the header.
struct ExperimentalConditions {
  double massInHand = 0;  ///< [kg] ≥ 0, at the mass centre of the farthest body that moves
  /// Angle by which the whole limb, with the body that carries the observed joint, was turned
  /// against the ground about that joint's axis, positive as its coordinate rises [rad]
  double armTurn = 0;
  bool any() const { return massInHand != 0 || armTurn != 0; }
};

/// "with a known mass of 1 kg and the limb turned by -45 deg"; empty without any.
std::string inWords(const ExperimentalConditions& conditions);

/// The lines of the header; none for unchanged conditions.
std::map<std::string, std::string> headerOf(const ExperimentalConditions& conditions);

/// Names of all such lines.
const std::vector<std::string>& knownLines();

/// The conditions read from the lines of a header; 0 if absent.
/// @throws std::invalid_argument for a mass that is not a number from 0 to 100, or a turn that is
///   not a number from -180 to 180
ExperimentalConditions experimentalConditionsIn(const std::map<std::string, std::string>& header);

}  // namespace bio
