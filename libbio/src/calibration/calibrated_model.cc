#include "bio/calibration/calibrated_model.h"

#include <cmath>
#include <stdexcept>

#include "bio/analysis/driven_trial.h"
#include "bio/analysis/replay.h"
#include "bio/tables/trial_table.h"

namespace bio {
namespace {

using Eigen::Index;

bool isOfEmg(const Calibration& calibration) {
  for (const CalibratedParameter& one : calibration.parameters)
    if (one.asked.name.starts_with("emg.") || one.asked.name.find(".latent") != std::string::npos)
      return true;
  return false;
}

/// Root mean square error of all measured angles of a trial.
void compareWithReplay(const MusculoskeletalSystem& arm, const Trial& trial,
                       const SimulationOptions& simulation, const StartPoint& start,
                       CalibratedTrial& one) {
  try {
    const TrialReplay replay =
        replayTrial(arm, trial, simulation, {start, TrialBeginning::From::model});
    if (replay.motion.outcome != Outcome::completed) return;
    double sum = 0;
    one.channels = replay.channelErrors;
    for (const auto& [name, error] : replay.errors) {
      const auto i = static_cast<std::size_t>(arm.skeleton().indexOf(name));
      if (arm.isPrescribed(static_cast<int>(i))) continue;
      if (!arm.skeleton().coordinates()[i].isRotation) {
        one.channels.push_back({{Observable::Kind::coordinate, name, 0}, error});
        continue;
      }
      sum += static_cast<double>(error.count) * error.rms * error.rms;
      one.samples += error.count;
    }
    if (one.samples > 0) one.after = std::sqrt(sum / static_cast<double>(one.samples));
  } catch (const std::exception&) {
    // there is no arm, or no start, at the estimate
  }
}

}  // namespace

double CalibratedModel::rms(bool heldOut) const {
  double sum = 0, count = 0;
  for (const CalibratedTrial& one : trials) {
    if (one.isHeldOut != heldOut) continue;
    const auto n = static_cast<double>(one.samples);
    sum += std::isnan(one.after) ? one.after : n * one.after * one.after;
    count += n;
  }
  return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
}

CalibratedModel calibratedModel(const TrialSet& training, const TrialSet* heldOut,
                                const SystemOptions& arm, const SimulationOptions& simulation,
                                const Calibration& calibration) {
  if (!calibration.calibrated) throw std::invalid_argument("the calibration has no estimate");
  CalibratedModel result{calibration.calibrated->model, {}};
  const Eigen::VectorXd theta = calibration.values();
  const bool isDriven = isOfEmg(calibration);
  result.model.fitted = {simulation.step, {}};
  const MusculoskeletalSystem calibrated(result.model, arm);
  const auto& free = calibrated.skeleton().coordinates();
  for (const TrialSet* set : {&training, heldOut}) {
    if (!set) continue;
    const bool isHeldOut = set == heldOut;
    for (std::size_t i = 0; i < set->trials().size(); ++i) {
      CalibratedTrial one{i, isHeldOut, {}, {}};
      Trial trial = set->trials()[i];
      const StartPoint start = set->startAt(i, isHeldOut ? calibration.heldOutValues : theta);
      for (std::size_t c = 0; c < free.size(); ++c) {
        if (calibrated.isPrescribed(static_cast<int>(c))) continue;
        const auto k = static_cast<Index>(c);
        one.starts.push_back({trial.file, trial.sha256, free[c].name, start.q[k], start.qDot[k]});
      }
      if (!trial.sha256.empty()) {
        result.model.fitted.starts.insert(result.model.fitted.starts.end(), one.starts.begin(),
                                          one.starts.end());
      }
      if (isDriven) {
        one.driven = drivenTable(trial, set->arm(),
                                 set->mappingAt(i, isHeldOut ? calibration.heldOutValues : theta));
        TrialOptions options;
        for (const MeasuredChannel& course : trial.prescribed) {
          if (course.times.size() > 1) options.prescribed.push_back(course.what.of);
        }
        Trial driven = trialFrom(*one.driven, trial.file, result.model, options);
        driven.prescribed = std::move(trial.prescribed);
        driven.measured = std::move(trial.measured);
        trial = std::move(driven);
      }
      compareWithReplay(calibrated, trial, simulation, start, one);
      result.trials.push_back(std::move(one));
    }
  }
  return result;
}

}  // namespace bio
