#include "info/design/discrete_projection.h"

#include <gmock/gmock.h>

#include <cmath>

#include "info/information/symmetric_eigen.h"
#include "robots/instances.h"
#include "robots/robot_designs.h"
#include "support/throws_saying.h"

namespace {

using support::throwsSaying;
using namespace info;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::HasSubstr;

// The load cell's output has u in it.
StepTask loadCell(InformationWeights information) {
  constexpr double h = 0.02;
  StepTask task{extend(Rk4<SuspendedMass>{{}, h}, Vector<double, 2>(0.1, 0.6)), {}};
  StepDesign& d = task.design;
  d.timeStep = h;
  d.x0 = VectorXd::Zero(4);
  for (int k = 0; k <= 100; ++k)
    d.desiredInput.push_back(VectorXd::Constant(1, 0.8 * std::cos(4 * h * k)));
  d.outputCovariance = MatrixXd::Constant(1, 1, 0.01);
  d.information = information;
  d.stateWeight = 0.1 * MatrixXd::Identity(4, 4);
  d.inputWeight = MatrixXd::Constant(1, 1, 0.5);
  d.rateWeight = MatrixXd::Constant(1, 1, 1e-3);
  d.modelState = 1e-3 * MatrixXd::Identity(13, 13);
  d.modelInput = MatrixXd::Constant(1, 1, 1);
  d.modelRate = MatrixXd::Constant(1, 1, 1e-3);
  d.gainState = MatrixXd::Identity(5, 5);
  d.gainInput = MatrixXd::Constant(1, 1, 1);
  return task;
}

// DJ·ζ against the central difference of J(P(ξ + γζ)), at a motion off the desired one.
double slopeDefect(const StepTask& task, double move = 3e-4) {
  std::vector<VectorXd> start = task.design.desiredInput;
  for (std::size_t k = 1; k < start.size(); ++k) start[k] *= 1.05;
  StepProjection projection(task.system, task.design, start);
  const auto direction = projection.findDirection(1e-9);
  EXPECT_LT(direction.slope, 0);
  const double step = move / direction.largestMove;
  const double plus = projection.trial(step), minus = projection.trial(-step);
  const double twice = projection.trial(2 * step), minusTwice = projection.trial(-2 * step);
  return (8 * (plus - minus) - (twice - minusTwice)) / (12 * step) / direction.slope - 1;
}

TEST(StepProjection, HasTheExactSlopeForEveryCriterionWithTheInputInTheOutput) {
  EXPECT_NEAR(slopeDefect(loadCell({.e = 1e3})), 0, 1e-6);
  EXPECT_NEAR(slopeDefect(loadCell({.condition = 2})), 0, 1e-6);
  EXPECT_NEAR(slopeDefect(loadCell({.a = 1e3})), 0, 1e-6);
  EXPECT_NEAR(slopeDefect(loadCell({.d = 5})), 0, 1e-6);
  EXPECT_NEAR(slopeDefect(loadCell({.e = 1e3, .a = 10, .d = 1, .condition = 1})), 0, 1e-6);
  EXPECT_NEAR(slopeDefect(loadCell({})), 0, 1e-6);  // tracking alone
}

TEST(StepProjection, HasTheExactSlopeOnTheVariationalIntegrator) {
  StepTask task = doublePendulumStepTask();
  EXPECT_NEAR(slopeDefect(task, 2e-6), 0, 1e-6);
  task.design.information = {.condition = 1};
  EXPECT_NEAR(slopeDefect(task, 2e-6), 0, 1e-6);
  EXPECT_NEAR(slopeDefect(doublePendulumStepTask(0.02, 5), 2e-6), 0, 1e-6);
}

TEST(StepProjection, HasTheExactSlopeWithinLimits) {
  StepTask task = loadCell({.e = 1e3});
  task.design.limits = {VectorXd{{-0.86}}, VectorXd{{0.85}}, 0.05};  // start goes beyond 0.99 of it
  EXPECT_NEAR(slopeDefect(task, 1e-4), 0, 1e-6);
}

TEST(StepProjection, HasTheExactSlopeWithWaypointsAndReachesThem) {
  StepTask task = loadCell({});
  const Eigen::Vector4d place(0.3, 0.4, 0, 0);
  task.design.waypoints = {{60, place, Eigen::Vector4d(1e6, 1e6, 0, 0).asDiagonal()},
                           {100, Eigen::Vector4d::Zero(), 1e2 * MatrixXd::Identity(4, 4)}};
  EXPECT_NEAR(slopeDefect(task), 0, 1e-5);
  StepProjection projection(task.system, task.design);
  const SearchResult result = search(projection, {.slopeTolerance = 1e-6});
  EXPECT_TRUE(result.converged);
  EXPECT_LE(result.iterations, 15);  // the waypoints are in the model: Gauss and Newton
  EXPECT_LT((projection.motion().x[60] - place).head(2).norm(), 0.01);
  task.design.waypoints[0].step = 101;
  EXPECT_THROW(StepProjection(task.system, task.design), std::invalid_argument);
  task.design.waypoints[0] = {60, VectorXd::Zero(3), MatrixXd::Identity(4, 4)};
  EXPECT_THROW(StepProjection(task.system, task.design), DimensionError);
  task.design.waypoints[0] = {60, place, -MatrixXd::Identity(4, 4)};
  EXPECT_THROW(StepProjection(task.system, task.design), std::domain_error);
}

TEST(StepProjection, CountsOnlyTheSamplesTaken) {
  const auto every = [](std::size_t n) {
    const StepTask task = doublePendulumStepTask(0.02, n);
    return StepProjection(task.system, task.design).information();
  };
  const MatrixXd all = every(1), fifth = every(5);
  EXPECT_LT(fifth(0, 0), 0.3 * all(0, 0));
  EXPECT_NEAR(fifth(0, 0) / all(0, 0), 0.2, 0.02);
}

TEST(StepProjection, RaisesTheInformationOfTheDoublePendulumAHundredfold) {
  const StepTask task = doublePendulumStepTask();
  StepProjection projection(task.system, task.design);
  SearchOptions options;
  options.slopeTolerance = 0.01;
  const SearchResult result = search(projection, options);
  EXPECT_TRUE(result.converged) << describe(result.why);
  const auto least = [](const MatrixXd& I) { return info::symmetricEigenvalues(I)[0]; };
  // thesis: 543 to 7.34e4, a factor of 135; here 415 to 6.4e4
  EXPECT_NEAR(least(result.informationStart), 415, 5);
  EXPECT_GT(least(result.information) / least(result.informationStart), 100);
  for (std::size_t i = 1; i < result.costs.size(); ++i)
    EXPECT_LT(result.costs[i], result.costs[i - 1]);
  // a warm start from the result is there already
  StepProjection again(task.system, task.design, projection.motion().u);
  EXPECT_NEAR(again.cost(), projection.cost(), 1e-12 * projection.cost());
  EXPECT_EQ(search(again, options).iterations, 0);
}

TEST(StepProjection, KeepsInputsWithinTheirLimits) {
  StepTask task = loadCell({.e = 1e3});
  task.design.inputWeight *= 1e-3;
  task.design.rateWeight *= 1e-3;
  const auto largest = [&] {
    StepProjection projection(task.system, task.design);
    SearchOptions options{.maxIterations = 30, .largestMove = 2};
    search(projection, options);
    double most = 0;
    for (const VectorXd& u : projection.motion().u) most = std::max(most, std::abs(u[0]));
    return most;
  };
  EXPECT_GT(largest(), 1.1);
  task.design.limits = {VectorXd{{-0.9}}, VectorXd{{0.9}}, 0.02};
  EXPECT_LT(largest(), 0.9);
}

TEST(StepProjection, AdvisesWhereTheStartTellsNothing) {
  StepTask task = doublePendulumStepTask();
  for (VectorXd& u : task.design.desiredInput) u.setZero();
  EXPECT_THROW(StepProjection(task.system, task.design), NoInformation);
  throwsSaying([&] { StepProjection(task.system, task.design); }, "small perturbation");
}

TEST(StepProjection, NamesTheRuleThatIsBroken) {
  const auto with = [](auto change) {
    return [=] {
      StepTask task = loadCell({.e = 1});
      change(task.design);
      StepProjection(task.system, task.design);
    };
  };
  throwsSaying(with([](auto& d) { d.timeStep = 0; }), "time step: 0 s");
  throwsSaying(with([](auto& d) { d.modelInput.setZero(); }), "model's input weight");
  throwsSaying(with([](auto& d) { d.gainState(0, 0) = -1; }), "gain's state weight");
  throwsSaying(with([](auto& d) { d.outputCovariance.setZero(); }), "output covariance");
  throwsSaying(with([](auto& d) { d.information.e = -1; }), "weight of E in the objective: -1");
  throwsSaying(with([](auto& d) {
                 d.limits = {VectorXd{{1.0}}, VectorXd{{-1.0}}, 1};
               }),
               "limits of input 0: lower 1, upper -1");
  throwsSaying(with([](auto& d) {
                 d.limits = {VectorXd{{-1.0}}, VectorXd{{1.0}}, 0};
               }),
               "weight of the input limits: 0");
  throwsSaying(with([](auto& d) { d.desiredInput[3][0] = std::nan(""); }), "number 3");
  throwsSaying(with([](auto& d) { d.stepsPerSample = 0; }), "steps per sample: 0");
  throwsSaying(with([](auto& d) { d.x0.resize(3); }), "x0");
}

}  // namespace
