// The speed table: medians on one core, and their ratios. `speed_table --run JOB TIMES` only runs a
// job, for programs that count instructions; `--jobs` lists them.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>

#include "hot_jobs.h"
#include "kept_memory.h"

namespace {

using bio::bench::HotJobs;

double milliseconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

struct Times {
  double median = 0, least = 0;  ///< [ms]
};

/// Of some repetitions, the first one left out.
Times timesOf(const std::function<void()>& work, int repetitions) {
  std::vector<double> times;
  work();
  for (int i = 0; i < repetitions; ++i) times.push_back(milliseconds(work));
  std::sort(times.begin(), times.end());
  return {times[times.size() / 2], times.front()};
}

void row(const std::string& work, const Times& t, double simulation, const std::string& target) {
  const std::string ratio =
      simulation > 0 ? fmt::format("{:.3g}", t.median / simulation) : std::string("–");
  fmt::print("| {} | {:.4g} | {:.4g} | {} | {} |\n", work, t.median, t.least, ratio, target);
  std::fflush(stdout);
}

/// Largest and RMS difference of the elbow's angle from the converged motion [deg].
std::pair<double, double> error(const bio::Trajectory& motion, const bio::Trajectory& converged) {
  const Eigen::VectorXd off =
      (motion.q - converged.q).row(0).transpose() * (180 / std::numbers::pi);
  return {off.cwiseAbs().maxCoeff(), std::sqrt(off.squaredNorm() / double(off.size()))};
}

void table(const std::string& largeModel, const std::string& program) {
  HotJobs jobs;
  const auto find = [&](const std::string& name) -> const HotJobs::Job& {
    return *std::find_if(HotJobs::all().begin(), HotJobs::all().end(),
                         [&](const HotJobs::Job& job) { return job.name == name; });
  };
  const auto timed = [&](const std::string& name, int repetitions) {
    return timesOf([&] { jobs.run(find(name)); }, repetitions);
  };
  fmt::print(
      "| work | median [ms] | least [ms] | in simulations | target |\n|---|---|---|---|---|\n");
  const Times simulation = timed("simulation", 201);
  const double one = simulation.median;
  const auto [largest, rms] = error(jobs.simulate(HotJobs::options()),
                                    jobs.simulate(HotJobs::options(0.01, bio::Integrator::cvode)));
  row(fmt::format("4.5 s of the eight-muscle elbow, variational, 0.01 s ({:.2f} Newton iterations "
                  "a step; {:.4f}° RMS, {:.4f}° at most from the converged motion)",
                  jobs.newtonIterations, rms, largest),
      simulation, one, "≤ 1.0 ms, ≤ 0.1° RMS");
  row("the same by Runge–Kutta at 4e-4 s, its largest stable step", timed("runge-kutta", 9), one,
      "–");
  row("60 sensitivities beside it", timed("sensitivities-60", 51), one, "≤ 12 ms");
  row(fmt::format("all {} sensitivities beside it", jobs.numParameters()),
      timed("sensitivities-all", 21), one, "–");
  row(fmt::format("a prediction as `discover` asks for it: {} quantities, {} latent nodes",
                  jobs.numPredicted(), jobs.numNodes()),
      timed("prediction", 51), one, "–");
  row("an arm compiled from its model", timed("compilation", 101), one, "–");
  row("1000 configurations", timed("configurations", 101), one, "–");
  constexpr int members = 10000;
  int completed = 0;
  const double ensemble = milliseconds([&] { completed = jobs.ensemble(members, 2); });
  row(fmt::format("{} simulations with 24 parameters drawn, 2 threads, once ({} reached the end)",
                  members, completed),
      {ensemble, ensemble}, one, "≤ 3 s");
  if (!largeModel.empty()) {
    row("the full upper-limb model read", timesOf([&] { bio::readOsim(largeModel); }, 21), 0,
        "≤ 100 ms");
  }
  if (!program.empty()) {
    const std::string command = program + " --help > /dev/null";
    row("`fisherhill --help`",
        timesOf(
            [&] {
              if (std::system(command.c_str()) != 0) throw std::runtime_error(command + " failed");
            },
            21),
        0, "≤ 20 ms");
  }
}

}  // namespace

int main(int count, char** words) {
  const std::vector<std::string> arguments(words + 1, words + count);
  try {
    if (arguments.size() == 1 && arguments[0] == "--jobs") {
      for (const HotJobs::Job& job : HotJobs::all()) fmt::print("{}\n", job.name);
      return 0;
    }
    if (arguments.size() == 3 && arguments[0] == "--run") {
      HotJobs jobs;
      for (const HotJobs::Job& job : HotJobs::all()) {
        if (job.name != arguments[1]) continue;
        for (int i = std::stoi(arguments[2]); i > 0; --i) jobs.run(job);
        return 0;
      }
      throw std::invalid_argument("no such job");
    }
    table(arguments.empty() ? "" : arguments[0], arguments.size() < 2 ? "" : arguments[1]);
    return 0;
  } catch (const std::exception& problem) {
    fmt::print(stderr, "speed_table: {}\n", problem.what());
    return 1;
  }
}
