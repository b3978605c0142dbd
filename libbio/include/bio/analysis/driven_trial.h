#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "bio/analysis/replay.h"
#include "bio/emg/emg_mapping.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "bio/tables/table_file.h"
#include "bio/tables/trial.h"

/// Trials as a fitted model replays them.
namespace bio {

/// The trial for a model without EMG parameters: the excitations that drove the muscles, with rows
/// at all their corners, and the measurements.
Table drivenTable(const Trial& trial, const MusculoskeletalSystem& system,
                  const EmgMapping& mapping);

/// The trial that a replay reads from drivenTable().
/// @param recorded  has the courses of prescribed coordinates
/// @param model     without EMG parameters
/// @throws what trialFrom throws
Trial drivenTrial(const Table& driven, const Trial& recorded, const Model& model);

/// A trial of a fit, and its replay with the fitted model.
struct FittedTrial {
  std::size_t index = 0;           ///< in its set
  bool isHeldOut = false;          ///< tested only
  std::vector<TrialStart> starts;  ///< of every free coordinate that is not prescribed
  std::optional<Table> driven;     ///< trial to replay instead: the excitations that drove the
                                   ///< muscles, sensor errors removed
  double after = std::numeric_limits<double>::quiet_NaN();  ///< RMS error of the replay; NaN: none
  Eigen::Index samples = 0;                                 ///< compared by it
};

/// Adds the trial's starts to Model::fitted.
/// @param file, sha256  of the file that they belong to; a trial without hash has none
void addStarts(Model& model, const FittedTrial& fitted, const std::string& file,
               const std::string& sha256);

/// The trial's replay from this point; nothing if its simulation does not reach the end, or cannot
/// begin.
std::optional<TrialReplay> completeReplay(const MusculoskeletalSystem& system, const Trial& trial,
                                          const SimulationOptions& simulation,
                                          const StartPoint& start);

/// √(Σ nᵢ rᵢ² / Σ nᵢ) over the held-out or the other trials; NaN if one of them has none.
template <class OfTrial, class Base>
double pooledRms(const std::vector<OfTrial>& trials, double Base::*rms, bool heldOut) {
  double sum = 0, count = 0;
  for (const OfTrial& trial : trials) {
    if (trial.isHeldOut != heldOut) continue;
    const auto n = static_cast<double>(trial.samples);
    sum += std::isnan(trial.*rms) ? trial.*rms : n * trial.*rms * trial.*rms;
    count += n;
  }
  return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace bio
