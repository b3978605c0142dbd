#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "bio/analysis/replay.h"
#include "bio/simulation/simulate.h"
#include "bio/tables/trial.h"
#include "options/simulation_options.h"
#include "output/summary.h"

/// Reads the model and trials of a subcommand. Every file becomes an input of the summary, every
/// remark a warning.
namespace app {

/// The required argument MODEL.
void addModelArgument(CLI::App& subcommand, std::string& model);

/// The required argument TRIAL.
void addTrialArgument(CLI::App& subcommand, std::string& trial);

/// @throws what readOsim throws
/// Adds --convert-muscles.
void addConvertMusclesOption(CLI::App& subcommand, std::string& muscleClass);
/// Makes all muscles of the class and warns of what they lose; nothing for an empty name.
void convertMuscles(const std::string& muscleClass, bio::Model& model, Summary& summary);

/// Adds --external-loads.
void addExternalLoadsOption(CLI::App& subcommand, std::string& file);
/// The loads of an ExternalLoads document, added to the model; nothing for an empty name.
void addExternalLoads(const std::string& file, bio::Model& model, Summary& summary);

bio::Model readModel(const std::string& file, Summary& summary);

/// Throws std::invalid_argument for a coordinate that the model prescribes and no option locks,
/// frees or prescribes: for commands that take none.
void refusePrescribedByModel(const SimulationOptions& options, const bio::Model& model);

/// Chooses the free coordinates if none were typed: bio::freeByDefault with what the trials
/// measure, without those that are prescribed, by the trials or by the model; locked coordinates at
/// which a trial measures the moment are held.
/// @param allReactions  every coordinate that is locked is held
/// @param observed      NAME or NAME=SD each; locked coordinates whose NAME.moment is observed are
/// held
/// @throws what readTrial and freeByDefault throw; std::invalid_argument for a prescribed
///   coordinate that is also free or locked, a moment measured at a free one, or one that the model
///   prescribes where the command takes none
void chooseCoordinates(SimulationOptions& options, const bio::Model& model,
                       const std::vector<std::string>& trials, bool allReactions = false,
                       const std::vector<std::string>& observed = {});

/// For commands that are about the motion of a coordinate that is simulated.
/// @throws std::invalid_argument if all coordinates are prescribed or held
void requireFreeCoordinate(const SimulationOptions& options);

/// Use that a command makes of the rest of a trial.
struct TrialUse {
  bool experimentalConditions = false;  ///< takes the known mass and turn into account
  bool channels = false;                ///< uses all measured channels, not coordinates alone
};

/// The system with the free coordinates that the model options choose.
/// @param file  the model's, for the message
/// @throws std::invalid_argument what MusculoskeletalSystem throws, or if no muscle moves the free
/// coordinates
bio::MusculoskeletalSystem movableSystem(const bio::Model& model, const std::string& file,
                                         const SimulationOptions& options, Summary& summary);

/// Reads a trial according to the simulation options. The trial's warnings include those of
/// reviewTrial, heldRemarks and roughnessRemarks, and say what the command does not use; they are
/// not passed to the summary. Prescribed motions are smoothed if that is asked for.
/// @throws what readTrial and heldRemarks throw; std::invalid_argument if --step is longer than the
///   trial, or for an error of reviewTrial
bio::Trial readTrialFile(const std::string& file, const bio::Model& model,
                         const SimulationOptions& options, const TrialUse& use = {});

/// Duration of the longest trial [s]; 0 without trials.
double longestDuration(const std::vector<bio::Trial>& trials);

/// A trial with the initial state and inputs of its simulation.
struct TrialInput {
  bio::Trial trial;
  bio::RecordedTrial recorded;     ///< with the integrator and step of the options
  bio::TrialBeginning::From from;  ///< where the initial state comes from
  bio::SystemState start;          ///< from bio::beginningOf: --initial, else the model's fitted
                                   ///< start, else the measurement
};
/// @throws what readTrialFile, recordedTrial, beginningOf and initialState throw
TrialInput readTrialInput(const std::string& file, const bio::Model& model,
                          const bio::MusculoskeletalSystem& system,
                          const SimulationOptions& options, Summary& summary,
                          const TrialUse& use = {});

}  // namespace app
