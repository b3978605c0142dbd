#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "bio/coupled.h"
#include "bio/replay.h"
#include "bio/trial.h"
#include "simulation_options.h"
#include "summary.h"

/// What subcommands with a model and trials read; every file becomes an input of the summary, every
/// remark a warning.
namespace app {

/// The required argument MODEL.
void addModelArgument(CLI::App& subcommand, std::string& model);

/// The required argument TRIAL.
void addTrialArgument(CLI::App& subcommand, std::string& trial);

/// @throws what readOsim throws
bio::Model readModel(const std::string& file, Summary& summary);

/// The arm that the model options leave.
/// @param file  the model's, for the message
/// @throws std::invalid_argument what Arm throws, or if no muscle moves the free coordinates
bio::Arm movableArm(const bio::Model& model, const std::string& file,
                    const SimulationOptions& options, Summary& summary);

/// A trial's file by the simulation options. What reviewTrial warns of and heldRemarks are among
/// its warnings; the summary is not told.
/// @param knownChanges  the command takes into account what was changed on purpose
/// @throws what readTrial and heldRemarks throw; std::invalid_argument if --step is longer than the
///   trial, or for an error of reviewTrial
bio::Trial readTrialFile(const std::string& file, const bio::Model& model,
                         const SimulationOptions& options, bool knownChanges = false);

/// [s] of the longest one; 0 without trials.
double longestDuration(const std::vector<bio::Trial>& trials);

/// A trial, and how it starts and drives an arm.
struct TrialInput {
  bio::Trial trial;
  bio::ExcitationSignal excitation;  ///< of the arm's muscles
  bio::ExternalForce externalForce;  ///< empty: none
  double startTime = 0;              ///< [s]
  double duration = 0;               ///< [s]
  bio::TrialBeginning::From from;    ///< who says where it starts
  bio::ArmState
      start;  ///< as bio::beginningOf has it: --initial, else the model, else what was measured
};
/// @throws what readTrialFile, excitationOf, externalForceOf, beginningOf and initialState
/// throw
TrialInput readTrialInput(const std::string& file, const bio::Model& model, const bio::Arm& arm,
                          const SimulationOptions& options, Summary& summary);

}  // namespace app
