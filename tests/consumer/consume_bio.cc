#include <cstdio>
#include <exception>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"
#include "info/version.h"

// consume_bio MODEL TRIAL: replays the trial and prints how far the motion is from the measured
// one.
int main(int count, char** arguments) try {
  if (count != 3) return 2;
  const bio::Model model = bio::readOsim(arguments[1]);
  bio::SystemOptions options;
  options.skeleton.freeCoordinates = {"elbow_flexion"};
  const bio::MusculoskeletalSystem arm(model, options);
  const bio::Trial trial = bio::readTrial(arguments[2], model);
  const auto excitation = bio::excitationOf(trial, arm);
  const auto start =
      bio::initialState(arm, bio::startCoordinates(trial, arm, {}), excitation, trial.times[0]);
  bio::SimulationOptions simulation;
  simulation.duration = trial.times[trial.times.size() - 1] - trial.times[0];
  const auto motion = bio::simulate(arm, excitation, start, simulation);
  const auto error = bio::compareWithMeasured(arm, motion, trial.measured.front());
  std::printf("FisherHill %s: rms_error_deg %.6f\n", info::version(),
              error.rms * 57.29577951308232);
  return motion.outcome == bio::Outcome::completed ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "consume_bio: %s\n", error.what());
  return 2;
}
