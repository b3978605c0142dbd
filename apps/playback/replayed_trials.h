#pragma once

#include <list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bio/analysis/driven_trial.h"
#include "bio/model/model.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "bio/simulation/simulate.h"
#include "bio/tables/trial.h"
#include "playback/playback.h"

namespace app {

/// Trials replayed with several models for a report to play, as `replay` does it; the first
/// mostPlayedTrials of them.
class ReplayedTrials {
 public:
  /// @param simulation  integrator; times, and step where none is given, are those of each trial
  ReplayedTrials(bio::SystemOptions options, bio::SimulationOptions simulation);

  /// For the models of the trials that follow.
  void useOptions(bio::SystemOptions options);

  /// Begins another trial.
  /// @param recorded  with what was measured; must outlive this object
  void beginTrial(const std::string& name, const bio::Trial& recorded);

  /// How one replay begins and goes on.
  struct Setting {
    double step = 0;                           ///< [s]
    std::map<std::string, double> given = {};  ///< values at the start, as beginningOf() has them
    std::vector<bio::TrialStart> starts = {};  ///< instead of those
  };
  /// Another motion of the trial begun last; left out if it cannot begin, or does not reach its
  /// end.
  /// @param model  must outlive this object
  void add(const std::string& name, const bio::Model& model, const bio::Trial& trial,
           const Setting& setting);

  /// What playbackOf() makes of them.
  std::optional<Playback> playback(const std::string& title) const;

 private:
  struct Built {
    bio::Model model;
    bio::MusculoskeletalSystem system;
  };
  const Built& built(const bio::Model& model, const bio::Trial& trial);

  bio::SystemOptions options_;
  bio::SimulationOptions simulation_;
  std::list<Built> systems_;
  std::map<const bio::Model*, const Built*> unchanged_;  ///< of trials without conditions
  std::list<bio::Trajectory> motions_;
  std::vector<PlayedTrial> trials_;
  std::size_t numTrials_ = 0;
};

}  // namespace app
