#pragma once

#include <string>

#include "bio/discover/widest_model.h"

namespace bio::discover {

/// The changes that the experimental conditions of a trial (Trial::known) make to the quantities of
/// a model with `known.mass` and `known.turn`; zero if nothing was changed.
/// @throws std::invalid_argument naming the file, for a mass in the hand of a model without a body
///   to carry it, a turn if the coordinate does not turn bodies against gravity, or a turn if the
///   model has a force on the hand
Eigen::VectorXd knownChangesOf(const Trial& trial, const WidestModel& widest);

/// The model under the experimental conditions of the trial: with the known mass in the hand, and
/// with gravity turned accordingly. The unchanged model if nothing was changed.
/// @param coordinate the free coordinate
/// @throws what WidestModel and knownChangesOf throw
Model withKnownChanges(const Model& model, const ArmOptions& arm, const std::string& coordinate,
                       const Trial& trial);

}  // namespace bio::discover
