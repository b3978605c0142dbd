#pragma once

#include <map>
#include <string>
#include <vector>

namespace bio {

/// What the experimenter changed on purpose for a whole trial, and knows. In a file: lines
/// `known_mass_in_hand_kg=1` and `known_arm_turn_deg=-45` of the header.
struct KnownChanges {
  double massInHand = 0;  ///< [kg] ≥ 0, at the mass centre of the farthest body that moves
  /// The arm as a whole, with all that the observed joint hangs on, turned against the ground about
  /// that joint's axis, positive as its coordinate rises [rad]
  double armTurn = 0;
  bool any() const { return massInHand != 0 || armTurn != 0; }
};

/// "with 1 kg in the hand and the arm turned by -45 deg"; empty without any.
std::string inWords(const KnownChanges& known);

/// The header's lines, none for what was not changed.
std::map<std::string, std::string> headerOf(const KnownChanges& known);

/// Names of all lines that say what is known.
const std::vector<std::string>& knownLines();

/// The header's lines read again; 0 for what is not there.
/// @throws std::invalid_argument for a mass that is no number from 0 to 100, or a turn that is none
///   from -180 to 180
KnownChanges knownChangesIn(const std::map<std::string, std::string>& header);

}  // namespace bio
