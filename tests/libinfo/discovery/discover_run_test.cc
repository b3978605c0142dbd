#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <optional>

#include "info/discovery/search/shorter_steps.h"
#include "support/drawn_oscillator.h"

namespace {

using namespace info::discover;
using Eigen::Index;
using Eigen::VectorXd;
using support::drawn;
using support::kLatent;
using support::kOutput;
using support::kTime;
using support::optionsOfDrawn;

TEST(Discover, FindsTheForceOnALinearOscillator) {
  const LinearDisagreement data = drawn(5, 2, 1.1);
  Options options = optionsOfDrawn();
  int calls = 0;
  options.progress = [&](const Progress& p) {
    EXPECT_GE(p.fraction, 0);
    EXPECT_LE(p.fraction, 1);
    return ++calls > 0;
  };
  const Verdict v = run(data, options);
  EXPECT_EQ(v.reached, Stage::finished);
  EXPECT_GT(calls, 5);
  ASSERT_EQ(v.effects.size(), 1U);
  // push and shove are the same force; the one-sided prior is worth log 2
  EXPECT_EQ(v.finding, Finding::ambiguous);
  EXPECT_NEAR(v.effects[0].estimates[0].value, 2, 4 * v.effects[0].estimates[0].sd);
  EXPECT_NEAR(v.latentSizeAfter, kLatent, 0.1);

  // the band about the simulation: the model is linear, so a deviation more moves it by dy/dA·σ_A
  const Estimate& push = v.effects[0].estimates[0];
  Eigen::VectorXd values = v.values;
  values[static_cast<Eigen::Index>(push.quantity)] += push.sd;
  const Eigen::VectorXd moved = data.outputs(0, values, {}) - data.outputs(0, v.values, {});
  const Eigen::VectorXd expected = (moved.array().square() + kOutput * kOutput).sqrt();
  EXPECT_NEAR((predictedSd(data, v, 0) - expected).cwiseAbs().maxCoeff(), 0, 1e-12);
  EXPECT_GT(moved.cwiseAbs().maxCoeff(), 0.1 * kOutput);
}

TEST(Discover, FindsATrialStrangeThatWasHeldOutAndIsOfAnotherModel) {
  LinearDisagreement data(3, 80);
  VectorXd truth = nominalValues(data);
  data.draw(4, truth, kOutput, 0, kTime);
  Options options;
  options.sds = kOutput;
  options.latentScale = 1;
  options.latentTime = kTime;
  options.heldOut = {2};
  const Verdict same = run(data, options);
  EXPECT_EQ(same.finding, Finding::none);
  EXPECT_NEAR(same.heldOutBefore.value().meanSquare, 1, 0.5);
  truth[1] = 1;
  LinearDisagreement other(3, 80);
  other.draw(4, truth, kOutput, 0, kTime);
  data.measure(2, other.measured(2));
  const Verdict strange = run(data, options);
  EXPECT_EQ(strange.finding, Finding::unknown);
  EXPECT_GT(strange.heldOutBefore.value().meanSquare, strange.heldOutBefore->highest);
}

/// Counts how often a trial is predicted.
struct Counted : LinearDisagreement {
  using LinearDisagreement::LinearDisagreement;
  Prediction predict(int trial, const VectorXd& values, const VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    ++asked[static_cast<std::size_t>(trial)];
    return LinearDisagreement::predict(trial, values, latent, wanted, latentToo);
  }
  mutable std::array<std::atomic<int>, 3> asked = {};
};

TEST(Discover, FitsHeldOutTrialsOnceWhereNothingIsMissing) {
  Counted data(3, 80);
  data.draw(4, nominalValues(data), kOutput, 0, kTime);
  Options options;
  options.sds = kOutput;
  options.latentScale = 1;
  options.latentTime = kTime;
  options.heldOut = {2};
  EXPECT_EQ(run(data, options).finding, Finding::none);
  EXPECT_GT(data.asked[2], 0);
  EXPECT_LE(data.asked[2], 18);  // 14; 24 if the base were fitted a second time as what was chosen
}

// A held-out trial whose push is a fifth larger, which no fit of the others knows of.
TEST(Discover, GivesANameNoProbabilityWhereWhatWasHeldOutIsFarOff) {
  const auto asked = [](double other) {
    LinearDisagreement data(3, 80);
    VectorXd truth = nominalValues(data);
    truth[1] = 1;
    data.draw(4, truth, kOutput, 0, kTime);
    LinearDisagreement more(3, 80);
    truth[1] = other;
    more.draw(4, truth, kOutput, 0, kTime);
    data.measure(2, more.measured(2));
    Options options;
    options.sds = kOutput;
    options.latentScale = 1;
    options.latentTime = kTime;
    options.heldOut = {2};
    return run(data, options);
  };
  const Verdict same = asked(1);
  EXPECT_EQ(same.finding, Finding::ambiguous);  // push or shove
  EXPECT_FALSE(same.vetoed);
  EXPECT_GT(same.probability, 0);
  EXPECT_EQ(same.sentence.find("held-out"), std::string::npos);
  const Verdict off = asked(1.2);
  EXPECT_EQ(off.finding, Finding::ambiguous);
  EXPECT_TRUE(off.vetoed);
  EXPECT_EQ(off.probability, 0);
  EXPECT_NE(off.sentence.find("the held-out errors are larger than expected by chance"),
            std::string::npos)
      << off.sentence;
}

// Third differences take a noise that alternates, ±c, for √3.2 times as large.
TEST(Discover, RepeatsTheSearchWhereTheResidualIsSmallerThanTheNoiseWasEstimated) {
  LinearDisagreement data(3, 80);
  VectorXd truth = nominalValues(data);
  truth[1] = 1;
  data.draw(4, truth, 0.01 * kOutput, 0, kTime);
  for (int trial = 0; trial < 3; ++trial) {
    VectorXd y = data.measured(trial);
    for (Index k = 0; k < y.size(); ++k) y[k] += k % 2 == 0 ? kOutput : -kOutput;
    data.measure(trial, y);
  }
  Options options;
  options.judgeSamples = false;
  options.latentScale = 1;
  options.latentTime = kTime;
  const Verdict again = run(data, options);
  EXPECT_NEAR(again.noise.reduced, 1 / std::sqrt(3.2), 0.05);
  EXPECT_NEAR(again.sds.sd(0), kOutput, 0.1 * kOutput);
  EXPECT_THAT(again.sentence, testing::HasSubstr("repeated with 0.5"));
  options.overestimated = 0;
  const Verdict once = run(data, options);
  EXPECT_EQ(once.noise.reduced, 1);
  EXPECT_NEAR(once.sds.sd(0), std::sqrt(3.2) * kOutput, 0.1 * kOutput);
  EXPECT_LT(once.fits, again.fits);
  options.overestimated = Options().overestimated;
  options.sds = 2 * kOutput;  // told
  EXPECT_EQ(run(data, options).sds.sd(0), 2 * kOutput);
}

// A push so small that two trials do not carry it, but three do: asked a second time of all trials
// where the held-out one is off.
TEST(Discover, LooksOnceMoreWhereWhatWasHeldOutIsOff) {
  const auto with = [](double push) {
    LinearDisagreement data(3, 80);
    VectorXd truth = nominalValues(data);
    truth[1] = push;
    data.draw(4, truth, kOutput, 0, kTime);
    return data;
  };
  Options options;
  options.sds = kOutput;
  options.latentScale = 1;
  options.latentTime = kTime;
  options.latentTolerance = 0.1;
  options.heldOut = {2};
  const auto asked = [&](double push, double secondLook) {
    const LinearDisagreement data = with(push);
    options.secondLook = secondLook;
    return runAtShorterSteps([&](double) { return Attempt{data, options}; }, 0.01, 0.003).verdict;
  };
  const Verdict never = asked(0.0556, 0);
  EXPECT_EQ(never.finding, Finding::none);
  EXPECT_GT(never.heldOut->probability.value(), 0.05);
  const Verdict usual = asked(0.0556, 0.05);
  EXPECT_EQ(usual.finding, Finding::none);
  EXPECT_FALSE(usual.heldOutFitted);
  EXPECT_EQ(usual.sentence, never.sentence);

  const Verdict always = asked(0.0556, 1.01);
  EXPECT_EQ(always.finding, Finding::ambiguous);  // push, shove and bias are all one force
  EXPECT_TRUE(always.heldOutFitted);
  EXPECT_FALSE(always.heldOut.has_value());
  EXPECT_THAT(always.sentence, testing::HasSubstr("when the held-out trials were fitted as well"));
  EXPECT_GT(always.fits, never.fits);

  const Verdict nothing = asked(0.01, 1.01);
  EXPECT_EQ(nothing.finding, Finding::none);
  EXPECT_FALSE(nothing.heldOutFitted);
  EXPECT_TRUE(nothing.heldOut.has_value());
  EXPECT_EQ(nothing.sentence, asked(0.01, 0).sentence);  // not so far off that it would be told
}

TEST(Discover, StartsFromADraft) {
  const LinearDisagreement data = drawn(5, 2, 1.1);
  const Options options = optionsOfDrawn();
  WarmStart draft;
  const Verdict first = run(data, options, &draft);
  ASSERT_NE(draft, nullptr);
  const Verdict again = run(data, options, &draft);
  EXPECT_LT(again.fits, first.fits);
  EXPECT_EQ(again.finding, first.finding);
  ASSERT_EQ(again.effects.size(), 1U);
  EXPECT_NEAR(again.effects[0].estimates[0].value, first.effects[0].estimates[0].value,
              0.1 * first.effects[0].estimates[0].sd);
  EXPECT_NEAR(again.effects[0].logBayesFactor, first.effects[0].logBayesFactor, 0.2);
}

// As drawn(), but what is pushed cannot be simulated, or nothing can.
class Fragile : public LinearDisagreement {
 public:
  Fragile(LinearDisagreement data, bool always)
      : LinearDisagreement(std::move(data)), always_(always) {}
  Prediction predict(int trial, const VectorXd& values, const VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    Prediction p = LinearDisagreement::predict(trial, values, latent, wanted, latentToo);
    if (fails(values)) p.outputs.setConstant(std::nan(""));
    return p;
  }
  VectorXd outputs(int trial, const VectorXd& values, const VectorXd& latent) const override {
    VectorXd y = LinearDisagreement::outputs(trial, values, latent);
    if (fails(values)) y.setConstant(std::nan(""));
    return y;
  }

 private:
  bool fails(const VectorXd& values) const { return always_ || values[2] != 0; }
  bool always_;
};

TEST(Discover, GoesOnWithoutACandidateThatCannotBeSimulated) {
  const Verdict v = run(Fragile(drawn(5, 2, 1.1), false), optionsOfDrawn());
  EXPECT_EQ(v.reached, Stage::finished);
  ASSERT_EQ(v.effects.size(), 1U);
  EXPECT_EQ(v.effects[0].candidate, 0U);
  for (const Finalist& f : v.finalists) EXPECT_TRUE(std::isfinite(f.logEvidence));
}

TEST(Discover, SaysThatTheModelCannotBeSimulated) {
  Options options;
  options.sds = kOutput;
  EXPECT_THROW(run(Fragile(drawn(5, 2, 1.1), true), options), std::domain_error);
}

// As drawn(), but beyond a gain of 1.02, or a push of 1, it falls unless a force holds it.
class Falling : public LinearDisagreement {
 public:
  Falling(LinearDisagreement data, bool push) : LinearDisagreement(std::move(data)), push_(push) {}
  Prediction predict(int trial, const VectorXd& values, const VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    Prediction p = LinearDisagreement::predict(trial, values, latent, wanted, latentToo);
    if (falls(values, latent)) p.outputs.setConstant(std::nan(""));
    return p;
  }
  VectorXd outputs(int trial, const VectorXd& values, const VectorXd& latent) const override {
    VectorXd y = LinearDisagreement::outputs(trial, values, latent);
    if (falls(values, latent)) y.setConstant(std::nan(""));
    return y;
  }

 private:
  bool falls(const VectorXd& values, const VectorXd& latent) const {
    return (push_ ? values[1] + values[2] > 1 : values[0] > 1.02) &&
           !(latent.size() != 0 && latent.cwiseAbs().maxCoeff() > 0.3);
  }
  bool push_;
};

TEST(Discover, GoesOnWhereTheBaseModelStandsByItsLatentForceOnly) {
  const Verdict v = run(Falling(drawn(5, 2, 1.3), false), optionsOfDrawn());
  EXPECT_EQ(v.reached, Stage::finished);
  ASSERT_EQ(v.effects.size(), 1U);
  EXPECT_NEAR(v.values[0], 1.3, 0.1);
  EXPECT_NEAR(v.effects[0].estimates[0].value, 2, 4 * v.effects[0].estimates[0].sd);
}

// Without its force it stands nowhere with that push, whatever the other parameters are.
TEST(Discover, GoesOnWhereAnEffectStandsByTheLatentForceOnly) {
  const Verdict v = run(Falling(drawn(5, 2, 1.1), true), optionsOfDrawn());
  EXPECT_EQ(v.reached, Stage::finished);
  ASSERT_FALSE(v.effects.empty());
  EXPECT_LT(v.effects[0].candidate, 2U);  // push or shove
  EXPECT_NEAR(v.effects[0].estimates[0].value, 2, 4 * v.effects[0].estimates[0].sd);
}

TEST(Discover, StopsWhenToldTo) {
  const LinearDisagreement data = drawn(5, 2, 1.1);
  Options options;
  options.sds = kOutput;
  options.progress = [](const Progress& p) { return p.stage < Stage::race; };
  const Verdict v = run(data, options);
  EXPECT_EQ(v.reached, Stage::localise);
  EXPECT_EQ(v.base.size(), static_cast<Index>(data.quantities().size()));
  EXPECT_EQ(v.finalists.size(), 1U);  // the base
  EXPECT_FALSE(v.localisation.times.empty());
}

// What has been raced by then is told, with its evidence.
TEST(Discover, TellsWhatItHasRacedWhenItIsStopped) {
  const LinearDisagreement data = drawn(5, 2, 1.1);
  Options options;
  options.sds = kOutput;
  const Verdict whole = run(data, options);
  ASSERT_EQ(whole.effects.size(), 1U);
  options.progress = [](const Progress& p) { return p.stage < Stage::decide; };
  const Verdict v = run(data, options);
  EXPECT_NE(v.reached, Stage::finished);
  EXPECT_EQ(v.finding, Finding::none);
  EXPECT_TRUE(v.effects.empty());
  ASSERT_EQ(v.finalists.size(), whole.finalists.size());
  for (std::size_t i = 0; i < v.finalists.size(); ++i)
    EXPECT_EQ(v.finalists[i].logEvidence, whole.finalists[i].logEvidence);
  EXPECT_THAT(v.sentence, testing::HasSubstr("Stopped before the end"));
  EXPECT_THAT(v.sentence,
              testing::HasSubstr(data.candidates()[whole.effects[0].candidate].id + " leads"));
}

TEST(RunAtShorterSteps, GoesOnWhereTheModelCannotBeSimulatedAtALongStep) {
  std::optional<Fragile> data;
  std::vector<double> steps;
  const auto attempt = [&](double step) {
    steps.push_back(step);
    data.emplace(drawn(5, 2, 1.1), step > 0.015);
    Options options;
    options.sds = kOutput;
    return Attempt{*data, options};
  };
  EXPECT_EQ(runAtShorterSteps(attempt, 0.04, 0.003).step, 0.01);
  EXPECT_EQ(steps, (std::vector<double>{0.04, 0.02, 0.01}));
  EXPECT_THROW(runAtShorterSteps(attempt, 0.04, 0.03), std::domain_error);
}

}  // namespace
