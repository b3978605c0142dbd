#include <cstdio>

#include "bio/bio.h"

// Replays a recorded trial and says how far the motion is from the measured one.
int main(int, char** arguments) {
  const bio::Model model = bio::readOsim(arguments[1]);
  const bio::MusculoskeletalSystem elbow(model,
                                         {.skeleton = {.freeCoordinates = {"elbow_flexion"}}});
  const bio::Trial trial = bio::readTrial(arguments[2], model);
  const auto start = bio::beginningOf(trial, model, elbow, {});
  for (const auto& [coordinate, error] : bio::replayTrial(elbow, trial, {}, start).errors)
    std::printf("%s: off by %.4f rad\n", coordinate.c_str(), error.rms);
}
