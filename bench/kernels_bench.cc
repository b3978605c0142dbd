// Cost of the inner kernels: one muscle, one span, one activation step.
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "bio/muscle/activation/activation.h"
#include "bio/muscle/schutte_muscle.h"
#include "bio/path/path.h"
#include "bio/path/surface/wrap_cylinder.h"
#include "bio/path/surface/wrap_sphere.h"
#include "support/elbow_curves.h"

namespace {

using bio::Vec3;

struct MuscleState {
  double activation, fibreLength, muscleTendonLength;
};

// States as a simulation visits them: all regimes, spread over the curves, so that no branch is
// learnt by heart.
std::vector<MuscleState> muscleStates(const bio::SchutteParameters& p) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<MuscleState> states(1024);
  for (MuscleState& s : states) {
    s.activation = unit(random);
    s.fibreLength = p.optimalFibreLength * (0.6 + 0.8 * unit(random));
    s.muscleTendonLength = s.fibreLength * 0.98 + p.tendonSlackLength * (1 + 0.03 * unit(random));
  }
  return states;
}

template <class Evaluate>
void overMuscleStates(benchmark::State& state, const Evaluate& evaluate) {
  const bio::SchutteParameters p = support::tricepsLongHead();
  const bio::SchutteCurves curves(p);
  const bio::SchutteMuscle<double> muscle(bio::schutteQuantities(p), curves);
  const std::vector<MuscleState> states = muscleStates(p);
  std::size_t i = 0;
  for (auto _ : state) {
    const MuscleState& s = states[i++ & 1023];
    benchmark::DoNotOptimize(evaluate(muscle, s.activation, s.fibreLength, s.muscleTendonLength));
  }
}

void muscleVelocity(benchmark::State& state) {
  overMuscleStates(state, [](const auto& muscle, double a, double l, double m) {
    return muscle.fibreVelocity(a, l, m);
  });
}
BENCHMARK(muscleVelocity);

void muscleFirstDerivatives(benchmark::State& state) {
  overMuscleStates(state, [](const auto& muscle, double a, double l, double m) {
    return bio::fibreRateDerivatives(muscle, a, l, m);
  });
}
BENCHMARK(muscleFirstDerivatives);

void muscleStaticEquilibrium(benchmark::State& state) {
  overMuscleStates(state, [](const auto& muscle, double a, double, double m) {
    return bio::staticEquilibrium(muscle, a, m);
  });
}
BENCHMARK(muscleStaticEquilibrium);

struct Ends {
  Vec3<double> P, Q;
};

// The triceps span over a 16 mm cylinder; from 40° to 180° it touches.
std::vector<Ends> spanEnds(double fromAngle, double toAngle) {
  std::vector<Ends> ends(256);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const double angle = fromAngle + (toAngle - fromAngle) * static_cast<double>(i) / 255;
    ends[i].P = {0.03, 0, 0.005};
    ends[i].Q = {0.025 * std::cos(angle), 0.025 * std::sin(angle), 0};
  }
  return ends;
}

template <class Evaluate>
void overEnds(benchmark::State& state, const std::vector<Ends>& ends, const Evaluate& evaluate) {
  std::size_t i = 0;
  for (auto _ : state) {
    const Ends& e = ends[i++ & 255];
    benchmark::DoNotOptimize(evaluate(e.P, e.Q));
  }
}

void cylinderGradient(benchmark::State& state) {
  overEnds(state, spanEnds(2.5, 3.5), [](const auto& P, const auto& Q) {
    return bio::wrapCylinder(0.016, bio::Side::counterclockwise, P, Q);
  });
}
BENCHMARK(cylinderGradient);

void cylinderHessian(benchmark::State& state) {
  overEnds(state, spanEnds(2.5, 3.5), [](const auto& P, const auto& Q) {
    return bio::wrapCylinderToSecondOrder(0.016, bio::Side::counterclockwise, P, Q);
  });
}
BENCHMARK(cylinderHessian);

void cylinderHessianStraight(benchmark::State& state) {
  overEnds(state, spanEnds(0.2, 0.8), [](const auto& P, const auto& Q) {
    return bio::wrapCylinderToSecondOrder(0.016, bio::Side::counterclockwise, P, Q);
  });
}
BENCHMARK(cylinderHessianStraight);

void sphereHessian(benchmark::State& state) {
  overEnds(state, spanEnds(2.2, 3.0), [](const auto& P, const auto& Q) {
    return bio::wrapSphereToSecondOrder(0.016, bio::Way::shorter, P, Q);
  });
}
BENCHMARK(sphereHessian);

void activationStep(benchmark::State& state) {
  const bio::SchutteActivation<double> dynamics{0.1, 7.667, 1.459854};
  double a = 0.3, u = 0.1;
  for (auto _ : state) {
    const double next = u < 0.9 ? u + 0.01 : 0.1;
    a = bio::stepActivation(dynamics, u, next, a, 0.01);
    u = next;
    benchmark::DoNotOptimize(a);
  }
}
BENCHMARK(activationStep);

// One hinge, a triceps-like path: one fixed and one moving span with a cylinder.
void hingePath(benchmark::State& state) {
  bio::Model model;
  bio::Body forearm;
  forearm.name = "forearm";
  forearm.mass = 1.5;
  model.bodies = {forearm};
  bio::Joint elbow;
  elbow.kind = bio::JointKind::pin;
  elbow.parentBody = "ground";
  elbow.childBody = "forearm";
  elbow.coordinates.resize(1);
  elbow.coordinates[0].name = "flexion";
  elbow.coordinates[0].rangeMax = 2.2;
  model.joints = {elbow};
  bio::WrapObject cylinder;
  cylinder.name = "cylinder";
  cylinder.body = "ground";
  cylinder.radius = 0.016;
  cylinder.length = 0.1;
  model.wrapObjects = {cylinder};
  bio::Muscle muscle;
  muscle.name = "extensor";
  bio::PathPoint a, b, c;
  a.body = b.body = "ground";
  c.body = "forearm";
  a.location = {-0.01, 0.2, 0.01};
  b.location = {-0.024, 0.02, 0};
  c.location = {-0.022, 0.010, -0.001};
  muscle.path.points = {a, b, c};
  muscle.path.wraps = {{"cylinder", -1, -1}};
  const bio::Skeleton skeleton(model, {.freeCoordinates = {"flexion"}, .lockedValues = {}});
  const bio::MusclePath path(model, skeleton, muscle, {});
  using Q = Eigen::Matrix<double, 1, 1>;
  std::vector<bio::RigidMotion<double, 1>> moved(skeleton.numSegments());
  const Q q(static_cast<double>(state.range(0)) / 100);
  skeleton.motions<double, 1>(q, moved.data());
  for (auto _ : state) benchmark::DoNotOptimize(path.length<1>(q, moved.data()));
  state.SetLabel(path.length<1>(q, moved.data()).wrapped ? "touches" : "straight");
}
BENCHMARK(hingePath)->Arg(40)->Arg(180);

}  // namespace

BENCHMARK_MAIN();
