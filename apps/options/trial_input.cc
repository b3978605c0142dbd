#include "options/trial_input.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "bio/analysis/replay.h"
#include "bio/model/convert_muscles.h"
#include "bio/opensim/external_loads.h"
#include "bio/opensim/osim_file.h"
#include "bio/review/trial_review.h"
#include "bio/skeleton/articulated_tree.h"
#include "bio/skeleton/free_coordinates.h"
#include "options/model_methods.h"
#include "options/system_options.h"
#include "output/sha256.h"
#include "output/text.h"

namespace app {
namespace {

void addFileArgument(CLI::App& subcommand, const std::string& name, std::string& file,
                     const std::string& description) {
  subcommand.add_option(name, file, description)
      ->required()
      ->check(CLI::ExistingFile)
      ->type_name("");
}

}  // namespace

void addModelArgument(CLI::App& subcommand, std::string& model) {
  addFileArgument(subcommand, "MODEL", model, "model (.osim, URDF or MJCF)");
}

void addTrialArgument(CLI::App& subcommand, std::string& trial) {
  addFileArgument(subcommand, "TRIAL", trial,
                  "trial: excitations, and the measured coordinate if it was recorded");
}

bio::Model readModel(const std::string& file, Summary& summary) {
  summary.addInput(file);
  bio::Model model = bio::readOsim(file);
  for (const std::string& warning : model.warnings) summary.warn(warning);
  return model;
}

void addConvertMusclesOption(CLI::App& subcommand, std::string& muscleClass) {
  subcommand
      .add_option(
          "--convert-muscles", muscleClass,
          "take all muscles as of this class: Thelen2003, Millard2012, "
          "DeGrooteFregly2016, Schutte1993, RigidTendon (Millard2012 with a rigid tendon) or "
          "RigidTendonMuscle (OpenSim's class); what they lose is said")
      ->type_name("CLASS");
}

void convertMuscles(const std::string& muscleClass, bio::Model& model, Summary& summary) {
  if (muscleClass.empty()) return;
  for (const std::string& lost : bio::convertMuscles(model, muscleClass).lost) {
    summary.warn(fmt::format("muscles as {}: lost is {}", muscleClass, lost));
  }
}

void addExternalLoadsOption(CLI::App& subcommand, std::string& file) {
  subcommand
      .add_option("--external-loads", file,
                  "forces and torques on bodies: OpenSim's ExternalLoads (.xml), whose datafile "
                  "covers the trial")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
}

void addExternalLoads(const std::string& file, bio::Model& model, Summary& summary) {
  if (file.empty()) return;
  summary.addInput(file);
  std::vector<std::string> warnings;
  model.externalLoads = bio::readExternalLoads(file, model, warnings);
  for (const std::string& warning : warnings) summary.warn(warning);
}

namespace {

/// Names of the coordinates and moments that the trials measure.
struct MeasuredNames {
  std::set<std::string> coordinates, moments;
};

MeasuredNames measuredIn(const std::vector<std::string>& trials, const bio::Model& model,
                         const SimulationOptions& options) {
  MeasuredNames names;
  for (const std::string& file : trials) {
    const bio::Trial trial = bio::readTrial(
        file, model, {.ignoreExtra = options.ignoreExtra, .experimentalConditions = true});
    for (const bio::MeasuredChannel& channel : trial.measured) {
      if (channel.what.isCoordinate()) names.coordinates.insert(channel.what.object);
      if (channel.what.kind == bio::Observable::Kind::moment)
        names.moments.insert(channel.what.object);
    }
  }
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void checkPrescribed(const SimulationOptions& options, const bio::Model& model) {
  for (const std::string& name : options.prescribed) {
    (void)bio::findCoordinate(model, name);
    if (std::count(options.prescribed.begin(), options.prescribed.end(), name) > 1) {
      throw std::invalid_argument(fmt::format("--prescribe: '{}' is given twice", name));
    }
    if (contains(options.coordinates, name)) {
      throw std::invalid_argument(fmt::format(
          "'{}' is given with --coordinate and --prescribe, must be free or prescribed", name));
    }
    for (const Assignment& lock : options.locks) {
      if (lock.name != name) continue;
      throw std::invalid_argument(fmt::format(
          "'{}' is given with --lock and --prescribe, must be locked or prescribed", name));
    }
  }
}

/// The coordinates that have a role from the command line.
std::set<std::string> roledByOptions(const SimulationOptions& options) {
  std::set<std::string> names(options.prescribed.begin(), options.prescribed.end());
  names.insert(options.coordinates.begin(), options.coordinates.end());
  for (const Assignment& lock : options.locks) names.insert(lock.name);
  return names;
}

/// Coordinates that move on the model's own functions of time, which not every command takes.
void takePrescribedByModel(SimulationOptions& options, const bio::Model& model, bool simulates) {
  if (options.takesPrescribed) {
    options.prescribedByModel = bio::prescribedByModel(model, roledByOptions(options));
  } else if (simulates) {
    refusePrescribedByModel(options, model);
  }
}

/// The locked coordinates at which a moment is measured, or all of them.
void holdLocked(SimulationOptions& options, const bio::Model& model,
                const std::set<std::string>& moments, bool all) {
  std::set<std::string> others(options.prescribed.begin(), options.prescribed.end());
  others.insert(options.prescribedByModel.begin(), options.prescribedByModel.end());
  for (const std::string& name : bio::independentCoordinates(model)) {
    if (others.contains(name) || !contains(options.coordinates, name)) continue;
    if (moments.contains(name)) {
      throw std::invalid_argument(fmt::format(
          "'{0}.moment' is measured, but '{0}' is free to move, where nothing holds it: must be "
          "prescribed (--prescribe {0}, its motion is that of the trial) or locked (--lock {0}=…)",
          name));
    }
    others.insert(name);
  }
  for (const auto& [name, value] : bio::heldCoordinates(model, others, byName(options.locks))) {
    if (all || moments.contains(name)) options.held[name] = value;
  }
}

}  // namespace

void refusePrescribedByModel(const SimulationOptions& options, const bio::Model& model) {
  const std::set<std::string> otherwise = roledByOptions(options);
  for (const std::string& name : bio::independentCoordinates(model)) {
    if (!bio::findCoordinate(model, name).isPrescribed() || otherwise.contains(name)) continue;
    throw std::invalid_argument(
        fmt::format("the model prescribes the motion of '{0}', which this command does not take: "
                    "'{0}' must be locked (--lock {0}=…) or free (--coordinate {0})",
                    name));
  }
}

void chooseCoordinates(SimulationOptions& options, const bio::Model& model,
                       const std::vector<std::string>& trials, bool allReactions,
                       const std::vector<std::string>& observed) {
  checkPrescribed(options, model);
  takePrescribedByModel(options, model, !trials.empty());
  const bool isTyped = !options.coordinates.empty();
  if (isTyped && (trials.empty() || !options.takesPrescribed) && !allReactions) return;
  MeasuredNames measured = measuredIn(trials, model, options);
  if (!options.takesPrescribed) measured.moments.clear();
  for (const std::string& text : observed) {
    const std::string name = text.substr(0, text.find('='));
    if (name.ends_with(".moment")) measured.moments.insert(name.substr(0, name.size() - 7));
  }
  if (!isTyped) {
    options.areChosen = true;
    std::set<std::string> locked(options.prescribed.begin(), options.prescribed.end());
    for (const Assignment& lock : options.locks) locked.insert(lock.name);
    locked.insert(options.prescribedByModel.begin(), options.prescribedByModel.end());
    const bool mayBeNone = !options.prescribed.empty() || !options.prescribedByModel.empty() ||
                           !measured.moments.empty() || allReactions;
    options.coordinates = bio::freeByDefault(model, locked, measured.coordinates, mayBeNone);
  }
  holdLocked(options, model, measured.moments, allReactions);
}

void requireFreeCoordinate(const SimulationOptions& options) {
  if (!options.coordinates.empty()) return;
  throw std::invalid_argument(
      "every coordinate is prescribed or held: one must be free (--coordinate), since this command "
      "is about its motion");
}

bio::MusculoskeletalSystem movableSystem(const bio::Model& model, const std::string& file,
                                         const SimulationOptions& options, Summary& summary) {
  bio::MusculoskeletalSystem system = [&] {
    try {
      return bio::MusculoskeletalSystem(model, systemOptions(options));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", file, error.what()));
    }
  }();
  for (const std::string& warning : system.warnings()) summary.warn(warning);
  if (system.numMuscles() == 0 && !model.muscles.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: no muscle moves {}", file, fmt::join(options.coordinates, ", ")));
  }
  sayModel(model, system, summary.methods());
  sayCylinders(options.wrapAsCylinder, summary.methods());
  return system;
}

bio::Trial readTrialFile(const std::string& file, const bio::Model& model,
                         const SimulationOptions& options, const TrialUse& use) {
  bio::Trial trial = bio::readTrial(file, model,
                                    {.ignoreExtra = options.ignoreExtra,
                                     .experimentalConditions = use.experimentalConditions,
                                     .prescribed = options.prescribed,
                                     .held = options.held});
  trial.sha256 = sha256OfFile(file);
  const double duration = trial.duration();
  if (options.step && *options.step > duration) {
    throw std::invalid_argument(fmt::format("{}: lasts {} s, --step {} s must not be longer", file,
                                            numberText(duration), numberText(*options.step)));
  }
  bio::requireLoadsCover(model.externalLoads, trial.times[0], trial.times[0] + duration);
  for (const bio::Remark& remark : bio::reviewTrial(trial, model)) {
    const std::string line = fmt::format("{}: {}: {}", file, remark.subject, remark.message);
    if (remark.weight == bio::Weight::error) throw std::invalid_argument(line);
    if (remark.weight == bio::Weight::warning) trial.warnings.push_back(line);
  }
  for (std::string& line : bio::heldRemarks(trial, model, systemOptions(options).skeleton)) {
    trial.warnings.push_back(std::move(line));
  }
  for (const bio::MeasuredChannel& channel : trial.measured) {
    if (use.channels || channel.what.isCoordinate()) continue;
    trial.warnings.push_back(fmt::format(
        "{}: column '{}' is measured, but not used by this command", file, nameOf(channel.what)));
  }
  if (options.prescribeCutoff) {
    bio::smoothPrescribed(trial, *options.prescribeCutoff);
  } else {
    for (std::string& line : bio::roughnessRemarks(trial, model)) {
      trial.warnings.push_back(std::move(line));
    }
  }
  return trial;
}

double longestDuration(const std::vector<bio::Trial>& trials) {
  double longest = 0;
  for (const bio::Trial& trial : trials) longest = std::max(longest, trial.duration());
  return longest;
}

TrialInput readTrialInput(const std::string& file, const bio::Model& model,
                          const bio::MusculoskeletalSystem& system,
                          const SimulationOptions& options, Summary& summary, const TrialUse& use) {
  summary.addInput(file);
  TrialInput input;
  input.trial = readTrialFile(file, model, options, use);
  for (const std::string& warning : input.trial.warnings) summary.warn(warning);
  sayExcitations(system, summary.methods());
  input.recorded =
      bio::recordedTrial(input.trial, system,
                         simulationOptions(options, input.trial.times[0], input.trial.duration()));
  const bio::TrialBeginning beginning =
      bio::beginningOf(input.trial, model, system, byName(options.initial));
  input.from = beginning.from;
  input.start = input.recorded.startAt(system, beginning.point);
  return input;
}

}  // namespace app
