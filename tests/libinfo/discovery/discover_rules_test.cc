#include <gtest/gtest.h>

#include <cmath>

#include "info/discovery/judgement/decide.h"

namespace {

using namespace info::discover;

// Made-up evidence over three structures and a parameter.
std::vector<Candidate> catalogue() {
  std::vector<Candidate> all(4);
  const char* ids[] = {"a", "b", "c", "p"};
  for (std::size_t i = 0; i < 4; ++i) {
    all[i].id = all[i].name = ids[i];
    all[i].quantities = {i};
    all[i].sds = {1};
  }
  all[2].equivalents = {"b"};
  all[3].kind = EffectKind::parameter;
  return all;
}
Judgement raced(std::vector<std::pair<std::vector<std::size_t>, double>> table,
                std::vector<std::size_t> chosen) {
  Judgement judgement;
  judgement.raced.emplace_back();
  for (auto& [effects, evidence] : table) {
    Finalist f;
    f.effects = effects;
    f.logEvidence = evidence;
    judgement.raced.push_back(f);
  }
  judgement.chosen = std::move(chosen);
  return judgement;
}

TEST(Decide, SaysNoneWhenTheBaseFitsAndNothingEarnedItsPlace) {
  const Decision d = decide(catalogue(), raced({{{0}, 3.0}}, {}), {});
  EXPECT_EQ(d.finding, Finding::none);
  EXPECT_TRUE(d.effects.empty());
}

TEST(Decide, SaysUnknownWhenTheBaseDoesNotFitAndNothingEarnedItsPlace) {
  Judgement j = raced({{{0}, 3.0}}, {});
  j.before.white = false;
  EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::unknown);
  j.before.white = true;
  j.latentBefore = 0.2;
  EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::unknown);
  j.latentBefore = 0;
  j.strangeBefore = true;
  EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::unknown);
}

TEST(Decide, SaysParameterWhenOneIsOffByMoreThanItsTolerance) {
  Judgement j = raced({{{0}, 3.0}}, {});
  j.priorZ = 3.2;
  EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::parameter);
  EXPECT_EQ(decide(catalogue(), raced({{{3}, 9.0}, {{0}, 2.0}}, {3}), {}).finding,
            Finding::parameter);
}

TEST(Decide, KeepsANameThatHeldOutTrialsShowWithOtherParameters) {
  Judgement j = raced({{{0}, 30.0}, {{1}, 20.0}}, {0});
  for (bool Judgement::*against : {&Judgement::strangeAfter, &Judgement::heldOutWorse}) {
    j.*against = true;
    j.replicated = false;
    EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::unknown);
    j.replicated = true;
    const Decision d = decide(catalogue(), j, {});
    EXPECT_EQ(d.finding, Finding::named);
    EXPECT_FALSE(d.surrogate);
    EXPECT_TRUE(d.vetoed);
    EXPECT_EQ(d.probability, 0);
    j.*against = false;
  }
  j.after.white = false;  // no excuse for this
  j.strangeAfter = true;
  EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::unknown);
}

TEST(Decide, NamesNothingThatExplainsNothing) {
  Judgement j = raced({{{0}, 30.0}, {{1}, 20.0}}, {0});
  j.explained = 0.06;
  EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::named);
  for (const double share : {0.04, 0.0, -2.0}) {
    j.explained = share;
    const Decision d = decide(catalogue(), j, {});
    EXPECT_EQ(d.finding, Finding::unknown) << share;
    EXPECT_TRUE(d.surrogate);
  }
  j.explained.reset();  // the base model's error is about that of the sensor
  EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::named);
}

TEST(Decide, SaysUnknownWhenALawFitsOnlyAtTheEdgeOfItsShape) {
  std::vector<Candidate> all = catalogue();
  all[0].quantities = {0, 4};
  Judgement j = raced({{{0}, 30.0}, {{1}, 20.0}}, {0});
  Estimate amplitude, form;
  amplitude.quantity = 0;
  form.quantity = 4;
  const auto found = [&] {
    j.raced[1].estimates = {amplitude, form};
    return decide(all, j, {});
  };
  EXPECT_EQ(found().finding, Finding::named);
  amplitude.atBound = true;  // strong, but that law
  EXPECT_EQ(found().finding, Finding::named);
  form.atBound = true;
  EXPECT_EQ(found().finding, Finding::unknown);
  EXPECT_TRUE(found().surrogate);
  j.raced[2].logEvidence = 28;  // a rival may be right
  EXPECT_EQ(found().finding, Finding::ambiguous);
}

TEST(Decide, NamesALeaderWithoutRivals) {
  const Decision d = decide(catalogue(), raced({{{0}, 30.0}, {{1}, 20.0}, {{3}, 10}}, {0}), {});
  EXPECT_EQ(d.finding, Finding::named);
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].candidate, 0U);
  EXPECT_DOUBLE_EQ(d.effects[0].logBayesFactor, 30);
  EXPECT_NEAR(d.probability, 1 / (1 + std::exp(-10.0) + std::exp(-20.0) + 4 * std::exp(-30.0)),
              1e-12);
}

TEST(Decide, CallsRivalsWithinTheClassAndDeclaredEquivalentsAmbiguous) {
  const Decision near = decide(catalogue(), raced({{{0}, 30.0}, {{1}, 26.0}}, {0}), {});
  EXPECT_EQ(near.finding, Finding::ambiguous);
  EXPECT_EQ(near.effects[0].equals, (std::vector<std::size_t>{0, 1}));
  EXPECT_FALSE(near.effects[0].exact);
  const Decision exact = decide(catalogue(), raced({{{2}, 30.0}, {{1}, 5.0}}, {2}), {});
  EXPECT_EQ(exact.finding, Finding::ambiguous);
  EXPECT_TRUE(exact.effects[0].exact);
}

TEST(Decide, GivesDeclaredEquivalentsTheSameProbability) {
  const double others = 4 * std::exp(-30.0);  // the base, once for every candidate
  const auto behind = [](double nats) {
    return decide(catalogue(), raced({{{2}, 30.0}, {{1}, 30.0 - nats}}, {2}), {}).probability;
  };
  EXPECT_NEAR(behind(0.7), 1 / (2 + others), 1e-12);
  EXPECT_NEAR(behind(4.5), 1 / (2 + others), 1e-12);
  EXPECT_NEAR(behind(10), 1 / (1 + std::exp(-10.0) + others), 1e-12);
  // one that was not raced is no less probable
  EXPECT_NEAR(decide(catalogue(), raced({{{2}, 30.0}}, {2}), {}).probability, 1 / (2 + others),
              1e-12);
  // a rival that is no declared equivalent has what its evidence gives it
  EXPECT_NEAR(decide(catalogue(), raced({{{0}, 30.0}, {{1}, 29.3}}, {0}), {}).probability,
              1 / (1 + std::exp(-0.7) + others), 1e-12);
}

TEST(Decide, ComparesEachOfSeveralEffectsInItsPlace) {
  const Decision d = decide(
      catalogue(), raced({{{0}, 30.0}, {{1}, 12.0}, {{0, 1}, 50.0}, {{0, 3}, 47.0}}, {0, 1}), {});
  EXPECT_EQ(d.finding, Finding::ambiguous);
  EXPECT_EQ(d.effects[0].equals, (std::vector<std::size_t>{0}));
  EXPECT_EQ(d.effects[1].equals, (std::vector<std::size_t>{1, 3}));
  EXPECT_DOUBLE_EQ(d.effects[0].logBayesFactor, 38);
}

TEST(Decide, CallsALeaderASurrogateWhereSomethingIsLeft) {
  for (int what = 0; what < 7; ++what) {
    Judgement j = raced({{{0}, 30.0}}, {0});
    if (what == 0) j.after.white = false;
    if (what == 1) j.after.independent = false;
    if (what == 2) j.latentAfter = 0.2;
    if (what == 3) j.heldOutWorse = true;
    if (what == 4) j.strangeAfter = true;
    if (what == 5) j.after.causeless = false;
    if (what == 6) j.nonparametricWins = true;
    const Decision d = decide(catalogue(), j, {});
    EXPECT_EQ(d.finding, Finding::unknown) << what;
    EXPECT_TRUE(d.surrogate);
    ASSERT_EQ(d.effects.size(), 1U);
    EXPECT_EQ(d.probability, 0);
    EXPECT_TRUE(std::isnan(d.effects[0].probability)) << what;
  }
}

// Tests that assume white noise of a known size mean little where the residual is neither.
TEST(Decide, NamesWithAReservationWhatCarriesOverThoughTheResidualIsNotNoise) {
  for (bool Adequacy::*noise : {&Adequacy::white, &Adequacy::sized})
    for (int what = 0; what < 5; ++what) {
      Judgement j = raced({{{0}, 30.0}}, {0});
      if (what == 0) j.after.white = false;
      if (what == 1) j.after.independent = false;
      if (what == 2) j.after.causeless = false;
      if (what == 3) j.strangeAfter = true;
      if (what == 4) j.nonparametricWins = true;
      const bool wasWhite = j.after.white;
      j.heldOutExplained = 0.99;
      if (wasWhite) {
        EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::unknown) << what;
      }
      j.after.*noise = false;
      const Decision d = decide(catalogue(), j, {});
      EXPECT_EQ(d.finding, Finding::named) << what;
      EXPECT_TRUE(d.reserved && d.vetoed && !d.surrogate) << what;
      EXPECT_EQ(d.probability, 0);
      for (const double share : {0.94, -1.0}) {
        j.heldOutExplained = share;
        EXPECT_EQ(decide(catalogue(), j, {}).finding, Finding::unknown) << what;
      }
      j.heldOutExplained.reset();  // nothing was held out, or nothing was to be explained
      EXPECT_TRUE(decide(catalogue(), j, {}).surrogate) << what;
      j.heldOutExplained = 0.99;
      j.heldOutWorse = true;  // evidence against it
      EXPECT_TRUE(decide(catalogue(), j, {}).surrogate) << what;
    }
  Judgement fits = raced({{{0}, 30.0}}, {0});
  fits.heldOutExplained = 0.99;
  EXPECT_FALSE(decide(catalogue(), fits, {}).reserved);
}

TEST(Decide, LetsInnovationsOfTheWrongSizeAndHeldOutTrialsFarOffOrVagueVetoTheProbability) {
  for (const int why : {0, 1, 2}) {
    Judgement j = raced({{{0}, 30.0}}, {0});
    j.after.sized = why != 0;
    j.heldOutFarOff = why == 1;
    j.heldOutVague = why == 2;
    const Decision d = decide(catalogue(), j, {});
    EXPECT_EQ(d.finding, Finding::named);
    EXPECT_TRUE(d.vetoed);
    EXPECT_EQ(d.probability, 0);
  }
}

TEST(Adequacy, KnowsTheChiSquareDistribution) {
  EXPECT_NEAR(chiSquareTail(31.41043284423092, 20), 0.05, 1e-10);
  EXPECT_NEAR(chiSquareTail(10.82756617078829, 1), 0.001, 1e-10);
  // Wilson and Hilferty's approximation
  const double a = 2 / (9 * 1300.0);
  EXPECT_NEAR(chiSquareQuantile(0.001, 1300), 1300 * std::pow(1 - a + 3.090232 * std::sqrt(a), 3),
              0.05);
}

TEST(ExcessError, IsClosedByWhatIsLeftAboveTheFloor) {
  ExcessError excess;
  excess.nominal = 10;
  excess.calibrated = 5;
  excess.after = 2;
  excess.floor = 1;
  explainExcess(excess);
  EXPECT_DOUBLE_EQ(*excess.closedFromCalibrated, 1 - 3.0 / 24);
  EXPECT_DOUBLE_EQ(*excess.closedFromNominal, 1 - 3.0 / 99);
  excess.calibrated = 1.02;
  explainExcess(excess);
  EXPECT_FALSE(excess.closedFromCalibrated);
}

TEST(BenjaminiHochberg, KeepsTheRightOnes) {
  std::vector<Score> scores(4);
  // p = 0.0027, 0.0164, 0.0455, 0.317; thresholds 0.0125, 0.025, 0.0375, 0.05
  scores[0].z = 2;
  scores[1].z = -3;
  scores[2].z = 1;
  scores[3].z = 2.4;
  benjaminiHochberg(scores, 0.05);
  EXPECT_FALSE(scores[0].significant);
  EXPECT_TRUE(scores[1].significant);
  EXPECT_FALSE(scores[2].significant);
  EXPECT_TRUE(scores[3].significant);
}

}  // namespace
