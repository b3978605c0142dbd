#include <fmt/format.h>

#include "discovery/effects/effects.h"

// What stands between the command of a drive and its force. Priors are judgements: torque constants
// and gear ratios known to 20 %, dead times and lags of tens of milliseconds as of buses,
// controllers and amplifiers.

namespace bio::discover {
namespace {

using info::discover::EffectKind;
using info::discover::Quantity;

std::size_t addOfDrive(EncompassingModel& model, Quantity quantity) {
  return model.add(std::move(quantity), {Meaning::Kind::drive, {}});
}

void offer(EncompassingModel& model, const MovingCoordinate& at, const std::string& id,
           const std::string& name, const std::string& sentence,
           const std::vector<std::size_t>& quantities,
           const std::vector<std::vector<double>>& starts) {
  auto one = candidateAt(model, at, id, name, sentence, quantities, starts);
  one.kind = EffectKind::input;
  model.add(std::move(one));
}

}  // namespace

// Of actuators it is their optimal force, which a model file has.
void addDriveGain(EncompassingModel& model, const MovingCoordinate& at) {
  Drive* drive = model.driveOf(at);
  if (!drive) return;
  Quantity gain = factor(model.idAt(at, "drive_gain.factor"), 0.1, 10, 0.2);
  const std::vector<std::string>& actuators = drive->command.actuators;
  std::vector<Meaning::Part> parts;
  for (const std::string& actuator : actuators)
    for (const Meaning::Part& part : model.numbers(actuator + ".optimal_force"))
      parts.push_back(part);
  std::size_t g = 0;
  if (parts.empty()) {
    g = addOfDrive(model, std::move(gain));
    drive->gain = g;
  } else {
    Meaning meaning{Meaning::Kind::scale, parts};
    if (actuators.size() == 1)
      meaning.parameter = model.parameters().find(actuators.front() + ".optimal_force");
    g = model.add(std::move(gain), std::move(meaning));
  }
  const std::string word = unitsOf(model, at).word;
  offer(model, at, "drive_gain", "gain of the drive",
        fmt::format("The drive's {} is a multiple of its command: its {} constant or gear ratio is "
                    "wrong.",
                    word, word),
        {g}, {{1.1}});
}

void addDriveDelay(EncompassingModel& model, const MovingCoordinate& at) {
  Drive* drive = model.driveOf(at);
  if (!drive) return;
  drive->delay =
      addOfDrive(model, amplitude(model.idAt(at, "drive_delay.time"), "s", 0, 0.25, 0.05));
  offer(model, at, "drive_delay", "delay of the drive", "The drive acts later than its command.",
        {*drive->delay}, {{0.02}});
}

void addDriveLag(EncompassingModel& model, const MovingCoordinate& at) {
  Drive* drive = model.driveOf(at);
  if (!drive) return;
  drive->lag = addOfDrive(model, amplitude(model.idAt(at, "drive_lag.time"), "s", 0, 0.5, 0.05));
  offer(model, at, "drive_lag", "lag of the drive",
        "The drive follows its command with a first-order lag.", {*drive->lag}, {{0.02}});
}

void addDriveSaturation(EncompassingModel& model, const MovingCoordinate& at) {
  Drive* drive = model.driveOf(at);
  if (!drive) return;
  const CoordinateUnits units = unitsOf(model, at);
  const double most = drive->command.largest;
  drive->share =
      addOfDrive(model, amplitude(model.idAt(at, "drive_saturation.share"), "", 0, 1.2, 0.7));
  drive->limit = addOfDrive(model, shape(model.idAt(at, "drive_saturation." + units.word),
                                         units.force, 0.7 * most, 0.05 * most, most, 0.25 * most));
  offer(
      model, at, "drive_saturation", "saturation of the drive",
      fmt::format("The drive's {} saturates: of a command beyond a limit, a share of the excess is "
                  "missing.",
                  units.word),
      {*drive->share, *drive->limit}, {{0.8, 0.7 * most}, {0.8, 0.85 * most}, {0.8, 0.4 * most}});
}

}  // namespace bio::discover
