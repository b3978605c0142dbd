#include "bio/discovery/with_experimental_conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "bio/discovery/add_effects.h"
#include "bio/discovery/end_of_limb.h"
#include "discovery/effects/effects.h"

namespace bio::discover {

Eigen::VectorXd experimentalConditionsOf(const Trial& trial,
                                         const EncompassingModel& encompassing) {
  const auto& quantities = encompassing.quantities();
  Eigen::VectorXd changes = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(quantities.size()));
  if (!trial.conditions.any()) return changes;
  const auto change = [&](std::optional<std::size_t> quantity, double value, const char* why) {
    if (value == 0) return;
    if (!quantity) {
      throw std::invalid_argument(
          fmt::format("{}: recorded {}, but {}", trial.file, inWords(trial.conditions), why));
    }
    changes[static_cast<Eigen::Index>(*quantity)] = value;
  };
  change(encompassing.conditions().massInHand, trial.conditions.massInHand,
         "the model moves no body that could carry it");
  change(encompassing.conditions().armTurn, trial.conditions.armTurn,
         "the coordinate does not turn bodies across gravity");
  if (trial.conditions.armTurn != 0 && encompassing.present().count("handforce") > 0) {
    throw std::invalid_argument(
        fmt::format("{}: recorded {}, but the model has a force on {} ({}), which would turn with "
                    "the limb",
                    trial.file, inWords(trial.conditions), endOfLimb(encompassing),
                    encompassing.present().at("handforce")));
  }
  return changes;
}

Model withExperimentalConditions(const Model& model, const SystemOptions& system,
                                 const CoordinateNames& coordinates, const Trial& trial) {
  if (!trial.conditions.any()) return model;
  EncompassingModel encompassing(model, system, coordinates);
  addExperimentalConditions(encompassing);
  addHandForce(encompassing);  // which the model may have already
  return augmentedModel(encompassing,
                        encompassing.nominal() + experimentalConditionsOf(trial, encompassing))
      .model;
}

}  // namespace bio::discover
