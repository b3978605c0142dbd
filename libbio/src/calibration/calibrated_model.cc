#include "bio/calibration/calibrated_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace bio {
namespace {

using Eigen::Index;

bool changesExcitations(const Calibration& calibration) {
  return std::any_of(calibration.parameters.begin(), calibration.parameters.end(),
                     [](const CalibratedParameter& parameter) {
                       return std::holds_alternative<EmgTarget>(parameter.target);
                     });
}

/// The error of all measured angles, and of each other channel.
void compareWithReplay(const TrialReplay& replay, const MusculoskeletalSystem& system,
                       CalibratedTrial& trial) {
  double sum = 0;
  trial.channels = replay.channelErrors;
  for (const auto& [name, error] : replay.errors) {
    const auto i = static_cast<std::size_t>(system.skeleton().indexOf(name));
    if (system.isPrescribed(static_cast<int>(i))) continue;
    if (!system.skeleton().coordinates()[i].isRotation) {
      trial.channels.push_back({ofCoordinate(name), error});
      continue;
    }
    sum += static_cast<double>(error.count) * error.rms * error.rms;
    trial.samples += error.count;
  }
  if (trial.samples > 0) trial.after = std::sqrt(sum / static_cast<double>(trial.samples));
}

}  // namespace

double CalibratedModel::rms(bool heldOut) const {
  return pooledRms(trials, &CalibratedTrial::after, heldOut);
}

CalibratedModel calibratedModel(const TrialSet& training, const TrialSet* heldOut,
                                const SystemOptions& system, const SimulationOptions& simulation,
                                const Calibration& calibration) {
  if (!calibration.calibrated) throw std::invalid_argument("the calibration has no estimate");
  CalibratedModel result{calibration.calibrated->model, {}};
  const Eigen::VectorXd theta = calibration.values();
  const bool isDriven = changesExcitations(calibration);
  result.model.fitted = {simulation.step, {}};
  const MusculoskeletalSystem calibrated(result.model, system);
  const auto& free = calibrated.skeleton().coordinates();
  for (const TrialSet* set : {&training, heldOut}) {
    if (!set) continue;
    const bool isHeldOut = set == heldOut;
    for (std::size_t i = 0; i < set->trials().size(); ++i) {
      CalibratedTrial one;
      one.index = i;
      one.isHeldOut = isHeldOut;
      Trial trial = set->trials()[i];
      const Eigen::VectorXd& values = isHeldOut ? calibration.heldOutValues : theta;
      const StartPoint start = set->startAt(i, values);
      for (std::size_t c = 0; c < free.size(); ++c) {
        if (calibrated.isPrescribed(static_cast<int>(c))) continue;
        const auto k = static_cast<Index>(c);
        one.starts.push_back({trial.file, trial.sha256, free[c].name, start.q[k], start.qDot[k]});
      }
      addStarts(result.model, one, trial.file, trial.sha256);
      if (isDriven) {
        one.driven = drivenTable(trial, set->system(), set->mappingAt(i, values));
        trial = drivenTrial(*one.driven, trial, result.model);
      }
      if (const auto replay = completeReplay(calibrated, trial, simulation, start))
        compareWithReplay(*replay, calibrated, one);
      result.trials.push_back(std::move(one));
    }
  }
  return result;
}

}  // namespace bio
