// Cost of a taut string over surfaces, one posture after the other: the ends go round a closed
// curve in 128 steps of about 1 mm, as in a simulation at 10 ms.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "bio/path/surface/chain_change.h"

namespace {

using bio::ChainMemory;
using bio::ChainObject;
using bio::ChainPath;
using Eigen::Vector3d;

struct Course {
  std::vector<ChainObject> objects;
  Vector3d P, Q;
  double swing;  // [m]
  Vector3d endP(std::size_t i) const { return P + swing * offset(i, 0.0); }
  Vector3d endQ(std::size_t i) const { return Q + swing * offset(i, 1.3); }

 private:
  static Vector3d offset(std::size_t i, double phase) {
    const double t = 2 * M_PI * static_cast<double>(i & 127) / 128 + phase;
    return {std::cos(t), std::sin(t), std::sin(2 * t)};
  }
};

Course ellipsoids(int count, const Vector3d& semiAxes) {
  Course course;
  for (int j = 0; j < count; ++j) {
    ChainObject object{bio::Surface(bio::EllipsoidSurface(semiAxes))};
    const double up = j % 2 == 0 ? 1 : -1;  // over one, under the next
    object.p_GS = {0.15 * j, -0.6 * up * semiAxes[1], 0.0};
    object.hint = {0, up * semiAxes[1], 0};
    course.objects.push_back(object);
  }
  course.P = {-0.08, -0.015, 0.01};
  course.Q = {0.15 * (count - 1) + 0.09, count % 2 == 0 ? 0.015 : -0.015, -0.008};
  course.swing = 0.008;
  return course;
}

Course torus() {
  Course course;
  ChainObject object{bio::Surface(bio::TorusSurface(0.04, 0.012))};
  object.hint = {0.028, 0, 0};
  course.objects = {object};
  course.P = {0.05, 0.01, 0.07};
  course.Q = {0.06, -0.01, -0.06};
  course.swing = 0.008;
  return course;
}

void overCourse(benchmark::State& state, const Course& course, const auto& finish) {
  ChainMemory memory;
  std::size_t i = 0;
  long touched = 0, iterations = 0, jumps = 0;
  for (auto _ : state) {
    const ChainPath path = bio::solveChain(course.endP(i), course.endQ(i), course.objects, memory);
    ++i;
    touched += path.numContacts;
    iterations += path.iterations;
    jumps += path.event != bio::ChainEvent::none ? 1 : 0;
    finish(path);
  }
  const auto calls = static_cast<double>(state.iterations());
  if (jumps > 0) state.SkipWithError("the path jumped");
  state.counters["touched"] = static_cast<double>(touched) / calls;
  state.counters["Newton"] = static_cast<double>(iterations) / calls;
}

const auto length = [](const ChainPath& path) { benchmark::DoNotOptimize(path.length); };
const auto secondDerivatives = [](const ChainPath& path) {
  benchmark::DoNotOptimize(bio::ChainChanges(path).ends());
};

void mildEllipsoid(benchmark::State& state) {
  overCourse(state, ellipsoids(static_cast<int>(state.range(0)), {0.03, 0.04, 0.05}), length);
}
BENCHMARK(mildEllipsoid)->Arg(1)->Arg(2)->Arg(4);

void longEllipsoid(benchmark::State& state) {
  overCourse(state, ellipsoids(static_cast<int>(state.range(0)), {0.015, 0.02, 0.09}), length);
}
BENCHMARK(longEllipsoid)->DenseRange(1, 2);

void ellipsoidToSecondOrder(benchmark::State& state) {
  overCourse(state, ellipsoids(static_cast<int>(state.range(0)), {0.03, 0.04, 0.05}),
             secondDerivatives);
}
BENCHMARK(ellipsoidToSecondOrder)->Arg(1)->Arg(2)->Arg(4);

void torusTube(benchmark::State& state) {
  overCourse(state, torus(), length);
}
BENCHMARK(torusTube);

// The semi-axes' gradient and what its change is made of, beside the path.
void ellipsoidWithNumbers(benchmark::State& state) {
  const Course course = ellipsoids(1, {0.03, 0.04, 0.05});
  overCourse(state, course, [&](const ChainPath& path) {
    if (path.numContacts == 0) return;
    benchmark::DoNotOptimize(bio::contactNumbers(course.objects[0], path.contacts[0]));
  });
}
BENCHMARK(ellipsoidWithNumbers);

}  // namespace

BENCHMARK_MAIN();
