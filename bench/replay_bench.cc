// The main job: 4.5 s of a shipped trial on the eight-muscle elbow.
#include <benchmark/benchmark.h>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"
#include "libbio/simulation/arm_of_seven.h"

namespace {

const std::string root = FISHERHILL_SOURCE_DIR;

struct Job {
  explicit Job(const std::string& file = "elbow8.osim")
      : model(bio::readOsim(root + "/models/" + file)) {}
  bio::Model model;
  bio::MusculoskeletalSystem system{model, {{{"elbow_flexion"}, {}}, {}, {}}};
  bio::Trial trial = bio::readTrial(root + "/emg_data/curl_slow.sto", model);
  bio::ExcitationSignal excitation = bio::excitationOf(trial, system);
  bio::SystemState start =
      bio::initialState(system, bio::startCoordinates(trial, system, {}), excitation, 0);
};

void replay(benchmark::State& state, bio::Integrator integrator, double step,
            const std::string& file = "elbow8.osim") {
  const Job job(file);
  bio::SimulationOptions options;
  options.integrator = integrator;
  options.step = step;
  options.duration = 4.5;
  for (auto _ : state) {
    const bio::Trajectory motion = bio::simulate(job.system, job.excitation, job.start, options);
    benchmark::DoNotOptimize(motion.q.data());
    state.counters["newton_per_step"] =
        static_cast<double>(motion.newtonIterations) / static_cast<double>(motion.steps);
  }
}
BENCHMARK_CAPTURE(replay, variational_10ms, bio::Integrator::variational, 0.01)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(replay, variational_20ms, bio::Integrator::variational, 0.02)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(replay, variational_left_10ms, bio::Integrator::variationalLeft, 0.01)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(replay, runge_kutta_4e4, bio::Integrator::rungeKutta4, 4e-4)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(replay, cvode, bio::Integrator::cvode, 0.01)->Unit(benchmark::kMillisecond);

/// The same by muscles of other classes.
void ofClass(benchmark::State& state, const std::string& file) {
  replay(state, bio::Integrator::variational, 0.01, file);
}
BENCHMARK_CAPTURE(ofClass, Thelen, "elbow8_Thelen2003.osim")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ofClass, Millard, "elbow8_Millard2012.osim")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ofClass, DeGroote, "elbow8_DeGrooteFregly2016.osim")
    ->Unit(benchmark::kMillisecond);

/// All that a configuration needs: placements, inertia, eight path lengths with Hessians.
void configuration(benchmark::State& state) {
  const Job job;
  bio::SystemConfiguration<1> configuration(job.system);
  Eigen::Matrix<double, 1, 1> q(0.9);
  for (auto _ : state) {
    configuration.moveTo(q);
    benchmark::DoNotOptimize(configuration.length(0).length);
    q[0] = 1.9 - q[0];
  }
}
BENCHMARK(configuration);

/// Half a second of an arm with 1 … 7 coordinates; one by code of fixed size, too.
void coordinates(benchmark::State& state) {
  const std::vector<std::string> all = bio::fixtures::ArmOfSeven::coordinates();
  const bool asTree = state.range(1) != 0;
  const bio::fixtures::ArmOfSeven c(1, {all.begin(), all.begin() + state.range(0)}, asTree);
  bio::SimulationOptions options;
  options.step = 0.01;
  options.duration = 0.5;
  for (auto _ : state) {
    const bio::Trajectory motion = bio::simulate(c.system, c.excitation, c.start, options);
    benchmark::DoNotOptimize(motion.q.data());
  }
}
BENCHMARK(coordinates)
    ->ArgNames({"n", "tree"})
    ->Args({1, 0})
    ->ArgsProduct({{1, 2, 3, 4, 7}, {1}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
