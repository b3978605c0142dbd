#include "info/design/projected_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "info/design/discrete_projection.h"
#include "info/design/projection.h"
#include "info/information/symmetric_eigen.h"
#include "robots/instances.h"

namespace {

using namespace info;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double step = 0.02;

MotionDesign shakingMotion() {
  MotionDesign d;
  d.x0 = VectorXd::Zero(4);
  for (int k = 0; k <= 100; ++k)
    d.desiredInput.push_back(VectorXd::Constant(1, 0.8 * std::cos(4 * step * k)));
  d.information.e = 1e3;
  d.inputWeight = d.modelInput = d.gainInput = MatrixXd::Identity(1, 1);
  return d;
}

StepProjection inSteps(std::size_t stepsPerSample = 1) {
  StepDesign d;
  static_cast<MotionDesign&>(d) = shakingMotion();
  d.timeStep = step;
  d.stepsPerSample = stepsPerSample;
  d.outputCovariance = MatrixXd::Constant(1, 1, 0.01);
  d.modelState = 1e-3 * MatrixXd::Identity(13, 13);
  d.gainState = MatrixXd::Identity(5, 5);
  return {extend(Rk4<SuspendedMass>{{}, step}, Vector<double, 2>(0.1, 0.6)), d};
}

FlowProjection continuously() {
  FlowDesign d;
  static_cast<MotionDesign&>(d) = shakingMotion();
  d.step = step;
  d.outputDensity = MatrixXd::Constant(1, 1, 0.01 * step);
  d.modelState = 1e-3 * MatrixXd::Identity(12, 12);
  d.gainState = MatrixXd::Identity(4, 4);
  return {extendFlow(SuspendedMass{}, Vector<double, 2>(0.1, 0.6)), d};
}

void growsToItsEnd(const ProjectedMotion& projection) {
  const std::vector<MatrixXd> grown = projection.informationOverTime();
  ASSERT_EQ(grown.size(), projection.motion().x.size());
  const double scale = projection.information().norm();
  EXPECT_LT((grown.back() - projection.information()).norm(), 1e-12 * scale);
  for (std::size_t k = 1; k < grown.size(); ++k)
    EXPECT_GE(info::symmetricEigenvalues(grown[k] - grown[k - 1])[0], -1e-12 * scale);
}

TEST(ProjectedMotion, SaysHowTheInformationGrew) {
  growsToItsEnd(inSteps());
  growsToItsEnd(continuously());
  // between samples nothing is learnt
  const auto rare = inSteps(10).informationOverTime();
  EXPECT_EQ(rare[9].norm(), 0);
  EXPECT_GT(rare[10].norm(), 0);
  EXPECT_EQ(rare[19], rare[10]);
}

// Samples at every step, and the same noise as a density: two ways to one information.
TEST(ProjectedMotion, KnowsAboutTheSameInEitherWayOfTime) {
  const MatrixXd steps = inSteps().information(), flow = continuously().information();
  EXPECT_LT((steps - flow).norm(), 0.02 * steps.norm());
}

TEST(ProjectedMotion, TakesTheLastTrialAndKeepsItsCosts) {
  StepProjection projection = inSteps();
  EXPECT_EQ(projection.trackingCost(), 0);  // it starts from what is desired
  const double before = projection.cost();
  projection.findDirection(1e-9);
  const double tried = projection.trial(1e-3);
  EXPECT_EQ(projection.cost(), before);
  projection.accept();
  EXPECT_EQ(projection.cost(), tried);
  EXPECT_GT(projection.trackingCost(), 0);
  const double lambda = info::symmetricEigenvalues(projection.information())[0];
  EXPECT_NEAR(projection.trackingCost() + 1e3 / lambda, tried, 1e-9 * tried);
}

}  // namespace
