#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "info/discovery/search/shorter_steps.h"
#include "support/drawn_oscillator.h"

namespace {

using namespace info::discover;
using Eigen::VectorXd;
using support::drawn;
using support::kOutput;
using support::optionsOfDrawn;

// As drawn(), with a simulation that changes by `error` deviations of σ_y at half the step.
class Coarse : public LinearDisagreement {
 public:
  Coarse(LinearDisagreement data, double error)
      : LinearDisagreement(std::move(data)), error_(error) {}
  VectorXd refinedOutputs(int trial, const VectorXd& values) const override {
    // the second of several trials changes most
    const double error = trial == 1 ? error_ : 0.5 * error_;
    return outputs(trial, values, {}).array() + error * kOutput;
  }

 private:
  double error_;
};

// Within a fit, too, and then nothing is asked any more.
TEST(Discover, StopsBeforeAnySimulation) {
  const LinearDisagreement data = drawn(5, 2, 1.1);
  Options options = optionsOfDrawn();
  int asked = 0, allowed = std::numeric_limits<int>::max();
  options.goOn = [&] { return ++asked <= allowed; };
  const Verdict whole = run(data, options);
  EXPECT_EQ(whole.reached, Stage::finished);
  const int needed = asked;
  ASSERT_GT(needed, 100);
  // every stop while the base model is fitted, some of the later ones
  const int base = needed / 6;
  for (allowed = 0; allowed < needed; allowed += allowed < base ? 1 : 1 + needed / 50) {
    asked = 0;
    const Verdict v = run(data, options);
    EXPECT_NE(v.reached, Stage::finished);
    EXPECT_EQ(asked, allowed + 1);
    EXPECT_THAT(v.sentence, testing::HasSubstr("Stopped before the end"));
    EXPECT_TRUE(v.effects.empty());
    EXPECT_TRUE(v.base.size() == 0 || v.base.allFinite());
  }
}

TEST(RunAtShorterSteps, HalvesTheStepUntilItNoLongerMattersOrIsTooShort) {
  std::optional<Coarse> data;
  std::vector<double> steps;
  // of second order: 0.4 deviations at 0.02, 0.1 at 0.01
  const auto attempt = [&](double step) {
    steps.push_back(step);
    data.emplace(drawn(5, 2, 1.1), 1000 * step * step);
    Options options;
    options.sds = kOutput;
    return Attempt{*data, options};
  };
  const SteppedVerdict found = runAtShorterSteps(attempt, 0.04, 0.003);
  EXPECT_EQ(steps, (std::vector<double>{0.04, 0.02, 0.01}));
  EXPECT_EQ(found.step, 0.01);
  EXPECT_NE(found.verdict.finding, Finding::numerical);
  EXPECT_NEAR(found.verdict.numericalError, 0.1, 1e-9);
  EXPECT_EQ(found.options.sds, kOutput);

  steps.clear();
  const SteppedVerdict tooShort = runAtShorterSteps(attempt, 0.04, 0.03);
  EXPECT_EQ(steps, (std::vector<double>{0.04, 0.02}));
  EXPECT_EQ(tooShort.verdict.finding, Finding::numerical);
  EXPECT_THAT(tooShort.verdict.sentence,
              testing::StartsWith("Halving the time step changes the simulation of trial 1 by 0.4 "
                                  "standard deviations of the measurement noise"));

  steps.clear();
  EXPECT_EQ(runAtShorterSteps(attempt, 0.04, HUGE_VAL).verdict.finding, Finding::numerical);
  EXPECT_EQ(steps.size(), 1U);
}

TEST(SearchTrials, HoldsOutTheLastTrialsAndTakesTheOneStepThatIsGiven) {
  std::optional<Coarse> data;
  std::vector<double> steps;
  const auto problemAt = [&](double step) -> const DiscoveryProblem& {
    steps.push_back(step);
    data.emplace(drawn(5, 2, 1.1), 1000 * step * step);
    return *data;
  };
  TrialSearch search{2, 1, {}, 0.02, 0.003, optionsOfDrawn()};
  search.options.heldOut = {0};  // is set anew
  const SteppedVerdict found = searchTrials(search, problemAt);
  EXPECT_EQ(found.options.heldOut, std::vector<int>{1});
  EXPECT_TRUE(found.verdict.heldOut);
  EXPECT_EQ(steps.front(), 0.02);
  const auto same = runAtShorterSteps(
      [&](double step) {
        Options options = optionsOfDrawn();
        options.heldOut = {1};
        return Attempt{problemAt(step), options};
      },
      0.02, 0.003);
  EXPECT_EQ(found.verdict.sentence, same.verdict.sentence);
  EXPECT_EQ(found.verdict.values, same.verdict.values);
  EXPECT_EQ(found.step, same.step);

  steps.clear();
  search.step = 0.04;  // too long, but asked for
  search.numHeldOut = 0;
  const SteppedVerdict given = searchTrials(search, problemAt);
  EXPECT_EQ(steps, std::vector<double>{0.04});
  EXPECT_EQ(given.verdict.finding, Finding::numerical);
  EXPECT_TRUE(given.options.heldOut.empty());
  // what was found with it is told, not trusted
  EXPECT_FALSE(given.verdict.effects.empty());
  EXPECT_EQ(given.verdict.probability, 0);
  EXPECT_THAT(given.verdict.sentence, testing::HasSubstr("use shorter steps. With these steps: "));
  search.options.concludesNumerical = false;
  const Verdict unfinished = run(*data, search.options);
  EXPECT_EQ(unfinished.finding, Finding::numerical);
  EXPECT_TRUE(unfinished.effects.empty());
}

TEST(SearchTrials, OnlyComparesTheNominalModelWhereThatIsAsked) {
  const LinearDisagreement data = drawn(5, 2, 1.1);
  std::vector<double> steps;
  const SteppedVerdict found = searchTrials({2, 1, {}, 0.02, 0.003, optionsOfDrawn(), true},
                                            [&](double step) -> const DiscoveryProblem& {
                                              steps.push_back(step);
                                              return data;
                                            });
  EXPECT_EQ(steps, std::vector<double>{0.02});
  EXPECT_EQ(found.step, 0.02);
  EXPECT_EQ(found.verdict.fits, 0);
  EXPECT_EQ(found.verdict.finding, Finding::unknown);
  EXPECT_TRUE(found.verdict.heldOut);
  EXPECT_EQ(found.options.heldOut, std::vector<int>{1});
  EXPECT_GT(found.wallSeconds, 0);
}

}  // namespace
