#pragma once

/// What most programs need of libbio, in the order of a study; docs/tutorial.md shows the first
/// ones at work.
#include "bio/analysis/replay.h"  // replayTrial: the motion that a trial makes, its errors
#include "bio/analysis/sensitivity_study.h"  // localSensitivity: what trials tell about parameters
#include "bio/analysis/trial_ensemble.h"     // TrialEnsemble: a trial over many parameter values
#include "bio/calibration/calibrate.h"       // calibrate: parameters from measured motions
#include "bio/calibration/trial_set.h"       // TrialSet: the trials to calibrate with
#include "bio/design/experiment_design.h"    // ExperimentDesign: inputs that tell the most
#include "bio/discovery/workflow.h"          // discover: the effect that a model lacks
#include "bio/model/model.h"                 // Model: what an .osim file says
#include "bio/opensim/osim_file.h"           // readOsim, writeOsim, rewriteOsim
#include "bio/simulation/musculoskeletal_system.h"  // MusculoskeletalSystem: a model to simulate
#include "bio/simulation/simulate.h"                // simulate: a motion from excitations
#include "bio/tables/trial.h"                       // readTrial: recorded excitations and motion
