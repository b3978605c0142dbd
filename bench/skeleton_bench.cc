// Time for placements, screws and all kinetic and potential derivatives of whole skeletons:
//     skeleton_bench [model.osim…] [options of Google Benchmark]
// Models named on the command line are measured with every coordinate free.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "bio/opensim/osim_file.h"
#include "bio/skeleton/skeleton_motion.h"
#include "bio/skeleton/tree_energy.h"
#include "second_ways/simbody_tree.h"
#include "support/tree_models.h"

namespace {

using Kind = bio::fixtures::TreeModelMaker::Kind;

bio::Model chainOfFour() {
  bio::fixtures::TreeModelMaker made(4);
  std::string at = "ground";
  for (int i = 0; i < 4; ++i) at = made.add(at, Kind::pin);
  return made.model();
}

/// A small shift of the posture from call to call, so that nothing is computed once for all.
void step(Eigen::VectorXd& q, int& i) {
  q[i] += 1e-7;
  if (++i == q.size()) i = 0;
}

template <int N>
void allDerivatives(benchmark::State& state, const bio::Model& model,
                    const std::vector<std::string>& free) {
  const bio::ArticulatedTree tree(model, {free, {}});
  auto motion = tree.newMotion<double>();
  bio::TreeEnergy<N> energy(tree);
  Eigen::VectorXd q = tree.defaultValues();
  const Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(tree.numCoordinates(), -1, 2);
  int i = 0;
  for (auto _ : state) {
    step(q, i);
    tree.place(q.data(), motion);
    benchmark::DoNotOptimize(&energy.evaluate(motion, v.data()));
    benchmark::ClobberMemory();
  }
  state.counters["coordinates"] = tree.numCoordinates();
  state.counters["mobilities"] = static_cast<double>(tree.mobilities().size());
}

void placements(benchmark::State& state, const bio::Model& model) {
  const bio::ArticulatedTree tree(model, {bio::independentCoordinates(model), {}});
  auto motion = tree.newMotion<double>();
  Eigen::VectorXd q = tree.defaultValues();
  int i = 0;
  for (auto _ : state) {
    step(q, i);
    tree.place(q.data(), motion);
    benchmark::ClobberMemory();
  }
}

/// The way of skeleton.h: ∂M and ∂²M in full.
template <int N>
void fullDerivatives(benchmark::State& state, const bio::Model& model,
                     const std::vector<std::string>& free) {
  const bio::Skeleton skeleton(model, {free, {}});
  std::vector<bio::RigidMotion<double, N>> moved(skeleton.numSegments());
  Eigen::VectorXd q = skeleton.defaultValues();
  int i = 0;
  for (auto _ : state) {
    step(q, i);
    const Eigen::Matrix<double, N, 1> q_N = q;
    skeleton.motions<double, N>(q_N, moved.data());
    benchmark::DoNotOptimize(skeleton.inertia<N>(q_N, moved.data()));
  }
}

/// Simbody's mass matrix and gravity, no derivatives.
void simbody(benchmark::State& state, const bio::Model& model) {
  const bio::SimbodyTree tree(model);
  for (auto _ : state) benchmark::DoNotOptimize(tree.dynamicsAt({}));
}

void registerModel(const std::string& name, const bio::Model& model) {
  benchmark::RegisterBenchmark(("allDerivatives/" + name).c_str(), [model](auto& state) {
    allDerivatives<Eigen::Dynamic>(state, model, bio::independentCoordinates(model));
  });
  benchmark::RegisterBenchmark(("placements/" + name).c_str(),
                               [model](auto& state) { placements(state, model); });
  benchmark::RegisterBenchmark(("simbodyMassAndGravity/" + name).c_str(),
                               [model](auto& state) { simbody(state, model); });
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const bio::Model arm = bio::fixtures::threeLinkArm();
  benchmark::RegisterBenchmark("allDerivatives/hinge",
                               [arm](auto& state) { allDerivatives<1>(state, arm, {"lift"}); });
  benchmark::RegisterBenchmark("fullDerivatives/hinge",
                               [arm](auto& state) { fullDerivatives<1>(state, arm, {"lift"}); });
  const bio::Model four = chainOfFour();
  registerModel("chain_of_four", four);
  benchmark::RegisterBenchmark("fullDerivatives/chain_of_four", [four](auto& state) {
    fullDerivatives<4>(state, four, bio::independentCoordinates(four));
  });
  registerModel("chain_of_seven", bio::fixtures::chainOfSeven());
  registerModel("body_of_37", bio::fixtures::bodyOfThirtySeven());
  for (int i = 1; i < argc; ++i) {
    const std::string file = argv[i];
    registerModel(file.substr(file.find_last_of('/') + 1), bio::readOsim(file));
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
