#include "bio/discover/with_known_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "bio/discover/add_effects.h"
#include "discover/effects/effects.h"

namespace bio::discover {

Eigen::VectorXd knownChangesOf(const Trial& trial, const WidestModel& widest) {
  const auto& quantities = widest.quantities();
  Eigen::VectorXd changes = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(quantities.size()));
  if (!trial.known.any()) return changes;
  const auto change = [&](const std::string& name, double value, const char* why) {
    if (value == 0) return;
    const auto at = std::find_if(quantities.begin(), quantities.end(),
                                 [&](const auto& one) { return one.name == name; });
    if (at == quantities.end()) {
      throw std::invalid_argument(
          fmt::format("{}: recorded {}, but {}", trial.file, inWords(trial.known), why));
    }
    changes[at - quantities.begin()] = value;
  };
  change("known.mass", trial.known.massInHand, "the model moves no body that could carry it");
  change("known.turn", trial.known.armTurn, "the coordinate does not turn bodies across gravity");
  if (trial.known.armTurn != 0 && widest.present().count("handforce") > 0) {
    throw std::invalid_argument(
        fmt::format("{}: recorded {}, but the model has a force on the hand ({}), which would turn "
                    "with the limb",
                    trial.file, inWords(trial.known), widest.present().at("handforce")));
  }
  return changes;
}

Model withKnownChanges(const Model& model, const ArmOptions& arm, const std::string& coordinate,
                       const Trial& trial) {
  if (!trial.known.any()) return model;
  WidestModel widest(model, arm, coordinate);
  addKnownChanges(widest);
  addHandForce(widest);  // which the model may have already
  return augmentedModel(widest, widest.nominal() + knownChangesOf(trial, widest)).model;
}

}  // namespace bio::discover
