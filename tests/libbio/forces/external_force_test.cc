#include "bio/forces/external_force.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/numbers.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;

using support::degree;

ExternalForce ramp() {
  return {{0, 0.5, 1}, (Eigen::MatrixXd(3, 1) << 0, 2, -4).finished()};
}

/// A torque that swings, with a corner off every step's end.
ExternalForce swing() {
  std::vector<double> times;
  for (int k = 0; k <= 27; ++k) times.push_back(0.037 * k);
  Eigen::MatrixXd values(28, 1);
  for (int k = 0; k <= 27; ++k) values(k, 0) = 3 * std::sin(9 * 0.037 * k);
  return {times, values};
}

struct Played {
  ShippedElbow elbow{"elbow8_passive"};
  SimulationOptions options;

  Played() {
    options.duration = 0.9;
    options.externalForce = swing();
  }
  Trajectory play(Integrator integrator, double step) {
    options.integrator = integrator;
    options.step = step;
    return simulateSetting(elbow.system, elbow.catalogue.nominal(), elbow.excitation, options);
  }
};

double rmsAngle(const Trajectory& a, const Trajectory& b) {
  const auto ratio = (b.q.cols() - 1) / (a.q.cols() - 1);
  double sum = 0;
  for (Eigen::Index k = 0; k < a.q.cols(); ++k) {
    sum += (a.q.col(k) - b.q.col(k * ratio)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(a.q.cols())) / degree;
}

TEST(ExternalForce, IsLinearBetweenRowsAndNothingOutside) {
  const ExternalForce force = ramp();
  EXPECT_DOUBLE_EQ(force.at(0.25).value[0], 1);
  EXPECT_DOUBLE_EQ(force.at(0.25).slope[0], 4);
  EXPECT_DOUBLE_EQ(force.at(0.5).value[0], 2);
  EXPECT_DOUBLE_EQ(force.at(0.75).value[0], -1);
  EXPECT_DOUBLE_EQ(force.at(0.75).slope[0], -12);
  EXPECT_DOUBLE_EQ(force.at(1).value[0], -4);
  for (const double outside : {-0.01, 1.01}) {
    EXPECT_EQ(force.at(outside).value[0], 0);
    EXPECT_EQ(force.at(outside).slope[0], 0);
  }
}

TEST(ExternalForce, RefusesWhatIsNoForce) {
  EXPECT_THROW(ExternalForce({}, Eigen::MatrixXd(0, 1)), std::invalid_argument);
  EXPECT_THROW(ExternalForce({0, 1}, Eigen::MatrixXd::Zero(3, 1)), std::invalid_argument);
  EXPECT_THROW(ExternalForce({0, 0}, Eigen::MatrixXd::Zero(2, 1)), std::invalid_argument);
  EXPECT_THROW(ExternalForce({0, 1}, Eigen::MatrixXd::Constant(2, 1, std::nan(""))),
               std::invalid_argument);
  Played p;
  p.options.externalForce = ExternalForce({0, 1}, Eigen::MatrixXd::Zero(2, 2));
  EXPECT_THROW(p.play(Integrator::variational, 0.01), std::invalid_argument);
}

// An angle a torque holds against gravity is where it equals what gravity asks for.
TEST(ExternalForce, PushesTheCoordinateUpWhenPositive) {
  Played p;
  const auto angleAt = [&](double torque) {
    p.options.externalForce = {{0, 1}, Eigen::MatrixXd::Constant(2, 1, torque)};
    const Trajectory motion = p.play(Integrator::variational, 0.01);
    return motion.q(0, 10);
  };
  EXPECT_GT(angleAt(1) - angleAt(0), 2 * degree);
  EXPECT_LT(angleAt(-1) - angleAt(0), -2 * degree);
}

TEST(ExternalForce, IntegratorsAgreeUnderIt) {
  Played p;
  const Trajectory reference = p.play(Integrator::cvode, 0.01);
  ASSERT_EQ(reference.outcome, Outcome::completed) << reference.why;
  p.options.externalForce = {};
  EXPECT_GT(rmsAngle(reference, p.play(Integrator::cvode, 0.01)), 5);
  p.options.externalForce = swing();
  const Trajectory fine = p.play(Integrator::variational, 5e-4);
  EXPECT_LT(rmsAngle(reference, fine), 2e-3);
  const Trajectory runge = p.play(Integrator::rungeKutta4, 1e-4);
  ASSERT_EQ(runge.outcome, Outcome::completed) << runge.why;
  EXPECT_LT(rmsAngle(reference, runge), 2e-2);
  const Trajectory left = p.play(Integrator::variationalLeft, 5e-4);
  EXPECT_LT(rmsAngle(reference, left), 0.5);
  // the work done from outside, by each
  EXPECT_GT(reference.externalWork.cwiseAbs().maxCoeff(), 0.5);
  for (const Trajectory* motion : {&fine, &runge, &left}) {
    EXPECT_NEAR(motion->externalWork.tail(1)[0], reference.externalWork.tail(1)[0],
                motion == &left ? 2e-2 : 1e-3);
  }
}

TEST(ExternalForce, ItsWorkClosesTheEnergyBalance) {
  Played p;
  EXPECT_LT(energyError(p.elbow.system, p.play(Integrator::cvode, 0.01)), 1e-6);
  const double coarse = energyError(p.elbow.system, p.play(Integrator::variational, 0.002));
  const double fine = energyError(p.elbow.system, p.play(Integrator::variational, 0.001));
  EXPECT_LT(coarse, 0.02);
  EXPECT_GT(coarse / fine, 2.5);
  EXPECT_LT(coarse / fine, 6.5);
}

TEST(ExternalForce, ConvergesWithSecondOrder) {
  Played p;
  const Trajectory reference = p.play(Integrator::cvode, 0.01);
  const double coarse = rmsAngle(reference, p.play(Integrator::variational, 0.002));
  const double fine = rmsAngle(reference, p.play(Integrator::variational, 0.001));
  EXPECT_GT(coarse / fine, 3);
  EXPECT_LT(coarse / fine, 5.5);
}

// Both schemes, with steps cut at a switch of BRA: the force moves with the time of the cut.
TEST(ExternalForce, SensitivitiesMatchDifferencesUnderIt) {
  for (const Integrator integrator : {Integrator::variational, Integrator::variationalLeft}) {
    Played p;
    SensitivityOptions options{p.options, false};
    options.simulation.integrator = integrator;
    options.simulation.step = 0.01;
    options.simulation.newtonTolerance = 1e-12;
    const auto wanted =
        p.elbow.catalogue.select({"TRI.radius", "hand.mass", "initial.elbow_flexion"});
    const SensitivityTrajectory s =
        simulateWithSensitivities(p.elbow.system, p.elbow.catalogue, p.elbow.catalogue.nominal(),
                                  wanted, p.elbow.excitation, options);
    const Eigen::VectorXd theta = p.elbow.catalogue.values(wanted);
    for (Eigen::Index j = 0; j < theta.size(); ++j) {
      const double h = 1e-6 * std::max(std::abs(theta[j]), 0.1);
      const auto at = [&](double value) {
        Eigen::VectorXd moved = theta;
        moved[j] = value;
        const auto setting = p.elbow.catalogue.at(wanted, moved);
        const MusculoskeletalSystem system(setting.model, ShippedElbow::options());
        return simulateSetting(system, setting, p.elbow.excitation, options.simulation);
      };
      const Eigen::VectorXd difference =
          (at(theta[j] + h).q.row(0) - at(theta[j] - h).q.row(0)).transpose() / (2 * h);
      EXPECT_LT((difference - s.q[0].col(j)).cwiseAbs().maxCoeff(),
                2e-5 * s.q[0].col(j).cwiseAbs().maxCoeff())
          << p.elbow.catalogue.parameters()[wanted[static_cast<std::size_t>(j)]].name;
    }
  }
}

}  // namespace
}  // namespace bio
