// A path that gains or loses conditional points changes its length at once. Every integrator ends a
// step there, so that they come to one motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bio/analysis/replay.h"
#include "bio/simulation/simulate.h"
#include "bio/simulation/simulate_batch.h"
#include "simulation/switch_crossing.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;
constexpr double degree = std::numbers::pi / 180;

Trajectory fall(const MusculoskeletalSystem& system, double from_deg, double excitation,
                Integrator integrator, double step, double duration = 3) {
  const auto muscles = static_cast<Eigen::Index>(system.numMuscles());
  const ExcitationSignal signal({0, duration}, Eigen::MatrixXd::Constant(2, muscles, excitation));
  const SystemState start =
      initialState(system, Eigen::VectorXd::Constant(1, from_deg * degree), signal, 0);
  SimulationOptions options;
  options.integrator = integrator;
  options.step = step;
  options.duration = duration;
  return simulate(system, signal, start, options);
}

/// At the rows that are 10 ms apart [deg].
std::vector<double> every10ms(const Trajectory& motion, double step) {
  std::vector<double> q;
  const auto stride = static_cast<Eigen::Index>(std::lround(0.01 / step));
  for (Eigen::Index k = 0; k < motion.q.cols(); k += stride) q.push_back(motion.q(0, k) / degree);
  return q;
}

double farthest(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double most = 0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    most = std::max(most, std::abs(a[k] - b[k]));
  }
  return most;
}

TEST(SwitchEvents, IntegratorsAgreeOnAFallThroughThem) {
  const ShippedElbow elbow;
  const auto cvode = every10ms(fall(elbow.system, 60, 0, Integrator::cvode, 0.01), 0.01);
  const auto vi = every10ms(fall(elbow.system, 60, 0, Integrator::variational, 1e-4), 1e-4);
  const auto rk4 = every10ms(fall(elbow.system, 60, 0, Integrator::rungeKutta4, 1e-4), 1e-4);
  ASSERT_EQ(cvode.size(), 301u);
  EXPECT_LT(*std::min_element(cvode.begin(), cvode.end()), -20);
  EXPECT_LT(farthest(vi, cvode), 0.05);
  EXPECT_LT(farthest(rk4, cvode), 0.05);
}

// The coarse steps of everyday use are near that motion, too: they resolve what the jump does to
// the tendon.
TEST(SwitchEvents, LongStepsEndOnThemAsWell) {
  const ShippedElbow elbow;
  const auto cvode = every10ms(fall(elbow.system, 60, 0, Integrator::cvode, 0.01), 0.01);
  const auto vi = every10ms(fall(elbow.system, 60, 0, Integrator::variational, 0.01), 0.01);
  EXPECT_LT(farthest(vi, cvode),
            0.25);  // measured 0.115 deg
}

/// Flexors pull, extensors hardly.
ExcitationSignal flexing(const MusculoskeletalSystem& system, double duration) {
  Eigen::MatrixXd excitations(2, static_cast<Eigen::Index>(system.numMuscles()));
  const std::vector<std::string> names = muscleNames(system);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& name = names[i];
    excitations.col(static_cast<Eigen::Index>(i))
        .setConstant(name.starts_with("TRI") || name == "ANC" ? 0.01 : 0.2);
  }
  return {{0, duration}, excitations};
}

/// The arm starts beyond full extension, where BRA lacks a point, and is flexed through the jump.
Trajectory rise(const MusculoskeletalSystem& system, Integrator integrator, double step,
                double duration = 0.6) {
  const ExcitationSignal signal = flexing(system, 0.6);
  SimulationOptions options;
  options.integrator = integrator;
  options.step = step;
  options.duration = duration;
  return simulate(system, signal,
                  initialState(system, Eigen::VectorXd::Constant(1, -5 * degree), signal, 0),
                  options);
}

// At the jump BRA's tendon is 5 mm longer from one moment to the next.
TEST(SwitchEvents, TheVariationalIntegratorResolvesWhatAJumpDoes) {
  const ShippedElbow elbow;
  const auto cvode = every10ms(rise(elbow.system, Integrator::cvode, 0.01), 0.01);
  EXPECT_LT(cvode.front(), 0);
  EXPECT_GT(cvode.back(), 20);
  const auto error = [&](double step) {
    return farthest(every10ms(rise(elbow.system, Integrator::variational, step), step), cvode);
  };
  const double coarse = error(0.01), fine = error(0.0025);
  EXPECT_LT(coarse, 0.03);  // measured 0.0151 and 0.0014 deg
  EXPECT_LT(fine, 0.004);
}

// Four at once, in lanes, each with a jump at its own time.
TEST(SwitchEvents, LanesShortenStepsAfterAJumpAsSingleSimulationsDo) {
  const ShippedElbow elbow;
  const ExcitationSignal signal = flexing(elbow.system, 0.6);
  SimulationOptions options;
  options.duration = 0.6;
  std::vector<SystemState> starts;
  for (const double from : {-5.0, -4.0, -3.0, -1.5}) {
    starts.push_back(
        initialState(elbow.system, Eigen::VectorXd::Constant(1, from * degree), signal, 0));
  }
  std::vector<LaneJob> jobs;
  for (const SystemState& start : starts) jobs.push_back({&elbow.system, &signal, &start});
  const auto together = simulateTogether(jobs, options);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const Trajectory alone = simulate(elbow.system, signal, starts[i], options);
    EXPECT_EQ(together[i].wallSeconds, 0) << "went by itself";
    ASSERT_EQ(together[i].q.cols(), alone.q.cols());
    EXPECT_LT((together[i].q - alone.q).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_NEAR(static_cast<double>(together[i].newtonIterations),
                static_cast<double>(alone.newtonIterations), 10);
  }
}

/// When the arm rises through full extension [s].
double timeOfJump(const MusculoskeletalSystem& system) {
  const Trajectory motion = rise(system, Integrator::variational, 1e-4);
  Eigen::Index k = 0;
  while (k + 2 < motion.q.cols() && motion.q(0, k + 1) < 0) ++k;
  EXPECT_GE(motion.q(0, k + 1), 0) << "does not reach it";
  return 1e-4 * (static_cast<double>(k) - motion.q(0, k) / (motion.q(0, k + 1) - motion.q(0, k)));
}

// A step cannot end on a jump that is within a thousandth of it from its own ends: the steps after
// it are short all the same.
TEST(SwitchEvents, AJumpJustBeforeOrAfterTheEndOfAStepIsResolvedAsWell) {
  const ShippedElbow elbow;
  const double jump = timeOfJump(elbow.system);
  const auto steps = std::round(jump / 0.01);
  for (const double beyond : {-8e-4, -2e-4, 2e-4, 8e-4}) {  // of a step
    const double step = jump / (steps + beyond);
    const double duration = 60 * step;
    const Trajectory cvode = rise(elbow.system, Integrator::cvode, step, duration);
    const Trajectory motion = rise(elbow.system, Integrator::variational, step, duration);
    ASSERT_EQ(motion.q.cols(), cvode.q.cols());
    // measured 0.064 and 0.017 deg; 1.8 deg if the steps after it are long
    EXPECT_LT((motion.q - cvode.q).cwiseAbs().maxCoeff() / degree, 0.1) << beyond;

    const ExcitationSignal signal = flexing(elbow.system, 0.6);
    const SystemState start =
        initialState(elbow.system, Eigen::VectorXd::Constant(1, -5 * degree), signal, 0);
    SimulationOptions options;
    options.step = step;
    options.duration = duration;
    const std::vector<LaneJob> jobs(2, {&elbow.system, &signal, &start});
    const auto together = simulateTogether(jobs, options);
    EXPECT_EQ(together[0].wallSeconds, 0) << "went by itself";
    EXPECT_LT((together[0].q - motion.q).cwiseAbs().maxCoeff(), 1e-9) << beyond;
  }
}

// A step that reaches over the jump is of first order, wherever in the step the jump falls.
TEST(SwitchEvents, RungeKuttaConvergesAcrossThem) {
  const ShippedElbow elbow;
  const auto cvode = every10ms(fall(elbow.system, 20, 0.02, Integrator::cvode, 0.01, 0.6), 0.01);
  EXPECT_LT(*std::min_element(cvode.begin(), cvode.end()), -2);
  const auto error = [&](double step) {
    const Trajectory motion = fall(elbow.system, 20, 0.02, Integrator::rungeKutta4, step, 0.6);
    EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
    return farthest(every10ms(motion, step), cvode);
  };
  EXPECT_LT(error(2e-4), 1e-5);  // measured 2.2e-6 deg
  EXPECT_LT(error(1e-4), 2e-6);  // 4.9e-7 deg
}

TEST(SwitchCrossing, FindsTheChangeOfSign) {
  int calls = 0;
  const auto value = [&](double x) {
    ++calls;
    return std::cos(x) - 0.3;
  };
  const double x = stepping::crossingOf(2, 1, value(0), value(2), value);
  EXPECT_NEAR(x, std::acos(0.3), 1e-12);
  EXPECT_LT(calls, 25);
  // a start that has no sign yet: it is there already
  EXPECT_NEAR(stepping::crossingOf(1, 1, -1e-16, -1, [](double t) { return -t - 1e-16; }), 0,
              1e-12);
}

TEST(SwitchCrossing, TheFirstOfSeveralCounts) {
  const std::vector<PathSwitch> switches = {{0, FunctionEvaluator(identityFunction()), 0.2},
                                            {0, FunctionEvaluator(identityFunction()), 0.1},
                                            {0, FunctionEvaluator(identityFunction()), -0.4}};
  using Angle = Eigen::Matrix<double, 1, 1>;
  const Angle from(0.0), to(0.5), back(-0.5), near(0.05);
  EXPECT_EQ(stepping::firstCrossed(switches, from, from, to), &switches[1]);
  EXPECT_EQ(stepping::firstCrossed(switches, from, from, back), &switches[2]);
  EXPECT_EQ(stepping::firstCrossed(switches, from, from, near), nullptr);
  const Angle at(0.1 - 1e-12);
  EXPECT_GT(stepping::beyondSwitch(switches[1], at, -1)[0], 0.1);
  EXPECT_LT(stepping::beyondSwitch(switches[1], at, 1)[0], 0.1 - 1e-8);
}

}  // namespace
}  // namespace bio
