#pragma once

#include <string>

#include "bio/discovery/encompassing_model.h"

namespace bio::discover {

/// The changes that the experimental conditions of a trial (Trial::known) make to the quantities of
/// a model with `known.mass` and `known.turn`; zero if nothing was changed.
/// @throws std::invalid_argument naming the file, for a mass in the hand of a model without a body
///   to carry it, a turn if the coordinate does not turn bodies against gravity, or a turn if the
///   model has a force on the hand
Eigen::VectorXd experimentalConditionsOf(const Trial& trial, const EncompassingModel& encompassing);

/// The model under the experimental conditions of the trial: with the known mass in the hand, and
/// with gravity turned accordingly. The unchanged model if nothing was changed.
/// @param coordinates the free ones
/// @throws what EncompassingModel and experimentalConditionsOf throw
Model withExperimentalConditions(const Model& model, const SystemOptions& system,
                                 const CoordinateNames& coordinates, const Trial& trial);

}  // namespace bio::discover
