#include <cstdio>
#include <exception>
#include <numbers>

#include "bio/bio.h"
#include "info/version.h"

// consume_bio MODEL TRIAL: replays the trial and prints how far the motion is from the measured
// one.
int main(int count, char** arguments) try {
  if (count != 3) return 2;
  const bio::Model model = bio::readOsim(arguments[1]);
  const bio::MusculoskeletalSystem system(model,
                                          {.skeleton = {.freeCoordinates = {"elbow_flexion"}}});
  const bio::Trial trial = bio::readTrial(arguments[2], model);
  const bio::TrialReplay replay =
      bio::replayTrial(system, trial, {}, bio::beginningOf(trial, model, system, {}));
  std::printf("FisherHill %s: rms_error_deg %.6f\n", info::version(),
              replay.errors.front().second.rms * 180 / std::numbers::pi);
  return replay.motion.outcome == bio::Outcome::completed ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "consume_bio: %s\n", error.what());
  return 2;
}
