// Processor time of a simulation of any model and trial, set-up apart:
//     replay_model MODEL.osim TRIAL.sto SECONDS [STEP [RUNS]] [COORDINATE=VALUE …]
// The named coordinates are free and start there, at rest [rad] or [m]. Prints median and least of
// the runs, the first one left out.
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"

namespace {

double milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

void measure(const std::vector<std::string>& words) {
  bio::SystemOptions options;
  std::vector<double> start, numbers;
  for (std::size_t i = 2; i < words.size(); ++i) {
    const auto equals = words[i].find('=');
    if (equals == std::string::npos) {
      numbers.push_back(std::stod(words[i]));
      continue;
    }
    options.skeleton.freeCoordinates.push_back(words[i].substr(0, equals));
    start.push_back(std::stod(words[i].substr(equals + 1)));
  }
  if (numbers.empty() || start.empty()) throw std::invalid_argument("no duration or coordinate");
  bio::SimulationOptions simulation;
  simulation.duration = numbers[0];
  if (numbers.size() > 1) simulation.step = numbers[1];
  const int runs = numbers.size() > 2 ? static_cast<int>(numbers[2]) : 101;

  const bio::Model model = bio::readOsim(words[0]);
  const bio::MusculoskeletalSystem system(model, options);
  const bio::ExcitationSignal excitation =
      bio::excitationOf(bio::readTrial(words[1], model), system);
  const Eigen::VectorXd q =
      Eigen::VectorXd::Map(start.data(), static_cast<Eigen::Index>(start.size()));
  const bio::SystemState state = bio::initialState(system, q, excitation, 0);
  bio::Trajectory motion = bio::simulate(system, excitation, state, simulation);
  std::vector<double> times;
  for (int i = 0; i < runs; ++i) {
    const double begin = milliseconds();
    motion = bio::simulate(system, excitation, state, simulation);
    times.push_back(milliseconds() - begin);
  }
  std::sort(times.begin(), times.end());
  fmt::print(
      "median {:.4g} ms, least {:.4g} ms; {} steps, {:.2f} Newton iterations a step; ends at",
      times[times.size() / 2], times.front(), motion.steps,
      static_cast<double>(motion.newtonIterations) / static_cast<double>(motion.steps));
  for (const double value : motion.q.col(motion.q.cols() - 1)) fmt::print(" {:.12g}", value);
  fmt::print("\n");
}

}  // namespace

int main(int count, char** words) {
  if (count < 5) {
    fmt::print(
        stderr,
        "usage: replay_model MODEL.osim TRIAL.sto SECONDS [STEP [RUNS]] COORDINATE=VALUE …\n");
    return 2;
  }
  try {
    measure({words + 1, words + count});
    return 0;
  } catch (const std::exception& problem) {
    fmt::print(stderr, "replay_model: {}\n", problem.what());
    return 1;
  }
}
