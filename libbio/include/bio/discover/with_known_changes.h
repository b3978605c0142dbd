#pragma once

#include <string>

#include "bio/discover/widest_model.h"

namespace bio::discover {

/// What the known changes of a trial (Trial::known) add to the quantities of a model that has
/// `known.mass` and `known.turn`; zero where nothing was changed.
/// @throws std::invalid_argument naming the file for a mass in the hand of an arm that has none, a
///   turn of an arm that gravity does not turn, or one beside a force on the hand that the model
///   has
Eigen::VectorXd knownChangesOf(const Trial& trial, const WidestModel& widest);

/// The model as it was while the trial was recorded: with the known mass in the hand, and gravity
/// as the turned arm feels it. The model itself where nothing was changed.
/// @param coordinate  the one that is free
/// @throws what WidestModel and knownChangesOf throw
Model withKnownChanges(const Model& model, const ArmOptions& arm, const std::string& coordinate,
                       const Trial& trial);

}  // namespace bio::discover
