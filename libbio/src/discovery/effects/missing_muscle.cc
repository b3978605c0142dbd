#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "discovery/effects/effects.h"

// Muscles that the model leaves out. Which they may be, and where they run, the model says itself:
// those that it holds with appliesForce = false. Prior: as strong as there, give or take that much.

namespace bio::discover {
namespace {

/// Muscles that pull as a disabled one does. None: the system with it cannot be simulated, or it
/// does not move the coordinate, or nothing pulls as it does.
std::vector<std::string> synergists(const EncompassingModel& model, std::size_t muscle) {
  Model with = model.base();
  with.muscles[muscle].enabled = true;
  std::vector<std::string> names;
  try {
    const MusculoskeletalSystem system(with, model.systemOptions());
    const Eigen::MatrixXd momentArms = model.momentArms(system);
    const auto& muscles = system.muscles();
    const auto own = std::find_if(muscles.begin(), muscles.end(), [&](const SystemMuscle& one) {
      return one.name == with.muscles[muscle].name;
    });
    if (own == muscles.end()) return {};
    const Eigen::VectorXd pull = momentArms.row(own - muscles.begin()).transpose();
    for (std::size_t i = 0; i < muscles.size(); ++i) {
      const bool isOther = muscles[i].name != own->name;
      if (isOther && momentArms.row(static_cast<Eigen::Index>(i)).dot(pull) > 0)
        names.push_back(muscles[i].name);
    }
  } catch (const std::invalid_argument&) {
    return {};
  }
  return names;
}

}  // namespace

void addMissingMuscles(EncompassingModel& model) {
  for (std::size_t i = 0; i < model.base().muscles.size(); ++i) {
    const Muscle& muscle = model.base().muscles[i];
    if (muscle.enabled || !muscle.schutte) continue;
    const std::vector<std::string> proxies = synergists(model, i);
    if (proxies.empty()) continue;
    const std::size_t number = model.addMuscle(i, proxies);
    const std::size_t share =
        model.add(amplitude(fmt::format("missing_{}.strength", muscle.name), "", 0, 5, 1),
                  {Meaning::Kind::shift, {{number, muscle.schutte->maxIsometricForce}}});
    // its lengths are known as well as those of the others
    const SchutteParameters& known = *muscle.schutte;
    const auto length = [&](MuscleQuantity quantity, const char* words, double value, double sd) {
      return model.add(
          factor(fmt::format("missing_{}.{} factor", muscle.name, words), 0.8, 1.25, sd),
          {Meaning::Kind::scale, {{model.number(MuscleTarget{i, quantity}, value)}}});
    };
    const std::size_t fibre = length(MuscleQuantity::optimalFibreLength, "optimal_fiber_length",
                                     known.optimalFibreLength, 0.04);
    const std::size_t tendon = length(MuscleQuantity::tendonSlackLength, "tendon_slack_length",
                                      known.tendonSlackLength, 0.02);
    model.lawFollows({share, fibre, tendon});
    model.add(candidate(
        model, "missing_" + muscle.name, "muscle " + muscle.name,
        fmt::format("{}, which is switched off in the model, is active.", muscle.name),
        info::discover::EffectKind::structure, {share, fibre, tendon}, {{0.3, 1, 1}, {1, 1, 1}}));
  }
}

}  // namespace bio::discover
