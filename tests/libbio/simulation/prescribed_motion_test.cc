#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bio/simulation/simulate.h"
#include "libbio/simulation/arm_of_seven.h"
#include "libbio/simulation/jacobian_check.h"
#include "support/sensitivity_differences.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using fixtures::ArmOfSeven;

/// A sine about 0.8 rad, which begins with a speed.
double swing(double t) {
  return 0.8 + 0.3 * std::sin(2 * std::numbers::pi * t);
}

void addSwing(PrescribedMotion& motion, int coordinate, double duration, double every = 0.01) {
  std::vector<double> times, values;
  for (int k = 0; k * every <= duration + every / 2; ++k) {
    times.push_back(k * every);
    values.push_back(swing(times.back()));
  }
  motion.add(coordinate, times, values);
}

/// The elbow that is simulated while the shoulder swings.
struct SwungShoulder {
  explicit SwungShoulder(double duration, bool isPrescribed = true)
      : c(duration, {"elbow_flexion", "shoulder_elv"}), systemOptions(c.options) {
    if (isPrescribed) systemOptions.prescribed = {"shoulder_elv"};
    options.duration = duration;
    if (isPrescribed) addSwing(options.prescribed, 1, duration);
  }
  MusculoskeletalSystem system() const { return {c.model, systemOptions}; }
  Trajectory played(Integrator integrator, double step) const {
    SimulationOptions o = options;
    o.integrator = integrator;
    o.step = step;
    o.relativeTolerance = 1e-11;
    o.absoluteTolerance = 1e-13;
    const Trajectory motion = simulate(system(), c.excitation, c.start, o);
    EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
    return motion;
  }

  ArmOfSeven c;
  SystemOptions systemOptions;
  SimulationOptions options;
};

TEST(PrescribedMotion, GoesThroughItsSamplesWithSpeedAndAcceleration) {
  PrescribedMotion motion;
  addSwing(motion, 1, 1);
  motion.add(0, {0}, {0.4});
  Eigen::Vector2d q, v, a;
  const double w = 2 * std::numbers::pi;
  for (const double t : {0.0, 0.333, 0.5, 1.0}) {
    motion.place(t, q, v, a);
    EXPECT_NEAR(q[1], swing(t), 1e-7);
    EXPECT_NEAR(v[1], 0.3 * w * std::cos(w * t), 2e-5);
    EXPECT_NEAR(a[1], -0.3 * w * w * std::sin(w * t), 0.02);
    EXPECT_EQ(q[0], 0.4);
    EXPECT_EQ(v[0], 0);
    EXPECT_EQ(a[0], 0);
  }
}

TEST(PrescribedMotion, RefusesWhatIsNoCourse) {
  PrescribedMotion motion;
  const auto refused = [&](const std::vector<double>& times, const std::vector<double>& values,
                           const char* words) {
    support::throwsSaying([&] { motion.add(0, times, values); }, words);
  };
  refused({}, {}, "must have at least one time, and a value for each");
  refused({0, 0}, {1, 2}, "times must rise");
  refused({0, 1}, {1, NAN}, "times and values must be finite");
  motion.add(0, {0}, {1});
  refused({0}, {1}, "a coordinate must be prescribed once");
}

TEST(PrescribedMotion, IsRefusedWhereItDoesNotFitTheSystem) {
  SwungShoulder s(0.1);
  const MusculoskeletalSystem system = s.system();
  SimulationOptions o = s.options;
  o.duration = 0.2;
  support::throwsSaying([&] { simulate(system, s.c.excitation, s.c.start, o); },
                        "must cover the simulation");
  o.prescribed = {};
  support::throwsSaying([&] { simulate(system, s.c.excitation, s.c.start, o); },
                        "prescribed coordinates");
  s.systemOptions.prescribed = {"pro_sup"};
  support::throwsSaying([&] { s.system(); }, "prescribed coordinate 'pro_sup'");
  s.systemOptions.prescribed = {"shoulder_elv", "shoulder_elv"};
  support::throwsSaying([&] { s.system(); }, "coordinate 'shoulder_elv' is prescribed twice");
}

/// Largest distance at the rows of b, which has fewer.
double apart(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const auto every = (a.cols() - 1) / (b.cols() - 1);
  double largest = 0;
  for (Eigen::Index k = 0; k < b.cols(); ++k) {
    largest = std::max(largest, (a.col(k * every) - b.col(k)).cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(PrescribedMotion, AllIntegratorsAgreeOnMotionAndReaction) {
  const SwungShoulder s(0.5);
  const Trajectory reference = s.played(Integrator::cvode, 0.05);
  EXPECT_GT(reference.reaction.row(1).cwiseAbs().maxCoeff(), 5);
  EXPECT_EQ(reference.reaction.row(0).cwiseAbs().maxCoeff(), 0);
  EXPECT_NEAR(reference.q(1, 3), swing(0.15), 1e-7);
  const Trajectory explicitly = s.played(Integrator::rungeKutta4, 1e-4);
  EXPECT_LT(apart(explicitly.q, reference.q), 1e-6);
  EXPECT_LT(apart(explicitly.reaction, reference.reaction), 1e-5);
  std::vector<double> ofMotion, ofReaction;
  for (const double step : {0.0025, 0.00125, 0.000625}) {
    const Trajectory motion = s.played(Integrator::variational, step);
    ofMotion.push_back(apart(motion.q, reference.q));
    ofReaction.push_back(apart(motion.reaction, reference.reaction));
  }
  std::printf("  motion %.3g %.3g %.3g, reaction %.3g %.3g %.3g\n", ofMotion[0], ofMotion[1],
              ofMotion[2], ofReaction[0], ofReaction[1], ofReaction[2]);
  EXPECT_NEAR(std::log2(ofMotion[0] / ofMotion[2]) / 2, 2.0, 0.2);
  EXPECT_NEAR(std::log2(ofReaction[0] / ofReaction[2]) / 2, 2.0, 0.3);
}

/// The swing as a function of time.
Function swingFunction() {
  return {1, SineFunction{0.3, 2 * std::numbers::pi, 0, 0.8}};
}

TEST(PrescribedMotion, AFunctionMovesAsItsSamplesDo) {
  SwungShoulder s(0.5);
  s.options.prescribed = {};
  addSwing(s.options.prescribed, 1, 0.5, 1e-3);
  const Trajectory sampled = s.played(Integrator::variational, 0.0025);
  s.options.prescribed = {};
  s.options.prescribed.add(1, swingFunction());
  const Trajectory exact = s.played(Integrator::variational, 0.0025);
  std::printf("  apart by %.3g rad, reactions by %.3g N m\n", apart(sampled.q, exact.q),
              apart(sampled.reaction, exact.reaction));
  EXPECT_LT(apart(sampled.q, exact.q), 1e-8);
  EXPECT_LT(apart(sampled.reaction, exact.reaction), 1e-4);
  const Trajectory reference = s.played(Integrator::cvode, 0.05);
  const auto error = [&](double step) {
    return apart(s.played(Integrator::variational, step).q, reference.q);
  };
  EXPECT_NEAR(std::log2(error(0.0025) / error(0.000625)) / 2, 2.0, 0.2);
}

TEST(PrescribedMotion, AFunctionsLastKnotBelongsToItsCurve) {
  const std::vector<double> times = {0, 0.1, 0.2, 0.3, 0.5};
  const std::vector<double> values = {0, 0.3, 0.5, 0.4, -0.2};
  PrescribedMotion samples, function;
  samples.add(0, times, values);
  function.add(0, Function{1, SplineFunction{times, values}});
  Eigen::Matrix<double, 1, 1> q, v, a, q2, v2, a2;
  for (const double t : {0.0, 0.15, 0.3, 0.5}) {
    samples.place(t, q, v, a);
    function.place(t, q2, v2, a2);
    EXPECT_EQ(q, q2);
    EXPECT_EQ(v, v2);
    EXPECT_EQ(a, a2);
    EXPECT_GT(std::abs(a2[0]), 1);
  }
  function.place(0.6, q2, v2, a2);  // straight on
  EXPECT_EQ(a2[0], 0);
  EXPECT_NEAR(q2[0], -0.2 + 0.1 * v[0], 1e-12);
  support::throwsSaying([&] { function.add(0, Function{}); },
                        "a coordinate must be prescribed once");
}

/// The second way: the reaction as a force from outside on a shoulder that is free makes it swing,
/// and the elbow move, in the same way.
TEST(PrescribedMotion, TheReactionAsAForceMakesTheSameMotion) {
  const double duration = 0.2;
  const SwungShoulder s(duration), free(duration, false);
  const Trajectory prescribed = s.played(Integrator::cvode, 2e-4);
  SimulationOptions o;
  o.integrator = Integrator::cvode;
  o.duration = duration;
  o.step = 0.02;
  o.relativeTolerance = 1e-10;
  o.externalForce = {prescribed.time, prescribed.reaction.transpose()};
  SystemState start = s.c.start;
  start.q = prescribed.q.col(0);
  start.qDot = prescribed.qDot.col(0);
  const Trajectory driven = simulate(free.system(), s.c.excitation, start, o);
  ASSERT_EQ(driven.outcome, Outcome::completed) << driven.why;
  std::printf("  apart by %.3g rad\n", apart(prescribed.q, driven.q));
  EXPECT_LT(apart(prescribed.q, driven.q), 1e-6);
}

TEST(PrescribedMotion, EnergyBalanceHoldsWithTheWorkOfTheReaction) {
  const SwungShoulder s(0.5);
  const MusculoskeletalSystem system = s.system();
  const Trajectory explicitly = s.played(Integrator::rungeKutta4, 1e-4);
  EXPECT_GT(explicitly.externalWork.cwiseAbs().maxCoeff(), 1);
  EXPECT_LT(energyError(system, explicitly), 1e-6);
  const double coarse = energyError(system, s.played(Integrator::variational, 0.005));
  const double fine = energyError(system, s.played(Integrator::variational, 0.00125));
  std::printf("  energy error %.3g, %.3g J\n", coarse, fine);
  EXPECT_NEAR(std::log2(coarse / fine) / 2, 2.0, 0.3);
}

/// Held still, the elbow's reaction is what muscles, gravity and passive forces leave over.
TEST(PrescribedMotion, AHeldElbowIsHeldAgainstMusclesAndGravity) {
  const ArmOfSeven c(0.3, {"elbow_flexion"});
  SystemOptions options = c.options;
  options.prescribed = {"elbow_flexion"};
  const MusculoskeletalSystem system(c.model, options);
  for (const Integrator integrator : {Integrator::variational, Integrator::cvode}) {
    SimulationOptions o;
    o.integrator = integrator;
    o.duration = 0.3;
    o.prescribed.add(0, {0}, {0.7});
    const Trajectory motion = simulate(system, c.excitation, c.start, o);
    ASSERT_EQ(motion.outcome, Outcome::completed) << motion.why;
    const MuscleReport report = reportMuscles(system, motion);
    const auto potential = [&](double q) {
      return energyOf(system, Eigen::VectorXd::Constant(1, q), Eigen::VectorXd::Zero(1)).potential;
    };
    const double gravity = -(potential(0.7 + 1e-5) - potential(0.7 - 1e-5)) / 2e-5;
    double passive = 0, passive_q = 0, passive_v = 0;
    {
      Eigen::Matrix<double, 1, 1> q(0.7), v(0.0), f(0.0), f_q(0.0), f_v(0.0);
      system.coordinateForces().add<1>(q, v, f, f_q, f_v);
      passive = f[0], passive_q = f_q(0, 0), passive_v = f_v(0, 0);
    }
    EXPECT_TRUE(std::isfinite(passive_q + passive_v));
    const Eigen::VectorXd moments =
        report.tendonForce.cwiseProduct(report.momentArm).colwise().sum().transpose();
    const Eigen::VectorXd expected = -(moments.array() + gravity + passive);
    EXPECT_GT((expected.maxCoeff() - expected.minCoeff()), 1);  // the muscles pull
    EXPECT_LT((motion.reaction.row(0).transpose() - expected).cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_EQ(motion.q.maxCoeff(), 0.7);
    EXPECT_EQ(motion.qDot.cwiseAbs().maxCoeff(), 0);
  }
}

TEST(PrescribedMotion, JacobianMatchesCentralDifferences) {
  const SwungShoulder s(0.5);
  const MusculoskeletalSystem system = s.system();
  stepping::SystemDynamics<Eigen::Dynamic> dynamics(
      system, s.c.excitation, stepping::noExternalForce, s.options.prescribed);
  Eigen::VectorXd y = dynamics.pack(s.c.start);
  y[2] = 1.1;
  y.tail(static_cast<Eigen::Index>(system.numMuscles())) *= 1.001;
  fixtures::expectJacobianOfDifferences(dynamics, 0.233, y);
}

/// Sensitivities of motion, muscles and reactions against differences of whole simulations.
fixtures::DiscoveryProblem compared(const ArmOfSeven& c, const SystemOptions& systemOptions,
                                    const SimulationOptions& options,
                                    const std::vector<std::string>& names) {
  const MusculoskeletalSystem system(c.model, systemOptions);
  StartPoint start{c.start.q, Eigen::VectorXd::Zero(c.start.q.size())};
  options.prescribed.place(0, start.q, start.qDot);
  const ParameterCatalogue catalogue(c.model, system, start);
  const auto d = fixtures::compareWithDifferences(system, systemOptions, c.excitation, catalogue,
                                                  catalogue.select(names), options);
  fixtures::tell(d);
  return d;
}

TEST(PrescribedMotion, SensitivitiesOfAMovedElbowMatchDifferences) {
  const ArmOfSeven c(0.2, {"elbow_flexion"});
  SystemOptions systemOptions = c.options;
  systemOptions.prescribed = {"elbow_flexion"};
  SimulationOptions options;
  options.duration = 0.12;
  addSwing(options.prescribed, 0, 0.12);
  const auto d = compared(
      c, systemOptions, options,
      {"BIClong.max_isometric_force", "BRA.tendon_slack_length", "TRI.radius", "TRI.translation.x",
       "BRD.point3.z", "hand.mass", "hand.mass_center.x", "emg.BRA.gain", "emg.delay"});
  EXPECT_GT(d.compared, 35);
  EXPECT_LT(d.worst, 1e-5) << d.of;
}

TEST(PrescribedMotion, SensitivitiesBesideASwungShoulderMatchDifferences) {
  const ArmOfSeven c(0.2, {"elbow_flexion", "shoulder_elv", "pro_sup"});
  SystemOptions systemOptions = c.options;
  systemOptions.prescribed = {"shoulder_elv"};
  SimulationOptions options;
  options.duration = 0.12;
  addSwing(options.prescribed, 1, 0.12);
  const auto d = compared(c, systemOptions, options,
                          {"BIClong.max_isometric_force", "TRI.radius", "BIClong.point9.x",
                           "hand.mass", "radius.mass_center.x", "humerus.mass_center.y",
                           "hand.inertia.yy", "initial.*", "hold_shoulder_elv.*"});
  EXPECT_GT(d.compared, 100);
  EXPECT_LT(d.worst, 1e-5) << d.of;
}

}  // namespace
}  // namespace bio
