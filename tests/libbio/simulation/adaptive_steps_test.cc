// The variational integrator in parts of a step that are as short as their errors ask for.
#include <gtest/gtest.h>

#include <cmath>

#include "bio/analysis/compare.h"
#include "bio/simulation/simulate_batch.h"
#include "simulation/step_control.h"
#include "support/numbers.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;
using support::degree;

struct AdaptiveCase {
  explicit AdaptiveCase(const std::string& model = "elbow8", const std::string& trial = "curl_slow",
                        double seconds = 4.5)
      : elbow(model, trial),
        duration(seconds),
        start(initialState(elbow.system, Eigen::VectorXd::Constant(1, 0.5291838292),
                           elbow.excitation, 0)),
        reference(play(Integrator::cvode, 5e-4)) {}

  Trajectory play(Integrator integrator, double step) const {
    SimulationOptions options;
    options.integrator = integrator;
    options.step = step;
    options.duration = duration;
    return simulate(elbow.system, elbow.excitation, start, options);
  }
  double error_deg(const Trajectory& motion) const {
    EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
    return sd(elbow.system, motion, reference).rms / degree;
  }

  ShippedElbow elbow;
  double duration;
  SystemState start;
  Trajectory reference;
};

/// Parts of one length under a motion q(t) of the elbow, fibres at rest; which of them is refused
/// first.
template <class Motion>
int firstRefused(double step, double h, const Motion& q) {
  const ShippedElbow elbow;
  SimulationOptions options;
  options.integrator = Integrator::variationalAdaptive;
  options.step = step;
  struct {
    Eigen::Matrix<double, 1, 1> q;
    Eigen::VectorXd fibreLength;
  } begin, end;
  begin.fibreLength = end.fibreLength =
      Eigen::VectorXd::Constant(static_cast<Eigen::Index>(elbow.system.numMuscles()), 0.1);
  stepping::StepControl<1> control(elbow.system, options);
  const auto meanSpeed = [&](int k) {
    return Eigen::Matrix<double, 1, 1>((q(k * h) - q((k - 1) * h)) / h);
  };
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(begin.fibreLength.size());
  for (int k = 1; k <= 12; ++k) {
    stepping::LastParts<1> last{
        stepping::LastEnds(meanSpeed(k - 1)), stepping::LastEnds<Eigen::VectorXd>(still), {h, h}};
    last.q.velocityBefore = meanSpeed(k - 2);
    begin.q[0] = q((k - 1) * h);
    end.q[0] = q(k * h);
    if (!control.accepts(h, begin, end, last)) return k;
    control.take(last);
  }
  return 0;
}

// δq = h³ q‴/12 may be 1.5 times what is allowed, H³·1.25 rad/s³: q‴ = 22.5 rad/s³ in whole steps.
TEST(StepControl, RefusesAThirdDerivativeThatIsTooLarge) {
  const auto cubic = [](double third) {
    return [third](double t) { return third * std::pow(t + 1, 3) / 6; };
  };
  // the first part has no q‴ before it, so that all of it counts as new
  EXPECT_EQ(firstRefused(0.02, 0.02, cubic(11)), 0);
  EXPECT_EQ(firstRefused(0.02, 0.02, cubic(24)), 1);
  EXPECT_EQ(firstRefused(0.02, 0.02, [](double t) { return 20 * t * t; }), 0);
}

// A jump Δa of the acceleration has q‴ = Δa/2h; of a short part the speed decides: its share of the
// error is H·Δa·h/24, that of the position h²·Δa/24.
TEST(StepControl, RefusesAJumpOfTheAccelerationByWhatItDoesToTheSpeed) {
  const double H = 0.02, h = H / 8;
  const auto jump = [&](double size) {
    return [size, h](double t) { return t < 5 * h ? 0 : size * std::pow(t - 5 * h, 2) / 2; };
  };
  const double least = 1.5 * 1.25 * H * H * 24 / h;
  EXPECT_EQ(firstRefused(H, h, jump(0.95 * least)), 0);
  EXPECT_EQ(firstRefused(H, h, jump(1.05 * least)), 6);
}

// Half the step is an eighth of the error of a part, so that of the motion falls with about the
// square; parts are halves and no smooth function of the step, hence the wide bounds.
TEST(AdaptiveSteps, ErrorsFallWithTheSquareOfTheStep) {
  const AdaptiveCase c;
  const double coarse = c.error_deg(c.play(Integrator::variationalAdaptive, 0.02));
  const double fine = c.error_deg(c.play(Integrator::variationalAdaptive, 0.0025));
  std::printf("0.02 s: %.3g deg, 0.0025 s: %.3g deg\n", coarse, fine);
  const double order = std::log(coarse / fine) / std::log(8);
  EXPECT_GT(order, 1.6);
  EXPECT_LT(order, 3.0);
}

// Fewer iterations than in equal steps, at no larger error.
TEST(AdaptiveSteps, NeedFewerIterationsForTheSameError) {
  for (const char* model : {"elbow8", "elbow8_Thelen2003", "elbow8_Millard2012"}) {
    const AdaptiveCase c(model);
    const Trajectory equal = c.play(Integrator::variational, 0.01);
    const Trajectory adaptive = c.play(Integrator::variationalAdaptive, 0.01);
    const double errorOfEqual = c.error_deg(equal), errorOfAdaptive = c.error_deg(adaptive);
    std::printf("%s: vi %ld iterations, %.3g deg; vi-adaptive %ld, %.3g deg\n", model,
                equal.newtonIterations, errorOfEqual, adaptive.newtonIterations, errorOfAdaptive);
    EXPECT_LT(errorOfAdaptive, errorOfEqual);
    EXPECT_LT(static_cast<double>(adaptive.newtonIterations),
              0.9 * static_cast<double>(equal.newtonIterations));
  }
}

// Set free from 60° the arm swings; later it hangs still, and takes whole steps.
TEST(AdaptiveSteps, AreShortOnlyWhereTheMotionAsksForIt) {
  const ShippedElbow elbow;
  const ExcitationSignal still(
      {0, 8},
      Eigen::MatrixXd::Constant(2, static_cast<Eigen::Index>(elbow.system.numMuscles()), 0.02));
  const SystemState start =
      initialState(elbow.system, Eigen::VectorXd::Constant(1, 60 * degree), still, 0);
  const auto partsUntil = [&](double end) {
    SimulationOptions options;
    options.integrator = Integrator::variationalAdaptive;
    options.step = 0.02;
    options.duration = end;
    const Trajectory motion = simulate(elbow.system, still, start, options);
    EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
    EXPECT_EQ(motion.q.cols(), std::lround(end / 0.02) + 1);
    return motion.steps;
  };
  const long first = partsUntil(1), last = partsUntil(8) - partsUntil(7);
  std::printf("%ld parts in the first second, %ld in the last\n", first, last);
  EXPECT_GT(first, 100);
  EXPECT_EQ(last, 50);
}

// A fall through the jumps of two lengths, and what they do to the tendons.
TEST(AdaptiveSteps, ResolveWhatAJumpDoes) {
  const AdaptiveCase c("elbow8_Millard2012", "curl_fast", 3);
  const Trajectory motion = c.play(Integrator::variationalAdaptive, 0.01);
  const double error = c.error_deg(motion);
  const double ofEqual = c.error_deg(c.play(Integrator::variational, 0.01));
  std::printf("vi-adaptive %.3g deg, vi %.3g deg\n", error, ofEqual);
  EXPECT_LT(error, ofEqual);
}

// By a second way: the derivatives of a motion in short equal steps.
TEST(AdaptiveSteps, HaveTheSensitivitiesOfTheMotion) {
  const ShippedElbow elbow("elbow8_passive", "curl_fast");
  const auto wanted = elbow.catalogue.select(
      {"TRI.radius", "BRA.max_isometric_force", "BIClong.tendon_slack_length", "hand.mass"});
  const auto run = [&](Integrator integrator, double step) {
    SimulationOptions options;
    options.integrator = integrator;
    options.step = step;
    options.duration = 1;
    return simulateWithSensitivities(elbow.system, elbow.catalogue, elbow.catalogue.nominal(),
                                     wanted, elbow.excitation, {options});
  };
  const SensitivityTrajectory fine = run(Integrator::variational, 2.5e-4);
  const auto largestError = [&](Integrator integrator, double step) {
    const SensitivityTrajectory s = run(integrator, step);
    const auto stride = static_cast<Eigen::Index>(std::lround(step / 2.5e-4));
    double worst = 0;
    for (Eigen::Index j = 0; j < s.q[0].cols(); ++j) {
      double largest = 0, off = 0;
      for (Eigen::Index k = 0; k < s.q[0].rows(); ++k) {
        const double exact = fine.q[0](stride * k, j);
        largest = std::max(largest, std::abs(exact));
        off = std::max(off, std::abs(s.q[0](k, j) - exact));
      }
      EXPECT_GT(largest, 0);
      worst = std::max(worst, off / largest);
    }
    return worst;
  };
  const double equal = largestError(Integrator::variational, 0.01);
  const double adaptive = largestError(Integrator::variationalAdaptive, 0.01);
  const double finer = largestError(Integrator::variationalAdaptive, 0.0025);
  std::printf("of the largest: vi %.3g, vi-adaptive %.3g, at 2.5 ms %.3g\n", equal, adaptive,
              finer);
  EXPECT_LT(adaptive, equal / 2);  // measured 0.028, 0.0072 and 0.0018
  EXPECT_LT(finer, adaptive / 2);
}

TEST(AdaptiveSteps, GoOneByOneInABatch) {
  const AdaptiveCase c("elbow8", "curl_slow", 0.5);
  SimulationOptions options;
  options.integrator = Integrator::variationalAdaptive;
  options.duration = 0.5;
  const std::vector<LaneJob> jobs(3, {&c.elbow.system, &c.elbow.excitation, &c.start});
  const Trajectory alone = simulate(c.elbow.system, c.elbow.excitation, c.start, options);
  for (const Trajectory& motion : simulateTogether(jobs, options)) EXPECT_EQ(motion.q, alone.q);
}

TEST(AdaptiveSteps, KeepTheEnergyBalance) {
  const AdaptiveCase c;
  EXPECT_LT(energyError(c.elbow.system, c.play(Integrator::variationalAdaptive, 0.01)),
            energyError(c.elbow.system, c.play(Integrator::variational, 0.02)));
}

}  // namespace
}  // namespace bio
