#include "bio/analysis/output_gradient.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;
using ::testing::HasSubstr;

SimulationOptions hundredths() {
  SimulationOptions options;
  options.step = 0.01;
  return options;
}

/// The shipped trial with weights for its angle and its speed.
struct Weighted : ShippedElbow {
  StudiedTrial studied;
  SensitivityQuestion question{options(), "elbow_flexion", 0.01, {}, {}};
  Eigen::VectorXd theta, weights;

  Weighted()
      : studied(studiedTrial(trial, model, system, {startCoordinates(trial, system, {}), {}},
                             hundredths())) {
    question.observed =
        observedChannels({{"elbow_flexion", 1}, {"elbow_flexion.speed", 1}}, model, system);
    question.selection =
        studied.catalogue.select({"TRI.radius", "hand.mass", "BRA.max_isometric_force"});
    theta = studied.catalogue.values(question.selection);
    weights.resize(predictorOf(studied, question).size());
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      weights[i] = std::sin(0.37 * static_cast<double>(i));
    }
  }
};

TEST(OutputGradient, IsTheTransposedJacobianTimesTheWeights) {
  const Weighted w;
  const auto [outputs, found] = gradientOfOutputs(w.studied, w.question, w.theta, w.weights);
  EXPECT_EQ(outputs, predictorOf(w.studied, w.question).outputs(w.theta));
  const TrialPredictor::Linearised forward =
      predictorOf(w.studied, w.question).withSensitivities(w.theta);
  EXPECT_NEAR(found.cost, w.weights.dot(forward.outputs),
              1e-12 * static_cast<double>(w.weights.size()));
  const Eigen::VectorXd expected = forward.gamma.transpose() * w.weights;
  EXPECT_LT((found.gradient - expected).norm(), 1e-8 * expected.norm());
}

TEST(OutputGradient, TheCoordinateAloneIsObservedWithoutChannels) {
  Weighted w;
  w.question.observed.clear();
  const Eigen::VectorXd weights = w.weights.head(predictorOf(w.studied, w.question).size());
  const CostGradient found = gradientOfOutputs(w.studied, w.question, w.theta, weights).sum;
  const TrialPredictor::Linearised forward =
      predictorOf(w.studied, w.question).withSensitivities(w.theta);
  const Eigen::VectorXd expected = forward.gamma.transpose() * weights;
  EXPECT_LT((found.gradient - expected).norm(), 1e-8 * expected.norm());
}

TEST(OutputGradient, RefusesWeightsThatDoNotFitAndOutputsWithoutAnAdjoint) {
  Weighted w;
  const auto message = [&](const Eigen::VectorXd& weights) {
    try {
      (void)gradientOfOutputs(w.studied, w.question, w.theta, weights);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing is thrown");
  };
  EXPECT_THAT(message(w.weights.head(3)), HasSubstr("3 weights for"));
  Eigen::VectorXd broken = w.weights;
  broken[1] = NAN;
  EXPECT_THAT(message(broken), HasSubstr("not finite"));
  w.question.observed = observedChannels({{"BRA.tendon_force", 1}}, w.model, w.system);
  EXPECT_THAT(message(w.weights), HasSubstr("BRA.tendon_force"));
}

}  // namespace
}  // namespace bio
