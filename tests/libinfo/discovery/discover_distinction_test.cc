#include "info/discovery/judgement/distinction.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "info/discovery/likelihood/joint_fit.h"
#include "support/linear_problem.h"

namespace {

using namespace info::discover;
using Eigen::VectorXd;

constexpr double kOutput = 0.02;
constexpr std::size_t kPush = 0, kShove = 1, kBias = 2;  // candidates; their quantities are one up

PresentEffect present(std::size_t candidate, double size) {
  return {candidate, VectorXd::Constant(1, size)};
}

// Data without noise in which one of them is there, fitted with the other: where everything is
// linear the cost that is left is what was foreseen.
TEST(Distinction, IsWhatAFitOfTheOtherEffectLeaves) {
  LinearDisagreement data(2, 60);
  const PresentEffect push = present(kPush, 4), bias = present(kBias, -0.6);
  const Distinction predictedExperiments = distinction(data, push, bias, kOutput);
  const auto costOf = [&](const PresentEffect& truth, std::size_t fitted) {
    LinearDisagreement seen(2, 60);
    VectorXd values = nominalValues(seen);
    values[static_cast<Eigen::Index>(truth.candidate) + 1] = truth.values[0];
    for (int t = 0; t < 2; ++t) seen.measure(t, seen.outputs(t, values, {}));
    const Likelihood likelihood(seen, {0, 1}, nominalValues(seen));
    return likelihood
        .fit(makeHypothesis(seen, {fitted}, {0, 1}), {kOutput, 0, 0.1}, nominalValues(seen), {},
             {50, 1e-12})
        .cost;
  };
  EXPECT_NEAR(predictedExperiments.firstOverSecond, costOf(push, kBias), 1e-6);
  EXPECT_NEAR(predictedExperiments.secondOverFirst, costOf(bias, kPush), 1e-6);
  EXPECT_GT(predictedExperiments.least(), 1);
  EXPECT_EQ(predictedExperiments.least(),
            std::min(predictedExperiments.firstOverSecond, predictedExperiments.secondOverFirst));

  // and the deviations are those of a fit of both, less what is known beforehand
  const Likelihood both(data, {0, 1}, nominalValues(data));
  const Fit fit = both.fit(makeHypothesis(data, {kPush, kBias}, {0, 1}), {kOutput, 0, 0.1},
                           nominalValues(data), {}, {50, 1e-12});
  const auto fromData = [&](std::size_t quantity, double prior) {
    const auto at = static_cast<std::size_t>(fit.hypothesis.indexOf(quantity));
    const double sd = fit.sd(at);
    return 1 / std::sqrt(1 / (sd * sd) - 1 / (prior * prior));
  };
  EXPECT_NEAR(predictedExperiments.firstDeviation / fromData(1, 1), 1, 1e-6);
  EXPECT_NEAR(predictedExperiments.secondDeviation / fromData(3, 0.5), 1, 1e-6);
}

TEST(Distinction, OfTwoNamesForTheSameForceGoesToNothing) {
  const LinearDisagreement data(2, 60);
  const double sharp = kOutput / 100;
  const Distinction same = distinction(data, present(kPush, 0.7), present(kShove, 0.7), sharp);
  // however sharp the sensor, the prior of the size is all that is left
  EXPECT_LT(same.least(), 0.5 * 0.7 * 0.7);
  EXPECT_GT(same.least(), 0.01);
}

TEST(Distinction, RefusesWhatIsNoQuestion) {
  const LinearDisagreement data(1, 20);
  const PresentEffect push = present(kPush, 1), bias = present(kBias, 1);
  EXPECT_THROW(distinction(data, push, push, 1), std::invalid_argument);
  EXPECT_THROW(distinction(data, push, present(9, 1), 1), std::invalid_argument);
  EXPECT_THROW(distinction(data, push, present(kBias, 0), 1), std::invalid_argument);
  EXPECT_THROW(distinction(data, push, {kBias, VectorXd::Ones(2)}, 1), std::invalid_argument);
  EXPECT_THROW(distinction(data, push, bias, 0), std::invalid_argument);
}

}  // namespace
