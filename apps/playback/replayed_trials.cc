#include "playback/replayed_trials.h"

#include <exception>
#include <utility>

#include "bio/analysis/replay.h"
#include "bio/discovery/with_experimental_conditions.h"

namespace app {

ReplayedTrials::ReplayedTrials(bio::SystemOptions options, bio::SimulationOptions simulation)
    : simulation_(std::move(simulation)) {
  useOptions(std::move(options));
  simulation_.progress = {};
}

void ReplayedTrials::useOptions(bio::SystemOptions options) {
  options_ = std::move(options);
  options_.tabulatePaths = false;
}

void ReplayedTrials::beginTrial(const std::string& name, const bio::Trial& recorded) {
  ++numTrials_;
  if (numTrials_ <= mostPlayedTrials) trials_.push_back({name, &recorded, {}});
}

const ReplayedTrials::Built& ReplayedTrials::built(const bio::Model& model,
                                                   const bio::Trial& trial) {
  const bool isChanged = trial.conditions.any();
  if (const auto known = unchanged_.find(&model); !isChanged && known != unchanged_.end())
    return *known->second;
  const bio::Model& changed = isChanged
                                  ? bio::discover::withExperimentalConditions(
                                        model, options_, options_.skeleton.freeCoordinates, trial)
                                  : model;
  systems_.push_back({changed, bio::MusculoskeletalSystem(changed, options_)});
  if (!isChanged) unchanged_[&model] = &systems_.back();
  return systems_.back();
}

void ReplayedTrials::add(const std::string& name, const bio::Model& model, const bio::Trial& trial,
                         const Setting& setting) {
  if (numTrials_ > mostPlayedTrials) return;
  try {
    const auto& [changed, system] = built(model, trial);
    bio::StartPoint point = bio::beginningOf(trial, changed, system, setting.given).point;
    for (const bio::TrialStart& start : setting.starts) {
      point.q[system.skeleton().indexOf(start.coordinate)] = start.value;
      point.qDot[system.skeleton().indexOf(start.coordinate)] = start.speed;
    }
    bio::SimulationOptions simulation = simulation_;
    simulation.step = setting.step;
    auto replay = bio::completeReplay(system, trial, simulation, point);
    if (!replay) return;
    motions_.push_back(std::move(replay->motion));
    trials_.back().motions.push_back({name, changed, system, motions_.back()});
  } catch (const std::exception&) {
    // no system can be made of it, or no start; whatever it is, a motion to look at is not worth
    // the result, which is complete without it
  }
}

std::optional<Playback> ReplayedTrials::playback(const std::string& title) const {
  return playbackOf(title, trials_, options_.wrapAsCylinder, numTrials_);
}

}  // namespace app
