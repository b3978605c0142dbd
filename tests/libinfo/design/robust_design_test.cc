#include "info/design/robust_design.h"

#include <gmock/gmock.h>

#include <cmath>

#include "info/design/discrete_projection.h"
#include "info/design/projection.h"
#include "info/information/symmetric_eigen.h"
#include "robots/instances.h"
#include "support/throws_saying.h"

namespace {

using support::throwsSaying;
using namespace info;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::HasSubstr;

const std::vector<Vector<double, 2>> lengths = {{0.1, 0.3}, {0.1, 0.6}, {0.1, 1.2}};

ExtendedStepMap stepsAt(const Vector<double, 2>& theta) {
  return extend(Rk4<SuspendedMass>{{}, 0.02}, theta);
}
ExtendedStepMap stepsAtAll() {
  std::vector<ExtendedStepMap> all;
  for (const auto& theta : lengths) all.push_back(stepsAt(theta));
  return stack(all);
}

// 3 s of gentle shaking, E-optimal.
StepDesign shaking(RobustRule rule = RobustRule::worst) {
  StepDesign d;
  d.timeStep = 0.02;
  d.x0 = VectorXd::Zero(4);
  for (int k = 0; k <= 150; ++k)
    d.desiredInput.push_back(VectorXd::Constant(1, 0.5 * std::cos(4 * 0.02 * k)));
  d.outputCovariance = MatrixXd::Constant(1, 1, 0.01);
  d.information.e = 1e3;
  d.candidateRule = rule;
  d.stateWeight = 0.1 * MatrixXd::Identity(4, 4);
  d.inputWeight = MatrixXd::Constant(1, 1, 0.1);
  d.modelState = 1e-3 * MatrixXd::Identity(13, 13);
  d.modelInput = MatrixXd::Constant(1, 1, 1);
  d.gainState = MatrixXd::Identity(5, 5);
  d.gainInput = MatrixXd::Constant(1, 1, 1);
  return d;
}

double least(const MatrixXd& I) {
  return info::symmetricEigenvalues(I)[0];
}
// λ_min at every candidate, of the motion that these inputs make.
VectorXd leastAt(const std::vector<VectorXd>& inputs) {
  StepDesign d = shaking();
  d.desiredInput = inputs;
  const StepProjection motion(stepsAtAll(), d);
  VectorXd out(3);
  for (int s = 0; s < 3; ++s) out[s] = least(motion.informations()[std::size_t(s)]);
  return out;
}

TEST(CandidatesCost, FollowsTheInformationOfEachCandidate) {
  const std::vector<MatrixXd> I = {MatrixXd{{3.0, 0.7}, {0.7, 1.2}},
                                   MatrixXd{{2.0, -0.4}, {-0.4, 1.1}}};
  const MatrixXd D{{0.4, -0.3}, {-0.3, 0.9}};
  for (const RobustRule rule : {RobustRule::average, RobustRule::worst}) {
    const InformationWeights weights{.e = 2, .condition = 1};
    const CandidatesCost at = candidatesCost(rule, weights, I, 1e-9);
    for (std::size_t s = 0; s < 2; ++s) {
      const double h = 1e-6;
      const auto moved = [&](double by) {
        std::vector<MatrixXd> J = I;
        J[s] += by * D;
        return candidatesCost(rule, weights, J, 1e-9).value;
      };
      const double central = (moved(h) - moved(-h)) / (2 * h);
      EXPECT_NEAR(at.dvalue_dI[s].cwiseProduct(D).sum(), central, 1e-8 * std::abs(central)) << s;
    }
  }
}

TEST(CandidatesCost, LiesBetweenTheWorstAndAPowerOfTheNumberTimesIt) {
  const auto cost = [](RobustRule rule, std::vector<double> lambdas) {
    std::vector<MatrixXd> I;
    for (double lambda : lambdas) I.push_back(lambda * MatrixXd::Identity(2, 2));
    return candidatesCost(rule, {.e = 6}, I, 1e-9).value;
  };
  EXPECT_DOUBLE_EQ(cost(RobustRule::average, {1, 2, 3}), (6 + 3 + 2) / 3.0);
  EXPECT_GE(cost(RobustRule::worst, {1, 2, 3}), 6);
  EXPECT_NEAR(cost(RobustRule::worst, {1, 2, 3}), 6, 1e-5);
  EXPECT_NEAR(cost(RobustRule::worst, {2, 2, 2}), 3 * std::pow(3, 0.05), 1e-12);
  EXPECT_DOUBLE_EQ(cost(RobustRule::worst, {2}), 3);
}

// Every candidate alone, by the code for one system, is the second way.
TEST(Stack, IsEveryCandidateByItself) {
  const ExtendedStepMap all = stepsAtAll();
  ASSERT_EQ(all.candidates, 3);
  const StepDesign d = shaking();
  const StepProjection together(all, d);
  for (std::size_t s = 0; s < 3; ++s) {
    const StepProjection alone(stepsAt(lengths[s]), d);
    EXPECT_LT((together.informations()[s] - alone.information()).norm(),
              1e-12 * alone.information().norm());
    for (std::size_t k : {1UL, 80UL, 150UL}) {
      EXPECT_EQ(together.motion().x[k].segment(4 * Eigen::Index(s), 4), alone.motion().x[k]);
      EXPECT_EQ(together.motion().psi[k].middleRows(4 * Eigen::Index(s), 4), alone.motion().psi[k]);
    }
  }
}

TEST(Stack, OfTheSameSystemTwiceIsThatSystem) {
  const StepDesign d = shaking(RobustRule::average);
  StepProjection one(stepsAt(lengths[1]), d);
  StepProjection two(stack(std::vector{stepsAt(lengths[1]), stepsAt(lengths[1])}), d);
  EXPECT_NEAR(two.cost(), one.cost(), 1e-12 * one.cost());
  const auto slope = one.findDirection(1e-9).slope;
  EXPECT_NEAR(two.findDirection(1e-9).slope, slope, 1e-9 * std::abs(slope));
  EXPECT_NEAR(two.trial(1e-3), one.trial(1e-3), 1e-9 * one.cost());
}

// DJ·ζ against the central difference of J(P(ξ + γζ)), at a motion off the desired one.
template <class Projection>
double stackedSlopeDefect(Projection& projection, double move) {
  const auto direction = projection.findDirection(1e-9);
  EXPECT_LT(direction.slope, 0);
  const double step = move / direction.largestMove;
  const double near = projection.trial(step) - projection.trial(-step);
  const double far = projection.trial(2 * step) - projection.trial(-2 * step);
  return (8 * near - far) / (12 * step) / direction.slope - 1;
}

TEST(Stack, HasTheExactSlopeInSteps) {
  for (const RobustRule rule : {RobustRule::average, RobustRule::worst}) {
    const StepDesign d = shaking(rule);
    std::vector<VectorXd> start = d.desiredInput;
    for (std::size_t k = 1; k < start.size(); ++k) start[k] *= 1.05;
    StepProjection projection(stepsAtAll(), d, start);
    EXPECT_NEAR(stackedSlopeDefect(projection, 3e-4), 0, 1e-6);
  }
}

TEST(Stack, HasTheSlopeToSecondOrderInContinuousTime) {
  const auto defect = [](double step) {
    std::vector<ExtendedFlow> all;
    for (const auto& theta : lengths) all.push_back(extendFlow(SuspendedMass{}, theta));
    FlowDesign d;
    static_cast<MotionDesign&>(d) = shaking();
    d.step = step;
    d.outputDensity = MatrixXd::Constant(1, 1, 0.01);
    d.modelState = 1e-3 * MatrixXd::Identity(12, 12);
    d.gainState = MatrixXd::Identity(4, 4);
    d.desiredInput.clear();
    std::vector<VectorXd> start;
    for (int k = 0; k * step < 3 + step / 2; ++k) {
      d.desiredInput.push_back(VectorXd::Constant(1, 0.5 * std::cos(4 * step * k)));
      start.push_back(1.05 * d.desiredInput.back());
    }
    FlowProjection projection(stack(all), d, start);
    return stackedSlopeDefect(projection, 1e-3);
  };
  const double coarse = defect(0.02);
  EXPECT_LT(std::abs(coarse), 0.02);
  EXPECT_NEAR(coarse / defect(0.01), 4, 0.8);
}

// λ_min at lengths of 0.3, 0.6 and 1.2 m.
TEST(RobustDesign, BeatsTheNominalOneAtItsWorstCandidate) {
  const SearchOptions options{.maxIterations = 60, .relativeSlope = 1e-3, .largestMove = 2};
  StepProjection nominal(stepsAt(lengths[1]), shaking());
  search(nominal, options);
  StepProjection robust(stepsAtAll(), shaking());
  search(robust, options);
  const VectorXd ofNominal = leastAt(nominal.motion().u), ofRobust = leastAt(robust.motion().u);
  EXPECT_GT(ofRobust.minCoeff(), 1.2 * ofNominal.minCoeff())
      << ofNominal.transpose() << " and " << ofRobust.transpose();
}

TEST(Candidates, NameTheRuleThatIsBroken) {
  const MatrixXd I = MatrixXd::Identity(2, 2);
  throwsSaying(
      [&] {
        candidatesCost(RobustRule::worst, {.d = 1}, {I, I}, 1e-9);
      },
      "weight of D in the objective is 1");
  throwsSaying([&] { candidatesCost(RobustRule::worst, {.e = 1}, {}, 1e-9); }, "must be ≥ 1");
  throwsSaying([] { stack(std::vector<ExtendedStepMap>{}); }, "candidates: 0");
  throwsSaying([] { stack(std::vector{stepsAtAll()}); }, "a stack itself");
  ExtendedStepMap other = stepsAt(lengths[0]);
  other.dimensions.output = 2;
  throwsSaying([&] { stack(std::vector{stepsAt(lengths[0]), other}); }, "sizes differ");
}

}  // namespace
