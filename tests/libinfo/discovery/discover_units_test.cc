#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "info/discovery/judgement/distinction.h"
#include "info/discovery/judgement/excess_error.h"
#include "info/discovery/judgement/expected_error.h"
#include "info/discovery/judgement/residual_causes.h"
#include "info/discovery/judgement/separation.h"
#include "info/discovery/likelihood/recorded_noise.h"
#include "info/discovery/likelihood/whitening.h"
#include "info/probability/random_stream.h"
#include "libinfo/discovery/drawn_problem.h"

// Outputs of different units and noise: nothing that is inferred depends on the unit.

namespace {

using namespace drawn_problem;
using Eigen::Index;
using Eigen::MatrixXd;
using info::RandomStream;

constexpr double kFactor = 1000;

// Every second sample is that of a further output, in a unit that is kFactor times smaller.
class TwoUnits : public LinearDisagreement {
 public:
  explicit TwoUnits(const LinearDisagreement& one)
      : LinearDisagreement(one.numTrials(), static_cast<int>(one.times(0).size())) {
    for (std::size_t k = 0; k < times(0).size(); ++k) outputs_.push_back(k % 2 == 0 ? 0 : 1);
    for (int t = 0; t < numTrials(); ++t) measure(t, scaled(one.measured(t)));
  }
  const std::vector<int>& outputOfSample(int) const override { return outputs_; }
  VectorXd outputs(int trial, const VectorXd& values, const VectorXd& latent) const override {
    return scaled(LinearDisagreement::outputs(trial, values, latent));
  }
  VectorXd factors() const {
    VectorXd factors(static_cast<Index>(outputs_.size()));
    for (Index k = 0; k < factors.size(); ++k) factors[k] = k % 2 == 0 ? 1 : kFactor;
    return factors;
  }

 private:
  MatrixXd scaled(const MatrixXd& rows) const { return factors().asDiagonal() * rows; }

  std::vector<int> outputs_;
};

Whitening twoNoises() {
  return Whitening(VectorXd{{kOutput, kFactor * kOutput}});
}

TEST(Whitening, DividesEverySampleByTheNoiseOfItsOutput) {
  const Whitening both(VectorXd{{2, 5}});
  const std::vector<int> outputs{0, 1, 1, 0};
  MatrixXd rows(4, 2);
  rows << 2, 4, 5, 10, 15, 20, 6, 8;
  both.whiten(outputs, rows);
  EXPECT_EQ(rows, (MatrixXd(4, 2) << 1, 2, 1, 2, 3, 4, 3, 4).finished());
  EXPECT_EQ(both.bySample(outputs, 4), (VectorXd(4) << 2, 5, 5, 2).finished());
  EXPECT_NEAR(both.logDeterminant(outputs, 4), 2 * std::log(2.0) + 2 * std::log(5.0), 1e-15);
  EXPECT_NEAR(Whitening(3).logDeterminant(outputs, 4), 4 * std::log(3.0), 1e-15);
  EXPECT_EQ(both.scaled(2).bySample(outputs, 4), (VectorXd(4) << 4, 10, 10, 4).finished());
}

TEST(Whitening, RefusesAnOutputWithoutNoise) {
  EXPECT_FALSE(Whitening().isPositive());
  EXPECT_FALSE(Whitening(VectorXd{{1, 0}}).isPositive());
  EXPECT_FALSE(Whitening(VectorXd{{1, NAN}}).isPositive());
  EXPECT_TRUE(Whitening(VectorXd{{1, 2}}).isPositive());
  EXPECT_THROW((void)Whitening(VectorXd{{1, 2}}).bySample({0, 2}, 2), std::invalid_argument);
}

TEST(Whitening, AnOutputInAnotherUnitGivesTheSameFitAndEvidence) {
  const LinearDisagreement one = drawn(2, 60, 0.4);
  const TwoUnits two(one);
  const Likelihood of(one, {0, 1}, nominalValues(one), kTime),
      ofBoth(two, {0, 1}, nominalValues(two), kTime);
  const Hypothesis push = makeHypothesis(one, {0}, {0, 1});
  for (const double latent : {0.0, kLatent}) {
    const Fit fit = of.fit(push, {kOutput, latent, kTime}, nominalValues(one), {}, kExact);
    const Fit both = ofBoth.fit(push, {twoNoises(), latent, kTime}, nominalValues(two), {}, kExact);
    EXPECT_LT((both.xi - fit.xi).norm(), 1e-7);
    EXPECT_LT((both.covariance - fit.covariance).norm(), 1e-9);
    EXPECT_NEAR(both.cost, fit.cost, 1e-7);
    // the density of a number in a smaller unit is smaller by that factor
    EXPECT_NEAR(both.logEvidence, fit.logEvidence - 60 * std::log(kFactor), 1e-6);
    const auto white = of.whitened(0, fit), whiteOfBoth = ofBoth.whitened(0, both);
    EXPECT_LT((whiteOfBoth.innovations - white.innovations).norm(), 1e-6);
    const ResidualEvidence causes = residualEvidence(of, fit);
    const ResidualEvidence causesOfBoth = residualEvidence(ofBoth, both);
    // not by the state: maps show the first output, which here has every second sample
    EXPECT_NEAR(causesOfBoth.of(Cause::inputs), causes.of(Cause::inputs), 0.5);
  }
}

TEST(Whitening, AnOutputInAnotherUnitGivesTheSameExpectedErrorAndSeparation) {
  const LinearDisagreement one = drawn(2, 60, 0.4);
  const TwoUnits two(one);
  const auto fitted = [](const LinearDisagreement& data, const Whitening& noise,
                         std::vector<std::size_t> effects) {
    return Likelihood(data, {0, 1}, nominalValues(data), kTime)
        .fit(makeHypothesis(data, std::move(effects), {0, 1}), {noise, kLatent, kTime},
             nominalValues(data), {}, kExact);
  };
  const Fit push = fitted(one, kOutput, {0}), bias = fitted(one, kOutput, {2});
  const Fit pushOfBoth = fitted(two, twoNoises(), {0}), biasOfBoth = fitted(two, twoNoises(), {2});
  const double nats = expectedSeparation(one, one, push, bias);
  EXPECT_GT(nats, 0.01);
  EXPECT_NEAR(expectedSeparation(two, two, pushOfBoth, biasOfBoth), nats, 1e-4 * nats);

  const auto expected = [](const LinearDisagreement& data, const Whitening& noise, const Fit& fit) {
    const Likelihood held(data, {0, 1}, nominalValues(data), kTime);
    const Fit starts = held.fit(startsOnly(data, {0, 1}), {noise, 0, kTime}, fit.values);
    return expectedError(held, starts, fit).rms / held.simulationError(starts.values, noise);
  };
  const double single = expected(one, kOutput, push);
  EXPECT_NEAR(expected(two, twoNoises(), pushOfBoth), single, 1e-6 * single);

  const PresentEffect shove{0, VectorXd::Constant(1, 0.4)}, shift{2, VectorXd::Constant(1, 0.1)};
  const double told = distinction(one, shove, shift, kOutput).least();
  EXPECT_NEAR(distinction(two, shove, shift, twoNoises()).least(), told, 1e-6 * told);
}

TEST(Whitening, EveryOutputTellsItsOwnNoiseAndRange) {
  LinearDisagreement one(2, 400);
  for (int t = 0; t < 2; ++t) {
    RandomStream random(7, static_cast<std::uint64_t>(t));
    VectorXd y(400);
    for (double& value : y) value = 0.05 * random.normal();
    one.measure(t, y);
  }
  const TwoUnits two(one);
  const OutputSd found = estimateOutputSd(two, {0, 1});
  for (const std::size_t output : {0u, 1u})
    EXPECT_NEAR(found.value.sd(output) / (output == 0 ? 0.05 : 0.05 * kFactor), 1,
                3 * 0.5 * std::sqrt(2.0) * found.relativeError);
  EXPECT_NE(found.value.sd(0), found.value.sd(1) / kFactor);
  EXPECT_FALSE(recordedNoise(two, {0, 1}).sd.value == Whitening(found.value.sd(0)));

  // in the unit of the first output, of the wider one in σ
  LinearDisagreement wide(1, 4);
  wide.measure(0, VectorXd{{1, 5, 2, 8}});
  const TwoUnits both(wide);  // 1 and 2; 5000 and 8000
  EXPECT_NEAR(rangeOf(both, {0}, Whitening(VectorXd{{0.1, 100}})), 3, 1e-12);
  EXPECT_NEAR(rangeOf(both, {0}, Whitening(VectorXd{{0.1, 1000}})), 1, 1e-12);
}

}  // namespace
