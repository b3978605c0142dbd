#include "info/design/projection.h"

#include <gmock/gmock.h>

#include <cmath>

#include "info/information/symmetric_eigen.h"
#include "robots/robot_designs.h"
#include "support/throws_saying.h"

namespace {

using support::throwsSaying;
using namespace info;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::HasSubstr;

// DJ·ζ against the central difference of J(P(ξ + γζ)), at a motion off the desired one.
double slopeDefect(FlowTask task, InformationWeights information) {
  task.design.information = information;
  std::vector<VectorXd> start = task.design.desiredInput;
  for (VectorXd& u : start) u *= 1.05;
  FlowProjection projection(task.system, task.design, start);
  const auto direction = projection.findDirection(1e-9);
  EXPECT_LT(direction.slope, 0);
  const double step = 1e-5 / direction.largestMove;
  const double near = projection.trial(step) - projection.trial(-step);
  const double far = projection.trial(2 * step) - projection.trial(-2 * step);
  return (8 * near - far) / (12 * step) / direction.slope - 1;
}

// Measured: 1.5e-2 and 6.1e-3 (angles), 3.9e-4 (force, which has the input in it).
TEST(FlowProjection, HasTheSlopeToSecondOrderInTheStep) {
  const auto check = [](auto make, InformationWeights information) {
    const double coarse = slopeDefect(make(0.01), information);
    EXPECT_LT(std::abs(coarse), 0.02);
    EXPECT_NEAR(coarse / slopeDefect(make(0.005), information), 4, 0.4);
  };
  check(doublePendulumFlowTask, {.e = 100});
  check(doublePendulumFlowTask, {.condition = 1});
  check(suspendedMassFlowTask, {.e = 1e8});
  check(suspendedMassFlowTask, {.condition = 2});
}

TEST(FlowProjection, RaisesTheInformationOfTheDoublePendulumAThousandfold) {
  const FlowTask task = doublePendulumFlowTask(1.0 / 60);
  FlowProjection projection(task.system, task.design);
  const SearchResult result = search(projection, {.largestMove = 2});
  EXPECT_TRUE(result.converged) << describe(result.why);
  const auto least = [](const MatrixXd& I) { return info::symmetricEigenvalues(I)[0]; };
  // thesis, at 30 samples a second: 0.952 to 990
  EXPECT_NEAR(30 * least(result.informationStart), 0.952, 0.05);
  EXPECT_GT(least(result.information) / least(result.informationStart), 1000);
}

TEST(FlowProjection, MakesBothParametersOfTheSuspendedMassVisible) {
  const FlowTask task = suspendedMassFlowTask(0.01);
  FlowProjection projection(task.system, task.design);
  const SearchResult result = search(projection, {.largestMove = 2});
  EXPECT_TRUE(result.converged) << describe(result.why);
  const auto eigenvalues = [](const MatrixXd& I) {
    return VectorXd(info::symmetricEigenvalues(I));
  };
  const VectorXd before = eigenvalues(result.informationStart),
                 after = eigenvalues(result.information);
  // thesis: 1.73e8 to 19.3, λ1 3.18e6 to 3.63e6
  EXPECT_NEAR(before[1] / before[0] / 1.73e8, 1, 0.02);
  EXPECT_NEAR(before[1], 3.18e6, 0.01e6);
  EXPECT_LT(after[1] / after[0], 20);
  EXPECT_GT(after[1], before[1]);
}

TEST(FlowProjection, NamesTheRuleThatIsBroken) {
  const auto with = [](auto change) {
    return [=] {
      FlowTask task = suspendedMassFlowTask(0.01);
      change(task.design);
      FlowProjection(task.system, task.design);
    };
  };
  throwsSaying(with([](auto& d) { d.step = NAN; }), "time step: nan s");
  throwsSaying(with([](auto& d) { d.modelInput *= -1; }), "model's input weight");
  throwsSaying(with([](auto& d) { d.outputDensity *= -1; }), "output covariance");
  throwsSaying(with([](auto& d) { d.desiredInput.resize(1); }), "desired inputs: 1");
  throwsSaying(with([](auto& d) {
                 d.limits = {VectorXd{{2.0}}, VectorXd{{2.0}}, 1};
               }),
               "limits of input 0: lower 2, upper 2");
  throwsSaying(with([](auto& d) {
                 for (VectorXd& u : d.desiredInput) u.setZero();
               }),
               "has no information");
}

}  // namespace
