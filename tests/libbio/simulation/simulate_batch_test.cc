#include "bio/simulation/simulate_batch.h"

#include <gtest/gtest.h>

#include <numbers>

#include "info/probability/random_stream.h"
#include "simulation/simd/hinge_model.h"
#include "simulation/simd/lane_step.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::forSeconds;
using fixtures::ShippedElbow;

/// Simulations of one trial with parameters drawn, and what they point to.
struct Drawn {
  Drawn(const ShippedElbow& elbow, const std::vector<std::string>& names, double spread, int count,
        double seconds)
      : options(forSeconds(seconds)) {
    const auto selection = elbow.catalogue.select(names);
    const Eigen::VectorXd nominal = elbow.catalogue.values(selection);
    info::RandomStream random(7, 0);
    for (int i = 0; i < count; ++i) {
      Eigen::VectorXd theta = nominal;
      for (double& value : theta) value *= std::exp(spread * random.normal());
      const auto setting = elbow.catalogue.at(selection, theta);
      auto& system = arms.emplace_back(
          std::make_unique<MusculoskeletalSystem>(setting.model, ShippedElbow::options()));
      starts.push_back(std::make_unique<SystemState>(
          startOf(*system, setting, elbow.excitation, options.startTime)));
      jobs.push_back({system.get(), &elbow.excitation, starts.back().get()});
    }
  }

  Trajectory alone(std::size_t i) const {
    return simulate(*jobs[i].system, *jobs[i].excitation, *jobs[i].start, options);
  }

  SimulationOptions options;
  std::vector<std::unique_ptr<MusculoskeletalSystem>> arms;
  std::vector<std::unique_ptr<SystemState>> starts;
  std::vector<LaneJob> jobs;
};

const std::vector<std::string> muscleNumbers = {"*.max_isometric_force", "*.optimal_fiber_length",
                                                "*.tendon_slack_length", "BRA.time_scale"};

void expectSame(const Trajectory& a, const Trajectory& b) {
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.qDot, b.qDot);
  EXPECT_EQ(a.fibreLength, b.fibreLength);
  EXPECT_EQ(a.activation, b.activation);
  EXPECT_EQ(a.muscleWork, b.muscleWork);
  EXPECT_EQ(a.newtonIterations, b.newtonIterations);
}

// simulate() is the second way: it knows nothing of lanes, and takes paths point by point.
TEST(SimulateTogether, MovesAsEachAloneWould) {
  for (const char* model : {"elbow8", "elbow8_passive"}) {
    const ShippedElbow elbow(model);
    const Drawn drawn(elbow, muscleNumbers, 0.02, 6, 4.5);
    const auto together = simulateTogether(drawn.jobs, drawn.options);
    ASSERT_EQ(together.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
      const Trajectory alone = drawn.alone(i);
      const Trajectory& lane = together[i];
      EXPECT_EQ(lane.wallSeconds, 0) << "went by itself";
      ASSERT_EQ(lane.time, alone.time);
      EXPECT_EQ(lane.outcome, Outcome::completed);
      // measured: 2e-11 here, 1.2e-10 at most over 64 draws
      EXPECT_LT((lane.q - alone.q).cwiseAbs().maxCoeff(), 1e-9) << model << i;
      EXPECT_LT((lane.qDot - alone.qDot).cwiseAbs().maxCoeff(), 1e-8);
      EXPECT_LT((lane.fibreLength - alone.fibreLength).cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_LT((lane.activation - alone.activation).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_LT((lane.muscleWork - alone.muscleWork).cwiseAbs().maxCoeff(), 1e-8);
      EXPECT_LT((lane.passiveWork - alone.passiveWork).cwiseAbs().maxCoeff(), 1e-8);
      EXPECT_LT(std::abs(static_cast<double>(lane.newtonIterations - alone.newtonIterations)), 20);
    }
  }
}

// Beyond full extension, where the triceps slips off its cylinder and the brachialis loses a point.
TEST(SimulateTogether, FollowsAFallBeyondFullExtension) {
  const ShippedElbow elbow;
  const ExcitationSignal none({0, 2}, Eigen::MatrixXd::Zero(2, elbow.excitation.numMuscles()));
  std::vector<SystemState> starts;
  for (const double angle : {1.05, 1.0, 0.95, 0.9}) {
    starts.push_back(initialState(elbow.system, Eigen::VectorXd::Constant(1, angle), none, 0));
  }
  std::vector<LaneJob> jobs;
  for (const SystemState& start : starts) jobs.push_back({&elbow.system, &none, &start});
  SimulationOptions options = forSeconds(2);
  options.step = 0.001;  // no step needs to be halved, which a lane leaves to others
  const auto together = simulateTogether(jobs, options);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const Trajectory alone = simulate(elbow.system, none, starts[i], options);
    EXPECT_EQ(together[i].wallSeconds, 0);
    EXPECT_LT(alone.q.minCoeff(), -20 * std::numbers::pi / 180);
    EXPECT_LT((together[i].q - alone.q).cwiseAbs().maxCoeff(), 1e-8);
  }
}

// Pennate muscles, an exponential passive force, forces on one end of a step, a push from outside.
TEST(SimulateTogether, KnowsWhatTheShippedArmsLack) {
  ShippedElbow elbow;
  for (Muscle& muscle : elbow.model.muscles) {
    muscle.schutte->pennation = 0.3;
    if (muscle.name == "BRA") muscle.schutte->passiveForceLength.reset();
  }
  const MusculoskeletalSystem pennate(elbow.model, ShippedElbow::options());
  SystemOptions unclampedOptions = ShippedElbow::options();
  unclampedOptions.muscle.clampForce = false;
  const MusculoskeletalSystem unclamped(elbow.model, unclampedOptions);
  SimulationOptions options = forSeconds(2.5);
  options.externalForce = ExternalForce({0.5, 1, 2}, Eigen::Vector3d(0, 0.8, -0.3));
  for (const Integrator integrator : {Integrator::variational, Integrator::variationalLeft}) {
    options.integrator = integrator;
    const SystemState start =
        initialState(pennate, Eigen::VectorXd::Constant(1, 0.5), elbow.excitation, 0);
    const std::vector<LaneJob> jobs = {{&pennate, &elbow.excitation, &start},
                                       {&unclamped, &elbow.excitation, &start}};
    const auto together = simulateTogether(jobs, options);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      const Trajectory alone = simulate(*jobs[i].system, elbow.excitation, start, options);
      ASSERT_EQ(together[i].time.size(), alone.time.size());
      EXPECT_EQ(together[i].wallSeconds, 0);
      EXPECT_LT((together[i].q - alone.q).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_LT((together[i].externalWork - alone.externalWork).cwiseAbs().maxCoeff(), 1e-9);
    }
  }
}

TEST(SimulateTogether, DoesNotDependOnTheGroupToTheLastBit) {
  const ShippedElbow elbow;
  const Drawn drawn(elbow, muscleNumbers, 0.05, 7, 1.2);
  const auto all = simulateTogether(drawn.jobs, drawn.options);
  std::vector<LaneJob> shuffled;
  const std::vector<std::size_t> order = {4, 2, 6, 0, 5, 1, 3};
  for (const std::size_t i : order) shuffled.push_back(drawn.jobs[i]);
  const auto other = simulateTogether(shuffled, drawn.options);
  for (std::size_t i = 0; i < order.size(); ++i) expectSame(other[i], all[order[i]]);
  for (std::size_t i = 0; i < 7; ++i) {
    expectSame(simulateTogether({&drawn.jobs[i], 1}, drawn.options).front(), all[i]);
  }
}

TEST(SimulateTogether, DoesNotDependOnTheProcessorToTheLastBit) {
  const ShippedElbow elbow;
  const Drawn drawn(elbow, muscleNumbers, 0.05, 11, 1.2);
  const auto plain = simulateTogether(drawn.jobs, drawn.options, LaneInstructions::plain);
  for (const LaneInstructions instructions :
       {LaneInstructions::avx2, LaneInstructions::avx512, LaneInstructions::best}) {
    const auto other = simulateTogether(drawn.jobs, drawn.options, instructions);
    for (std::size_t i = 0; i < plain.size(); ++i) expectSame(other[i], plain[i]);
  }
}

// One whose steps are halved in the midst of others, and one that fails even so: the former moves
// as it would alone, the latter is what simulate() makes of it, the others unchanged.
TEST(SimulateTogether, HalvesStepsAndLeavesFailuresToSimulate) {
  const ShippedElbow elbow;
  Drawn drawn(elbow, muscleNumbers, 0.02, 3, 0.12);  // of four steps, fewer than it may halve
  drawn.options.maxIterations = 4;
  drawn.options.step = 0.03;
  const auto expected = simulateTogether(drawn.jobs, drawn.options);
  SystemState flung = *drawn.jobs[1].start;
  flung.qDot[0] = 300;
  std::vector<LaneJob> jobs = drawn.jobs;
  jobs[1].start = &flung;
  for (const int halvings : {8, 0}) {
    drawn.options.maxHalvings = halvings;
    const auto together = simulateTogether(jobs, drawn.options);
    const Trajectory alone = simulate(*jobs[1].system, *jobs[1].excitation, flung, drawn.options);
    EXPECT_EQ(together[1].outcome, alone.outcome);
    EXPECT_EQ(together[1].halvedSteps, alone.halvedSteps);
    EXPECT_EQ(together[1].newtonIterations, alone.newtonIterations);
    ASSERT_EQ(together[1].time, alone.time);
    if (halvings > 0) {
      ASSERT_GT(alone.halvedSteps, 0);
      EXPECT_EQ(together[1].wallSeconds, 0);
      EXPECT_LT((together[1].q - alone.q).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_LT((together[1].activation - alone.activation).cwiseAbs().maxCoeff(), 1e-12);
    } else {
      EXPECT_EQ(alone.outcome, Outcome::noSolution);
      EXPECT_GT(together[1].wallSeconds, 0);
      EXPECT_EQ(together[1].why, alone.why);
      expectSame(together[1], alone);
    }
    EXPECT_EQ(together[0].wallSeconds, 0);
    expectSame(together[0], expected[0]);
    expectSame(together[2], expected[2]);
  }
}

TEST(SimulateTogether, LeavesOtherIntegratorsAndArmsToSimulate) {
  const ShippedElbow elbow;
  const Drawn drawn(elbow, {"BRA.time_scale"}, 0, 1, 0.05);
  SimulationOptions options = drawn.options;
  options.integrator = Integrator::rungeKutta4;
  options.step = 4e-4;
  expectSame(simulateTogether(drawn.jobs, options).front(),
             simulate(*drawn.jobs[0].system, elbow.excitation, *drawn.jobs[0].start, options));
  const MusculoskeletalSystem both(elbow.model, {{{"elbow_flexion", "pro_sup"}, {}}, {}, {}});
  const SystemState start = initialState(both, Eigen::Vector2d(0.5, 0), elbow.excitation, 0);
  const LaneJob job{&both, &elbow.excitation, &start};
  expectSame(simulateTogether({&job, 1}, drawn.options).front(),
             simulate(both, elbow.excitation, start, drawn.options));
}

/// Lengths, slopes and curvatures of all paths over the range of the elbow, by the lanes and by
/// SystemConfiguration, which goes from point to point.
void expectSamePaths(const MusculoskeletalSystem& system) {
  const auto single = lanes::hingeModel(system);
  ASSERT_TRUE(single);
  lanes::HingeModel<lanes::Here> all = lanes::lanesFor<lanes::Here>(*single);
  for (int l = 0; l < lanes::width; ++l) lanes::setLane(all, l, *single);
  const auto view = all.view();
  SystemConfiguration<1> configuration(system);
  for (int k = 0; k < 120; k += lanes::width) {
    lanes::Real q;
    for (int l = 0; l < lanes::width; ++l) q[l] = 0.02 * (k + l) + 0.003;
    for (int i = 0; i < view.numMuscles; ++i) {
      const lanes::PathJet jet =
          lanes::muscleTendonLength(view, view.muscles[i], q, lanes::sineCosine(q));
      for (int l = 0; l < lanes::width; ++l) {
        configuration.moveTo(Eigen::Matrix<double, 1, 1>(q[l]));
        const LengthJet<1>& expected = configuration.length(static_cast<std::size_t>(i));
        EXPECT_NEAR(jet.length[l], expected.length, 1e-14) << i << " at " << q[l];
        EXPECT_NEAR(jet.slope[l], expected.dL_dq[0], 1e-14) << i << " at " << q[l];
        EXPECT_NEAR(jet.curvature[l], expected.d2L_dq2(0, 0), 1e-12) << i << " at " << q[l];
      }
    }
  }
}

TEST(LanePaths, AreThoseOfTheConfiguration) {
  const ShippedElbow elbow;
  expectSamePaths(elbow.system);
  // a further point at several places round the triceps' cylinder: in the ulna, so that two spans
  // may touch it; in the humerus, beside its end
  for (int angle = 0; angle < 8; ++angle) {
    const double turn = angle * std::numbers::pi / 4;
    const Eigen::Vector3d out(std::cos(turn), std::sin(turn), 0);
    for (const bool turns : {false, true}) {
      Model model = elbow.model;
      for (Muscle& muscle : model.muscles) {
        if (muscle.name != "TRIlat") continue;
        PathPoint point = turns ? muscle.path.points.back() : muscle.path.points.front();
        ASSERT_EQ(point.body, turns ? "ulna" : "humerus");
        point.location = turns ? Eigen::Vector3d(0.03 * out)
                               : Eigen::Vector3d(0.0028, -0.2919, 0.0481) + 0.0176 * out;
        auto& points = muscle.path.points;
        points.insert(points.end() - 1, point);
        for (PathWrap& wrap : muscle.path.wraps) wrap.firstPoint = wrap.lastPoint = -1;
      }
      expectSamePaths(MusculoskeletalSystem(model, ShippedElbow::options()));
    }
  }
}

// Over the whole range against the standard library.
TEST(LaneNumbers, SinesAndAnglesAreThoseOfTheStandardLibrary) {
  double sines = 0, angles = 0;
  for (int i = -200000; i <= 200000; i += 4) {
    lanes::Real x;
    for (int l = 0; l < lanes::width; ++l) {
      x[l] = i % 3 == 0 ? 0.5 * (i + l) : 5e-5 * (i + l) * std::numbers::pi / 2;
    }
    const lanes::SineCosine turn = lanes::sineCosine(x);
    const lanes::Real angle = lanes::angleOf(3 * turn.sine, 3 * turn.cosine);
    for (int l = 0; l < lanes::width; ++l) {
      sines = std::max({sines, std::abs(turn.sine[l] - std::sin(x[l])),
                        std::abs(turn.cosine[l] - std::cos(x[l]))});
      const double principal = std::atan2(turn.sine[l], turn.cosine[l]);
      const double expected = principal < 0 ? principal + 2 * std::numbers::pi : principal;
      angles = std::max(angles, std::abs(angle[l] - expected));
    }
  }
  EXPECT_LT(sines, 2.3e-16);  // 1.2e-16 is half a digit of numbers just below 1
  EXPECT_LT(angles, 2e-15);   // 8.9e-16 is one of numbers above 4
}

}  // namespace
}  // namespace bio
