#include "bio/analysis/step_effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bio/model/units.h"
#include "simulation/motion_weights.h"

namespace bio {
namespace {

double limitOf(bool turns) {
  return turns ? largestStepEffect_deg : largestStepEffect_mm;
}

}  // namespace

std::optional<StepEffect> stepEffect(const MusculoskeletalSystem& system, const Trial& trial,
                                     const TrialReplay& replay) {
  const Trajectory& motion = replay.motion;
  SimulationOptions options = replay.options;
  options.step /= 2;
  StepEffect effect;
  effect.halfStep = options.step;
  const Trajectory finer =
      replayTrial(system, trial, options, replay.beginning, replay.mapping).motion;
  if (finer.outcome != Outcome::completed) {
    effect.failed = finer.why;
    return effect;
  }
  // between its own rows a motion is what its positions and speeds make of it
  double most = 1;
  bool isBeyond = false;
  for (Eigen::Index i = 0; i < motion.q.rows(); ++i) {
    const Coordinate& coordinate = system.skeleton().coordinates()[static_cast<std::size_t>(i)];
    const bool turns = coordinate.isRotation;
    for (std::size_t k = 0; k < finer.time.size(); ++k) {
      const auto w = weightsAt(motion.time, finer.time[k]);
      const double coarse = w ? w->value(motion.q.row(i), motion.qDot.row(i)) : motion.q(i, 0);
      const double difference = std::abs(coarse - finer.q(i, static_cast<Eigen::Index>(k)));
      const double share = difference * positionUnit(turns).factor / limitOf(turns);
      if (!(share > most)) continue;
      most = share;
      isBeyond = true;
      effect.coordinate = coordinate.name;
      effect.turns = turns;
      effect.difference = difference;
      effect.at = finer.time[k];
    }
  }
  if (!isBeyond) return {};
  return effect;
}

std::optional<StepEffect> effectOfDoubtfulStep(const MusculoskeletalSystem& system,
                                               const Trial& trial, const TrialReplay& replay,
                                               bool wasGiven) {
  constexpr long fewSteps = 20;
  const bool mayBeUnstable = wasGiven && replay.options.integrator == Integrator::rungeKutta4;
  const bool isInDoubt = mayBeUnstable || replay.motion.steps <= fewSteps;
  if (replay.motion.outcome != Outcome::completed || !isInDoubt) return {};
  return stepEffect(system, trial, replay);
}

std::string describe(const StepEffect& effect) {
  const std::string what =
      effect.failed.empty()
          ? fmt::format("{} differs by up to {:.3g} {}, at {:.3g} s", effect.coordinate,
                        effect.difference * positionUnit(effect.turns).factor,
                        positionUnit(effect.turns).name, effect.at)
          : fmt::format("the motion does not reach the end ({})", effect.failed);
  return fmt::format(
      "with half the step ({:.4g} s) {}: the step of {:.4g} s is too long for this trial",
      effect.halfStep, what, 2 * effect.halfStep);
}

}  // namespace bio
