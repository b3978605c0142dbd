#include "info/dynamics/predictor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "robots/instances.h"
#include "support/damped_oscillator.h"
#include "support/pendulum.h"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using info::Predictor;

// u_k = u(k·Δt) for k = 0 … K.
template <info::StepMap M, class F>
std::vector<info::InputOf<M>> sampleInput(const F& u, double timeStep, std::size_t steps) {
  std::vector<info::InputOf<M>> inputs;
  for (std::size_t k = 0; k <= steps; ++k) inputs.push_back(u(static_cast<double>(k) * timeStep));
  return inputs;
}

// Largest deviation of Γ and of the contracted curvature from central differences, relative.
struct Deviation {
  double first, second;
};
Deviation compare(const Predictor& predictor, const VectorXd& theta) {
  const auto at = predictor.withSensitivities(theta);
  MatrixXd w(at.outputs.rows(), at.outputs.cols());
  for (Eigen::Index i = 0; i < w.size(); ++i) w.reshaped()[i] = std::sin(1.0 + double(i));
  const MatrixXd curvature = predictor.contractedCurvature(theta, w);
  MatrixXd gamma(at.gamma.rows(), at.gamma.cols()), second(curvature.rows(), curvature.cols());
  for (Eigen::Index j = 0; j < theta.size(); ++j) {
    const double h = 1e-5 * std::abs(theta[j]);
    const VectorXd step = h * VectorXd::Unit(theta.size(), j);
    gamma.col(j) =
        (predictor.outputs(theta + step) - predictor.outputs(theta - step)).reshaped() / (2 * h);
    second.col(j) = (predictor.withSensitivities(theta + step).gamma -
                     predictor.withSensitivities(theta - step).gamma)
                        .transpose() *
                    w.reshaped() / (2 * h);
  }
  EXPECT_TRUE(at.outputs.isApprox(predictor.outputs(theta), 1e-14));
  EXPECT_LT((curvature - curvature.transpose()).norm(), 1e-12 * curvature.norm());
  return {(at.gamma - gamma).norm() / gamma.norm(), (curvature - second).norm() / second.norm()};
}

TEST(Predictor, HasTheDerivativesOfItsOutputsThroughAnExplicitStep) {
  // the load cell's output contains u, x and θ
  using Map = info::Rk4<info::SuspendedMass>;
  const auto u = [](double t) { return Eigen::Matrix<double, 1, 1>(2 * std::cos(3 * t) + t); };
  const auto predictor =
      info::makePredictor(Map{{}, 0.02}, info::Experiment<Map>{Eigen::Vector4d(0, 0.3, 0, -0.2),
                                                               sampleInput<Map>(u, 0.02, 100),
                                                               info::stepsEvery(0, 5, 100)});
  const auto sd = compare(predictor, Eigen::Vector2d(0.12, 0.5));
  EXPECT_LT(sd.first, 1e-8);
  EXPECT_LT(sd.second, 1e-7);
  EXPECT_EQ(predictor.outputs(Eigen::Vector2d(0.12, 0.5)).cols(), 21);
}

TEST(Predictor, HasTheDerivativesOfItsOutputsThroughAnImplicitStep) {
  using Map = info::ImplicitMidpoint<info::Pendulum>;
  const auto u = [](double t) { return Eigen::Matrix<double, 1, 1>(0.5 * std::sin(t)); };
  const auto predictor = info::makePredictor(
      Map{{}, 0.05}, info::Experiment<Map>{Eigen::Vector2d(1, 0), sampleInput<Map>(u, 0.05, 40),
                                           info::stepsEvery(1, 1, 40)});
  const auto sd = compare(predictor, Eigen::Vector2d(0.8, 0.1));
  EXPECT_LT(sd.first, 1e-7);
  EXPECT_LT(sd.second, 1e-6);
}

TEST(Predictor, AgreesWithTheClosedFormOfTheOscillator) {
  using Map = info::Rk4<info::DampedOscillator>;
  const Eigen::Vector2d theta(0.6, 9);
  const auto predictor = info::makePredictor(
      Map{{}, 0.01}, info::Experiment<Map>{Eigen::Vector2d(1, 0.5),
                                           std::vector<Eigen::Matrix<double, 1, 1>>(
                                               301, Eigen::Matrix<double, 1, 1>(0.0)),
                                           info::stepsEvery(10, 10, 300)});
  const auto at = predictor.withSensitivities(theta);
  using Two = info::Dual<2>;
  info::Vector<Two, 2> seeded;
  seeded << Two(0.6, 2, 0), Two(9, 2, 1);
  for (Eigen::Index k = 0; k < 30; ++k) {
    const Two q =
        info::DampedOscillator{}.freeMotion(Two(1), Two(0.5), seeded, 0.1 * double(k + 1));
    EXPECT_NEAR(at.outputs(0, k), q.value(), 1e-7);
    EXPECT_NEAR(at.gamma(k, 0), q.derivatives()[0], 1e-7);
    EXPECT_NEAR(at.gamma(k, 1), q.derivatives()[1], 1e-7);
  }
}

TEST(Predictor, OfSomeParametersInOtherUnitsFollowsTheChainRule) {
  using Map = info::Rk4<info::SuspendedMass>;
  const auto full = info::makePredictor(
      Map{{}, 0.02}, info::Experiment<Map>{Eigen::Vector4d(0, 0.3, 0, 0),
                                           std::vector<Eigen::Matrix<double, 1, 1>>(
                                               51, Eigen::Matrix<double, 1, 1>(1.0)),
                                           info::stepsEvery(1, 1, 50)});
  // the length alone, in centimetres
  const auto part =
      info::reparametrise(full, Eigen::Vector2d(0.12, 0.5), {1}, VectorXd::Constant(1, 0.01));
  const VectorXd theta = VectorXd::Constant(1, 47.0);
  EXPECT_EQ(part.outputs(theta), full.outputs(Eigen::Vector2d(0.12, 0.47)));
  const auto sd = compare(part, theta);
  EXPECT_LT(sd.first, 1e-8);
  EXPECT_LT(sd.second, 1e-7);
  EXPECT_THROW(info::reparametrise(full, Eigen::Vector2d(1, 1), {2}, VectorXd::Ones(1)),
               std::invalid_argument);
  EXPECT_THROW(info::reparametrise(full, Eigen::Vector2d(1, 1), {1}, VectorXd::Ones(2)),
               std::invalid_argument);
}

// No step solves an equation with a torque that is not a number.
TEST(Predictor, LeavesSamplesAfterAnUnsolvedStepUndefined) {
  using Map = info::ImplicitMidpoint<info::Pendulum>;
  std::vector<info::Vector<double, 1>> inputs(9, info::Vector<double, 1>(0.1));
  inputs[5][0] = NAN;
  const auto predictor = info::makePredictor(
      Map{{}, 0.05},
      info::Experiment<Map>{Eigen::Vector2d(1, 0), inputs, info::stepsEvery(1, 1, 8)});
  const Eigen::Vector2d theta(0.8, 0.1);
  const MatrixXd outputs = predictor.outputs(theta);
  EXPECT_TRUE(outputs.leftCols(4).allFinite());
  EXPECT_TRUE(outputs.rightCols(4).array().isNaN().all());
  const auto at = predictor.withSensitivities(theta);
  EXPECT_TRUE(at.gamma.topRows(4).allFinite());
  EXPECT_TRUE(at.gamma.bottomRows(4).array().isNaN().all());
  EXPECT_TRUE(std::isnan(predictor.contractedCurvature(theta, outputs)(0, 0)));
}

TEST(Predictor, RefusesSamplesBeyondTheInputs) {
  using Map = info::ImplicitMidpoint<info::Pendulum>;
  const std::vector<info::Vector<double, 1>> inputs(5, info::Vector<double, 1>(0.0));
  const Eigen::Vector2d start(1, 0);
  EXPECT_THROW(info::makePredictor(Map{{}, 0.05}, {start, inputs, {5}}), info::DimensionError);
  EXPECT_THROW(info::makePredictor(Map{{}, 0.05}, {start, inputs, {}}), info::DimensionError);
  const auto predictor = info::makePredictor(Map{{}, 0.05}, {start, inputs, {4}});
  EXPECT_THROW(predictor.outputs(VectorXd::Ones(3)), info::DimensionError);
}

}  // namespace
