#include "bio/simulation/simulate.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bio/simulation/simulate_batch.h"
#include "libbio/simulation/jacobian_check.h"
#include "support/allocations.h"
#include "support/elbow_model.h"
#include "support/numbers.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using support::degree;

/// Smooth excitations that lift and lower the forearm.
ExcitationSignal lifting(const MusculoskeletalSystem& system, double duration = 2.0) {
  std::vector<double> times;
  for (double t = 0; t < duration + 1e-9; t += 0.01) times.push_back(t);
  Eigen::MatrixXd u(static_cast<Eigen::Index>(times.size()),
                    static_cast<Eigen::Index>(system.numMuscles()));
  for (Eigen::Index k = 0; k < u.rows(); ++k) {
    for (Eigen::Index i = 0; i < u.cols(); ++i) {
      const double phase = 0.4 * static_cast<double>(i);
      const double wave = std::sin(std::numbers::pi * times[static_cast<std::size_t>(k)] - phase);
      u(k, i) =
          0.02 +
          (system.muscles()[static_cast<std::size_t>(i)].name.starts_with("B") ? 0.16 : 0.04) *
              wave * wave;
    }
  }
  return {times, u};
}

MusculoskeletalSystem elbowArm(std::vector<std::string> free = {"elbow_flexion"}) {
  return MusculoskeletalSystem(fixtures::elbowModel(), {{std::move(free), {}}, {}, {}});
}

SimulationOptions options(Integrator integrator, double step, double duration = 2.0) {
  SimulationOptions o;
  o.integrator = integrator;
  o.step = step;
  o.duration = duration;
  return o;
}

double rmsDegrees(const Trajectory& a, const Trajectory& b) {
  // b has a whole number of rows per row of a
  const auto ratio = (b.q.cols() - 1) / (a.q.cols() - 1);
  double sum = 0;
  for (Eigen::Index k = 0; k < a.q.cols(); ++k) {
    sum += (a.q.col(k) - b.q.col(k * ratio)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(a.q.size())) / degree;
}

struct Case {
  MusculoskeletalSystem system;
  ExcitationSignal excitation;
  SystemState start;
};

Case liftingCase(std::vector<std::string> free = {"elbow_flexion"}, double duration = 2.0) {
  MusculoskeletalSystem system = elbowArm(free);
  ExcitationSignal excitation = lifting(system, duration);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(free.size()));
  q[0] = 0.7;
  SystemState start = initialState(system, q, excitation, 0);
  return {std::move(system), std::move(excitation), std::move(start)};
}

TEST(Coupled, EveryFibreStartsInStaticEquilibrium) {
  const Case c = liftingCase();
  stepping::SystemDynamics<1> dynamics(c.system, c.excitation);
  Eigen::VectorXd yDot(dynamics.size());
  dynamics.derivative(0, dynamics.pack(c.start), yDot);
  EXPECT_LT(yDot.tail(static_cast<Eigen::Index>(c.system.numMuscles())).cwiseAbs().maxCoeff(),
            1e-9);
}

template <int N>
void jacobianMatchesDifferences(const Case& c, double speed) {
  stepping::SystemDynamics<N> dynamics(c.system, c.excitation);
  Eigen::VectorXd y = dynamics.pack(c.start);
  const auto n = static_cast<Eigen::Index>(c.system.numMuscles());
  y.segment(N, N).setConstant(speed);
  y.tail(n) *= 1.001;  // away from the kink at fibre speed 0
  fixtures::expectJacobianOfDifferences(dynamics, 0.533, y);
}

TEST(Coupled, AnalyticJacobianMatchesCentralDifferences) {
  jacobianMatchesDifferences<1>(liftingCase(), 1.3);
  jacobianMatchesDifferences<2>(liftingCase({"elbow_flexion", "shoulder_elv"}), 0.8);
}

TEST(Coupled, IntegratorsAgreeWithEachOther) {
  const Case c = liftingCase();
  const auto play = [&](Integrator integrator, double step) {
    return simulate(c.system, c.excitation, c.start, options(integrator, step));
  };
  const Trajectory reference = play(Integrator::cvode, 0.01);
  ASSERT_EQ(reference.outcome, Outcome::completed) << reference.why;
  EXPECT_GT(reference.q.maxCoeff() - reference.q.minCoeff(), 30 * degree);
  const Trajectory explicitly = play(Integrator::rungeKutta4, 1e-4);
  ASSERT_EQ(explicitly.outcome, Outcome::completed) << explicitly.why;
  EXPECT_LT(rmsDegrees(reference, explicitly), 2e-4);
  const Trajectory variational = play(Integrator::variational, 1e-3);
  ASSERT_EQ(variational.outcome, Outcome::completed) << variational.why;
  EXPECT_LT(rmsDegrees(reference, variational), 2e-3);
  EXPECT_EQ(variational.halvedSteps, 0);
}

double observedOrder(const Case& c, Integrator integrator, const Trajectory& reference,
                     const std::vector<double>& steps) {
  std::vector<double> errors;
  for (const double step : steps) {
    Trajectory t = simulate(c.system, c.excitation, c.start, options(integrator, step, 1.6));
    EXPECT_EQ(t.outcome, Outcome::completed) << t.why;
    double sum = 0;
    const auto every = static_cast<Eigen::Index>(std::lround(0.04 / step));
    Eigen::Index count = 0;
    for (Eigen::Index k = 0; k < t.q.cols(); k += every, ++count) {
      sum += (t.q.col(k) - reference.q.col(count)).squaredNorm();
    }
    errors.push_back(std::sqrt(sum / static_cast<double>(count)) / degree);
  }
  for (std::size_t i = 0; i < steps.size(); ++i)
    std::printf("  %g s: %.3g deg\n", steps[i], errors[i]);
  const double order =
      std::log(errors.front() / errors.back()) / std::log(steps.front() / steps.back());
  std::printf("  order %.3f from %.3g deg at %g s, %.3g deg at %g s\n", order, errors.front(),
              steps.front(), errors.back(), steps.back());
  return order;
}

TEST(Coupled, SymmetricForcingIsSecondOrderAndLeftForcingFirst) {
  for (const auto& free : {std::vector<std::string>{"elbow_flexion"},
                           std::vector<std::string>{"elbow_flexion", "shoulder_elv"}}) {
    const Case c = liftingCase(free, 1.6);
    SimulationOptions fine = options(Integrator::cvode, 0.04, 1.6);
    fine.relativeTolerance = 1e-11;
    fine.absoluteTolerance = 1e-13;
    const Trajectory reference = simulate(c.system, c.excitation, c.start, fine);
    ASSERT_EQ(reference.outcome, Outcome::completed) << reference.why;
    EXPECT_NEAR(
        observedOrder(c, Integrator::variational, reference, {0.02, 0.01, 0.005, 0.0025, 0.00125}),
        2.0, 0.15);
    EXPECT_NEAR(observedOrder(c, Integrator::variationalLeft, reference, {0.005, 0.0025, 0.00125}),
                1.0, 0.15);
  }
}

TEST(Coupled, EnergyBalanceClosesAsTheStepShrinks) {
  const Case c = liftingCase({"elbow_flexion", "shoulder_elv"});
  const auto error = [&](Integrator integrator, double step) {
    return energyError(c.system,
                       simulate(c.system, c.excitation, c.start, options(integrator, step)));
  };
  EXPECT_LT(error(Integrator::cvode, 0.01), 1e-7);
  EXPECT_LT(error(Integrator::rungeKutta4, 1e-4), 1e-6);
  const double coarse = error(Integrator::variational, 0.01);
  const double fine = error(Integrator::variational, 0.005);
  EXPECT_LT(coarse, 0.05);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.5);
}

TEST(Coupled, RungeKuttaBlowsUpWhereTheVariationalIntegratorHolds) {
  const Case c = liftingCase();
  const Trajectory explicitly =
      simulate(c.system, c.excitation, c.start, options(Integrator::rungeKutta4, 0.002));
  EXPECT_EQ(explicitly.outcome, Outcome::unstable);
  EXPECT_NE(explicitly.why.find("unstable at t ="), std::string::npos);
  EXPECT_EQ(explicitly.time.size(), static_cast<std::size_t>(explicitly.q.cols()));
  for (const double step : {0.01, 0.02, 0.05}) {
    const Trajectory variational =
        simulate(c.system, c.excitation, c.start, options(Integrator::variational, step));
    EXPECT_EQ(variational.outcome, Outcome::completed) << variational.why;
  }
}

TEST(Coupled, SuddenExcitationsAreSurvivedByHalvingSteps) {
  const MusculoskeletalSystem system = elbowArm();
  std::vector<double> times;
  Eigen::MatrixXd u(40, static_cast<Eigen::Index>(system.numMuscles()));
  for (int k = 0; k < 40; ++k) {
    times.push_back(0.05 * k);
    for (Eigen::Index i = 0; i < u.cols(); ++i) u(k, i) = (k / 3 + i) % 2 == 0 ? 0.0 : 1.0;
  }
  const ExcitationSignal excitation(times, u);
  const SystemState start = initialState(system, Eigen::VectorXd::Constant(1, 1.2), excitation, 0);
  const Trajectory motion =
      simulate(system, excitation, start, options(Integrator::variational, 0.02, 1.9));
  EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
  EXPECT_TRUE(motion.q.allFinite());
}

TEST(Coupled, AStepThatCannotBeSolvedIsAResultWithTimeAndReason) {
  const Case c = liftingCase();
  SimulationOptions o = options(Integrator::variational, 0.05);
  o.maxIterations = 1;
  o.maxHalvings = 2;
  const Trajectory motion = simulate(c.system, c.excitation, c.start, o);
  EXPECT_EQ(motion.outcome, Outcome::noSolution);
  EXPECT_NE(motion.why.find("no solution at t = 0 s"), std::string::npos) << motion.why;
  EXPECT_EQ(motion.time.size(), 1u);
}

// Half the shift, an eighth of the error in what has two derivatives, a quarter in what has one.
TEST(SystemConfiguration, ShiftedALittleItIsThatOfThePlaceToItsOrder) {
  const MusculoskeletalSystem system = elbowArm({"elbow_flexion", "shoulder_elv"});
  const Eigen::Vector2d q(1.1, 0.4), along(1, -0.7);
  const auto errors = [&](double size) {
    SystemConfiguration<2> shifted(system), there(system);
    shifted.moveTo(q);
    shifted.shift(size / 2 * along);
    shifted.shift(size / 2 * along);
    there.moveTo(q + size * along);
    const auto &a = shifted.inertia(), &b = there.inertia();
    double third = std::abs(a.potential - b.potential) + (a.massMatrix - b.massMatrix).norm();
    double second = (a.dV - b.dV).norm() + (a.dM[0] - b.dM[0]).norm() + (a.dM[1] - b.dM[1]).norm();
    for (std::size_t i = 0; i < system.numMuscles(); ++i) {
      third += std::abs(shifted.length(i).length - there.length(i).length);
      second += (shifted.length(i).dL_dq - there.length(i).dL_dq).norm();
    }
    return Eigen::Array2d(third, second);
  };
  const Eigen::Array2d ratio = errors(4e-3) / errors(2e-3);
  EXPECT_NEAR(ratio[0], 8, 0.2) << errors(2e-3);
  EXPECT_NEAR(ratio[1], 4, 0.2) << errors(2e-3);
  EXPECT_GT(errors(2e-3).minCoeff(), 1e-12);
}

TEST(Coupled, NothingIsAllocatedInAStep) {
  for (const Integrator integrator : {Integrator::variational, Integrator::variationalLeft,
                                      Integrator::variationalAdaptive, Integrator::rungeKutta4}) {
    const Case c = liftingCase();
    const double step = integrator == Integrator::rungeKutta4 ? 1e-4 : 0.01;
    const auto count = [&](double duration) {
      const long before = support::allocations();
      simulate(c.system, c.excitation, c.start, options(integrator, step, duration));
      return support::allocations() - before;
    };
    count(0.1);
    EXPECT_EQ(count(0.2), count(2.0));
  }
}

// Switches of paths are met, forces act on the coordinate and from outside, one lane is empty.
TEST(SimulateTogether, AllocatesNothingInAStep) {
  const fixtures::ShippedElbow elbow("elbow8_passive");
  const SystemState start =
      initialState(elbow.system, Eigen::VectorXd::Constant(1, 0.5), elbow.excitation, 0);
  const std::vector<LaneJob> jobs(3, {&elbow.system, &elbow.excitation, &start});
  SimulationOptions o;
  o.externalForce = ExternalForce({0.5, 1, 2}, Eigen::Vector3d(0, 0.8, -0.3));
  using enum LaneInstructions;
  for (const LaneInstructions instructions : {avx512, avx2, plain}) {
    long switchesMet = 0;
    const auto count = [&](double duration) {
      o.duration = duration;
      const long before = support::allocations();
      const auto motions = simulateTogether(jobs, o, instructions);
      const long taken = support::allocations() - before;
      EXPECT_EQ(motions.front().outcome, Outcome::completed);
      EXPECT_EQ(motions.front().wallSeconds, 0) << "went by itself";
      const Eigen::VectorXd angle = motions.front().q.row(0);
      switchesMet = std::count_if(
          elbow.system.switches().begin(), elbow.system.switches().end(), [&](const PathSwitch& s) {
            return s.distance(angle.minCoeff()) * s.distance(angle.maxCoeff()) < 0;
          });
      return taken;
    };
    count(0.1);
    const long few = count(0.2);
    EXPECT_EQ(switchesMet, 0);
    EXPECT_EQ(count(4.0), few);
    EXPECT_GT(switchesMet, 0);
  }
}

TEST(Coupled, TheProgressCallbackCanStopARun) {
  const Case c = liftingCase();
  for (const Integrator integrator :
       {Integrator::variational, Integrator::rungeKutta4, Integrator::cvode}) {
    const double step = integrator == Integrator::rungeKutta4 ? 1e-4 : 1e-3;
    SimulationOptions o = options(integrator, step);
    o.progress = [](double t) { return t < 0.04995; };
    const Trajectory motion = simulate(c.system, c.excitation, c.start, o);
    EXPECT_EQ(motion.outcome, Outcome::stopped);
    EXPECT_NEAR(motion.time.back(), 0.05, 1e-9);
    EXPECT_EQ(motion.q.cols(), std::lround(0.05 / step) + 1);
  }
}

// When a trial begins is of no account, before zero or long after.
TEST(Coupled, AMotionIsTheSameWheneverItBegins) {
  const Case c = liftingCase({"elbow_flexion"}, 1.0);
  for (const Integrator integrator : {Integrator::variational, Integrator::variationalLeft,
                                      Integrator::rungeKutta4, Integrator::cvode}) {
    SimulationOptions o =
        options(integrator, integrator == Integrator::rungeKutta4 ? 2.5e-4 : 0.01, 1.0);
    const Trajectory atZero = simulate(c.system, c.excitation, c.start, o);
    for (const double begin : {-7.0, -1.0, 1000.0}) {
      std::vector<double> times = c.excitation.times();
      Eigen::MatrixXd values(times.size(), c.excitation.numMuscles());
      for (std::size_t k = 0; k < times.size(); ++k) {
        std::size_t hint = 0;
        Eigen::VectorXd u(values.cols());
        c.excitation.at(times[k], hint, u);
        values.row(static_cast<Eigen::Index>(k)) = u;
      }
      for (double& t : times) t += begin;
      o.startTime = begin;
      const Trajectory moved = simulate(c.system, {times, values}, c.start, o);
      ASSERT_EQ(moved.q.cols(), atZero.q.cols());
      EXPECT_LT((moved.q - atZero.q).cwiseAbs().maxCoeff(), 1e-8) << begin;
    }
  }
}

TEST(Coupled, BrokenRulesAreNamed) {
  const Case c = liftingCase();
  const auto fails = [&](auto&& change) {
    SimulationOptions o = options(Integrator::variational, 0.01);
    SystemState start = c.start;
    change(o, start);
    EXPECT_THROW(simulate(c.system, c.excitation, start, o), std::invalid_argument);
  };
  fails([](auto& o, auto&) { o.step = 0; });
  fails([](auto& o, auto&) { o.step = std::nan(""); });
  fails([](auto& o, auto&) { o.duration = -1; });
  fails([](auto& o, auto&) { o.duration = 1e9; });
  fails([](auto& o, auto&) { o.startTime = -1e8; });  // numbers there are too far apart
  fails([](auto& o, auto&) { o.newtonTolerance = std::nan(""); });
  fails([](auto&, auto& s) { s.q[0] = std::nan(""); });
  fails([](auto&, auto& s) { s.fibreLength.resize(2); });
  EXPECT_THROW(ExcitationSignal({0, 1}, Eigen::MatrixXd::Constant(2, 8, 1.2)),
               std::invalid_argument);
  EXPECT_THROW(ExcitationSignal({1, 0}, Eigen::MatrixXd::Constant(2, 8, 0.2)),
               std::invalid_argument);
  EXPECT_THROW(ExcitationSignal({0, 1}, Eigen::MatrixXd::Constant(2, 8, std::nan(""))),
               std::invalid_argument);
  EXPECT_THROW(initialState(c.system, Eigen::VectorXd::Zero(2), c.excitation, 0),
               std::invalid_argument);
}

}  // namespace
}  // namespace bio
