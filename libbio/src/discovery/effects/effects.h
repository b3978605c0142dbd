#pragma once

// What the files of effects share; not public. The effects themselves are listed in catalogue.cc.

#include <optional>

#include "bio/discovery/effects.h"

namespace bio::discover {

/// `known.mass` [kg] and `known.turn` [rad], which trials are known to have, where the model can
/// have them; no candidates. Before all others.
void addExperimentalConditions(EncompassingModel& model);
/// An entry of the catalogue that experimental conditions need, too.
void addHandForce(EncompassingModel& model);

/// Units, words and sizes of a coordinate and of a force on it. Priors and bounds of the catalogue
/// are those of an elbow, in N m and rad; a shift's are these times powers of two; without muscles
/// they follow from what moves and how it was seen to move (decision 085).
struct CoordinateUnits {
  std::string position, speed, force;  ///< "rad", "rad/s", "N m"; "m", "m/s", "N"
  std::string word;                    ///< "torque" or "force"
  double length = 1;            ///< 1/8 m stands for 1 rad, or, without muscles, the spread seen
  double speedSize = 1;         ///< that stands for 1 rad/s: without muscles, the speed seen
  double frictionWidth = 0.05;  ///< dry friction is c·tanh(q̇/w); without muscles 1/80 of that
  /// Size of a force. With muscles 1 for a rotation, for a shift the strongest isometric force of
  /// the muscles in one direction, over 64 [N]. Without muscles what moves weighs, over 4 N m or
  /// 16 N: a free swing is the same for any mass, and so is what can be said of it.
  double strength = 1;
  std::string stiffness() const { return force + "/" + position; }
  std::string viscosity() const { return force + " s/" + position; }
};
CoordinateUnits unitsOf(const EncompassingModel& model, const MovingCoordinate& at);

/// Mass of what moves, over that of a forearm and hand (2 kg), by which masses and forces of the
/// catalogue are multiplied in a model without muscles; 1 with muscles.
double heaviness(const EncompassingModel& model);

/// A quantity that is 0 while its effect is absent.
inline info::discover::Quantity amplitude(std::string name, std::string unit, double lower,
                                          double upper, double sd) {
  return {std::move(name), std::move(unit), 0, lower, upper, sd, false};
}
/// A quantity that shapes an effect.
inline info::discover::Quantity shape(std::string name, std::string unit, double nominal,
                                      double lower, double upper, double sd) {
  return {std::move(name), std::move(unit), nominal, lower, upper, sd, false};
}
/// A factor, known to a share of itself.
inline info::discover::Quantity factor(std::string name, double lower, double upper, double sd) {
  return {std::move(name), "", 1, lower, upper, sd, true};
}

/// A candidate of one quantity or of several, each with its own deviation as prior.
info::discover::Candidate candidate(const EncompassingModel& model, std::string id,
                                    std::string name, std::string sentence,
                                    info::discover::EffectKind kind,
                                    std::vector<std::size_t> quantities,
                                    const std::vector<std::vector<double>>& starts,
                                    std::vector<std::string> equivalents = {});

/// A candidate of a coordinate, which id, name and sentence tell where there are several.
info::discover::Candidate candidateAt(const EncompassingModel& model, const MovingCoordinate& at,
                                      const std::string& id, std::string name, std::string sentence,
                                      std::vector<std::size_t> quantities,
                                      const std::vector<std::vector<double>>& starts);

/// Id of the gain of a muscle's or a group's electrodes.
inline std::string gainId(const std::string& name) {
  return "gain_" + name;
}

/// Name of the law that an effect adds to a model: "elbow_flexion_visc".
std::string lawName(const MovingCoordinate& at, const std::string& id);

/// Adds a force on a coordinate by a formula. Present if the model has a law of that name.
/// @return the law's index in the model's list; nothing if it is present
std::optional<std::size_t> addExpression(EncompassingModel& model, const MovingCoordinate& at,
                                         const ExpressionEffect& effect);

}  // namespace bio::discover
