#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "info/discovery/judgement/expected_error.h"
#include "info/discovery/judgement/output_sd.h"
#include "libinfo/discovery/drawn_problem.h"

namespace {

using namespace drawn_problem;
using Eigen::Index;

TEST(ExpectedError, IsWhatNewTrialsHaveOnAverage) {
  constexpr double kLoud = 0.1;
  for (const double latent : {0.0, kLatent}) {
    const Noise noise{kLoud, latent, kTime}, still{kLoud, 0, kTime};
    double expected = 0, found = 0, certain = 0;
    constexpr int kDraws = 3000;
    for (int draw = 0; draw < kDraws; ++draw) {
      LinearDisagreement data(2, 16);
      info::RandomStream random(91, static_cast<std::uint64_t>(draw));
      VectorXd truth = nominalValues(data);
      for (const Index i : {0, 1, 4, 5, 6, 7})
        truth[i] += data.quantities()[static_cast<std::size_t>(i)].sd * random.normal();
      data.draw(1000 + static_cast<std::uint64_t>(draw), truth, kLoud, latent, kTime);
      const Likelihood seen(data, {0}, nominalValues(data), kTime);
      const Likelihood held(data, {1}, nominalValues(data), kTime);
      Fit fit = seen.fit(makeHypothesis(data, {0}, {0}), noise, nominalValues(data), {}, kExact);
      const Fit starts = held.fit(startsOnly(data, {1}), still, fit.values, {}, kExact);
      expected += std::pow(expectedError(held, starts, fit).rms, 2);
      found += std::pow(held.simulationError(starts.values, kLoud), 2);
      fit.covariance.setZero();
      certain += std::pow(expectedError(held, starts, fit).rms, 2);
    }
    EXPECT_GT(expected / certain, 1.02) << latent;
    EXPECT_NEAR(found / expected, 1, 0.012) << latent;
  }
}

TEST(ExpectedError, NeedsTheStartsOfTheTrialsThatWereHeldOut) {
  const LinearDisagreement data = drawn(2, 25, 0.4);
  const Likelihood both(data, {0, 1}, nominalValues(data)), held(data, {1}, nominalValues(data));
  const Fit fit =
      both.fit(makeHypothesis(data, {0}, {0, 1}), {kOutput, 0, kTime}, nominalValues(data));
  EXPECT_THROW(expectedError(held, fit, fit), std::invalid_argument);
}

TEST(OutputSd, ComesFromThirdDifferences) {
  LinearDisagreement data(2, 400);
  VectorXd truth = nominalValues(data);
  truth[4] = 0.5;
  data.draw(5, truth, 0.05, 0, kTime);
  const OutputSd found = estimateOutputSd(data, {0, 1});
  // the relative error of σ is half of that of σ²
  EXPECT_NEAR(found.value.sd(0) / 0.05, 1, 3 * 0.5 * found.relativeError);
  EXPECT_LT(found.relativeError, 0.08);
}

// 148 of 200 rows a second have a value: never four in a row that are equally spaced.
TEST(ThirdDifferences, TellTheNoiseOfSamplesThatAreNotEquallySpaced) {
  info::RandomStream random(3, 0);
  std::vector<double> all, some, gaps;
  VectorXd y(4000);
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const double t = static_cast<double>(k) / 200;
    all.push_back(t);
    y[k] = std::sin(3 * t) + 0.01 * random.normal();
  }
  std::vector<Eigen::Index> kept, most;
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    if (k % 4 != 3) {
      some.push_back(all[static_cast<std::size_t>(k)]);
      kept.push_back(k);
    }
    if (k % 100 != 50) {
      gaps.push_back(all[static_cast<std::size_t>(k)]);
      most.push_back(k);
    }
  }
  ThirdDifferences differences;
  differences.add(some, y(kept));
  EXPECT_EQ(differences.count, some.size() - 3);
  EXPECT_NEAR(differences.sd(), 0.01, 0.0006);
  // single gaps among equal spacing are left out, as ever
  ThirdDifferences among;
  among.add(gaps, y(most));
  EXPECT_EQ(among.count, gaps.size() - 3 - 3 * 40);
}

}  // namespace
