#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "bio/coupled.h"
#include "bio/replay.h"
#include "bio/trial.h"
#include "simulation_options.h"
#include "summary.h"

/// Reads the model and trials of a subcommand. Every file becomes an input of the summary, every
/// remark a warning.
namespace app {

/// The required argument MODEL.
void addModelArgument(CLI::App& subcommand, std::string& model);

/// The required argument TRIAL.
void addTrialArgument(CLI::App& subcommand, std::string& trial);

/// @throws what readOsim throws
bio::Model readModel(const std::string& file, Summary& summary);

/// The system with the free coordinates that the model options choose.
/// @param file  the model's, for the message
/// @throws std::invalid_argument what Arm throws, or if no muscle moves the free coordinates
bio::Arm movableArm(const bio::Model& model, const std::string& file,
                    const SimulationOptions& options, Summary& summary);

/// Reads a trial according to the simulation options. The trial's warnings include those of
/// reviewTrial and heldRemarks; they are not passed to the summary.
/// @param knownChanges the command takes the experimental conditions (known mass, turn) into
///   account
/// @throws what readTrial and heldRemarks throw; std::invalid_argument if --step is longer than the
///   trial, or for an error of reviewTrial
bio::Trial readTrialFile(const std::string& file, const bio::Model& model,
                         const SimulationOptions& options, bool knownChanges = false);

/// Duration of the longest trial [s]; 0 without trials.
double longestDuration(const std::vector<bio::Trial>& trials);

/// A trial with the initial state and inputs of its simulation.
struct TrialInput {
  bio::Trial trial;
  bio::ExcitationSignal excitation;  ///< of the arm's muscles
  bio::ExternalForce externalForce;  ///< empty: none
  double startTime = 0;              ///< [s]
  double duration = 0;               ///< [s]
  bio::TrialBeginning::From from;    ///< where the initial state comes from
  bio::ArmState start;  ///< from bio::beginningOf: --initial, else the model's fitted start, else
                        ///< the measurement
};
/// @throws what readTrialFile, excitationOf, externalForceOf, beginningOf and initialState
/// throw
TrialInput readTrialInput(const std::string& file, const bio::Model& model, const bio::Arm& arm,
                          const SimulationOptions& options, Summary& summary);

}  // namespace app
