#include "calibrate/calibrate_remarks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "bio/model/units.h"
#include "output/text.h"

namespace app {

void tellSteps(double asked, const bio::SteppedCalibration& found, Summary& summary) {
  const double step = found.options.trials.simulation.step;
  if (step < asked) {
    summary.warn(fmt::format(
        "the step was shortened from {} s to {} s: at longer steps halving them changes the "
        "simulated angles or the estimates noticeably",
        numberText(asked), numberText(step)));
  }
  const auto& changes = found.change.ofTrials;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (!found.change.mattersToTrial(i)) continue;
    const bio::MeasuredGroup& channel = found.training->channels()[changes[i].channel];
    const bool areAngles = channel.areAngles;
    summary.warn(fmt::format(
        "{}: halving the step of {} s changes the simulated {} by up to {:.2g} {}, {:.2g} standard "
        "deviations of the noise: use a shorter --step",
        found.training->trials()[i].file, numberText(step), areAngles ? "angles" : channel.name,
        changes[i].difference * (areAngles ? bio::degreesPerRadian : 1),
        areAngles ? "deg" : unitText(channel.unit), changes[i].difference / changes[i].sd));
  }
  if (!found.change.mattersToEstimates()) return;
  summary.warn(fmt::format(
      "halving the step of {} s would change an estimate by {:.2g} of its standard deviations: "
      "use a shorter --step",
      numberText(step), found.change.ofEstimates));
}

void tellNotFitted(const bio::TrialSet& training, const std::vector<bio::Trial>& heldOut,
                   Summary& summary) {
  std::map<std::string, std::vector<std::string>> files;  // by coordinate
  for (const auto* trials : {&training.trials(), &heldOut}) {
    for (const bio::Trial& trial : *trials) {
      for (const bio::MeasuredChannel& motion : trial.measured) {
        if (!motion.what.isCoordinate()) continue;
        const int index = training.system().skeleton().indexOf(motion.what.object);
        if (index < 0 || !training.system().isPrescribed(index)) continue;
        files[motion.what.object].push_back(trial.file);
      }
    }
  }
  for (const auto& [name, in] : files) {
    summary.warn(fmt::format(
        "{0}: the measured '{1}' is not part of the fit, since the model prescribes the motion of "
        "'{1}' (--prescribe {1} moves it as measured, --coordinate {1} simulates it)",
        fmt::join(in, ", "), name));
  }
}

}  // namespace app
