#include "score/discovery_score.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "support/scratch_folder.h"
#include "validation/labels_and_verdicts.h"

namespace hidden {
namespace {

TEST(Judge, ARightNameWithItsAmplitude) {
  Json verdict = verdictOf("named", Json::array({effectOf("visc", "structure", 0.99, 0.34, 0.02)}),
                           Json::array({"visc"}));
  verdict["gap"] = {{"held_out",
                     {{"gap_closed", 0.99},
                      {"rmse_after_deg", 0.51},
                      {"rmse_expected_deg", 0.54},
                      {"noise_floor_deg", 0.5}}}};
  verdict["wall_s"] = 12.5;
  const Outcome o = judge("a", labelOf("single", Json::array({truthOf("visc", 0.3)})), verdict);
  EXPECT_TRUE(o.firstIsRight && o.classHasTruth && o.allNamed && o.claims && o.unqualified);
  EXPECT_FALSE(o.confidentlyWrong() || o.namesStructure);
  EXPECT_NEAR(o.z.value(), 2, 1e-12);
  EXPECT_NEAR(o.gapClosed.value(), 0.99, 1e-12);
  EXPECT_NEAR(o.overFloor.value(), 1.02, 1e-12);
  EXPECT_NEAR(o.expectedOverFloor.value(), 1.08, 1e-12);
  EXPECT_NEAR(o.seconds.value(), 12.5, 1e-12);
  verdict["processor_s"] = 9;  // says more where the machine is shared
  EXPECT_EQ(judge("a", labelOf("single", Json::array({truthOf("visc", 0.3)})), verdict).seconds, 9);
}

TEST(Judge, WhatIsSaidToBeTooSmallAndWhatIsOnlyASurrogate) {
  Json truth = truthOf("visc", 0.3);
  truth["amplitude"] = -0.3;
  const Json label = labelOf("single", Json::array({truth}));
  Json verdict = verdictOf("none", Json::array());
  EXPECT_TRUE(judge("a", label, verdict).detectable);  // it says nothing
  verdict["undetectable_below"] = {{"visc", 0.31}, {"drag", 0.1}};
  EXPECT_FALSE(judge("a", label, verdict).detectable);
  verdict["undetectable_below"]["visc"] = 0.29;
  EXPECT_TRUE(judge("a", label, verdict).detectable);

  const Json effects = Json::array({effectOf("visc", "structure", 0.99, 0.34, 0.02)});
  EXPECT_TRUE(judge("a", label, verdictOf("named", effects)).firstIsRight);
  EXPECT_FALSE(judge("a", label, verdictOf("unknown", effects)).firstIsRight);
}

TEST(Judge, UnitsAndOtherNamesOfTheSameAmplitude) {
  const Json label = labelOf(
      "single", Json::array({{{"id", "wrap_TRI"},
                              {"readings", Json::array({{{"name", "dr"}, {"value", 0.003}},
                                                        {{"name", "factor"}, {"value", 1.2}}})}}}));
  const auto zOf = [&](const std::string& name, double value, double sd, const std::string& unit) {
    return judge(
               "a", label,
               verdictOf("named",
                         Json::array({effectOf("wrap_TRI", "geometry", 1, value, sd, name, unit)})))
        .z.value();
  };
  EXPECT_NEAR(zOf("dr", 4, 0.5, "mm"), 2, 1e-9);
  EXPECT_NEAR(zOf("factor", 1.1, 0.1, ""), -1, 1e-9);
  EXPECT_NEAR(zOf("wrap_TRI factor", 1.1, 0.1, ""), -1, 1e-9);  // a path's last word
  EXPECT_NEAR(zOf("wrap_TRI.dr", 0.004, 0.0005, "m"), 2, 1e-9);
  EXPECT_NEAR(zOf("unheard of", 0.002, 0.001, "m"), -1, 1e-9);  // then it is the first reading
}

TEST(Judge, DeclaredEquivalentsAreRightButTellNoAmplitude) {
  const Outcome o =
      judge("a", labelOf("single", Json::array({truthOf("delay", 0.04, {"clock"})})),
            verdictOf("named", Json::array({effectOf("clock", "sensor", 0.97, 0.04)})));
  EXPECT_TRUE(o.firstIsRight && o.classHasTruth);
  EXPECT_FALSE(o.z.has_value());
}

TEST(Judge, EquivalentsAreAClassUntilAFollowUpTellsThem) {
  const Json label = labelOf("equivalents", Json::array({truthOf("delay", 0.04, {"clock"})}));
  const Json clock = Json::array({effectOf("clock", "sensor", 0.52)}),
             delay = Json::array({effectOf("delay", "input", 0.99)});
  const Outcome both = judge("s", label, verdictOf("ambiguous", clock, {"clock", "delay"}));
  EXPECT_TRUE(both.asClass && both.firstIsRight);
  EXPECT_FALSE(both.uniquelyRight || both.firstIsTrue);
  const Outcome alone = judge("s", label, verdictOf("named", delay, {"delay"}));
  EXPECT_TRUE(alone.uniquelyRight && alone.firstIsTrue);
  EXPECT_FALSE(alone.asClass);
  // the twin, and the truth with a rival, are not the one right name
  EXPECT_FALSE(judge("s", label, verdictOf("named", clock, {"clock"})).uniquelyRight);
  EXPECT_FALSE(judge("s", label, verdictOf("ambiguous", delay, {"delay", "tau"})).uniquelyRight);
  EXPECT_FALSE(judge("s", label, verdictOf("named", delay, {"delay", "tau"})).uniquelyRight);
}

TEST(Score, ComparesProbabilitiesWithTheShareThatIsRight) {
  std::vector<Outcome> outcomes(8);
  for (std::size_t i = 0; i < 4; ++i) {
    outcomes[i].probability = 0.96;
    outcomes[i].firstIsTrue = i > 0;
  }
  for (std::size_t i = 4; i < 6; ++i) {
    outcomes[i].probability = 0.5;
    outcomes[i].firstIsTrue = i == 4;
  }
  outcomes[6].probability = 0.99;  // no name of the catalogue could be right
  outcomes[6].suite = "out";
  const Calibration c = score(outcomes).calibration;
  EXPECT_EQ(c.n, 6);
  ASSERT_EQ(c.bins.size(), 2U);
  EXPECT_NEAR(c.bins[1].probability, 0.96, 1e-12);
  EXPECT_NEAR(c.bins[1].right, 0.75, 1e-12);
  EXPECT_NEAR(c.error, 4 * 0.21 / 6, 1e-12);
}

// Of n names with one probability p the share that is right scatters by √(p(1 − p)/n), whose mean
// size is √(2/π) of that.
TEST(Score, SaysWhatChanceAloneMakesOfTheCalibrationError) {
  std::vector<Outcome> outcomes(100);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    outcomes[i].probability = 0.75;
    outcomes[i].firstIsTrue = i < 75;
  }
  const Calibration c = score(outcomes).calibration;
  EXPECT_NEAR(c.error, 0, 1e-12);
  const double sd = std::sqrt(0.75 * 0.25 / 100);
  EXPECT_NEAR(c.chance, std::sqrt(2 / std::numbers::pi) * sd, 0.1 * sd);
  EXPECT_NEAR(c.chanceHighest, 1.96 * sd, 0.15 * sd);
}

TEST(Judge, AWrongNameWithTheTruthInItsClassIsNotConfidentlyWrong) {
  const Json label = labelOf("single", Json::array({truthOf("visc", 0.3)}));
  const Json effects = Json::array({effectOf("coulomb", "structure", 0.96)});
  const Outcome in = judge("a", label, verdictOf("ambiguous", effects, {"coulomb", "visc"}));
  const Outcome outside = judge("a", label, verdictOf("named", effects, Json::array({"coulomb"})));
  EXPECT_TRUE(in.classHasTruth && !in.confidentlyWrong() && !in.firstIsRight && !in.unqualified);
  EXPECT_TRUE(outside.confidentlyWrong());
  const Json doubtful = Json::array({effectOf("coulomb", "structure", 0.94)});
  EXPECT_FALSE(judge("a", label, verdictOf("named", doubtful)).confidentlyWrong());
}

TEST(Judge, AParameterErrorThatIsCalledAStructure) {
  const Json label = labelOf("parameter", Json::array({truthOf("Fmax_TRI", -0.25, {"gain_TRI"})}));
  const auto structural = [&](const char* id, const char* kind) {
    return judge("a", label, verdictOf("named", Json::array({effectOf(id, kind, 0.5)})))
        .namesStructure;
  };
  EXPECT_TRUE(structural("visc", "structure"));
  EXPECT_FALSE(structural("Fmax_BIC", "parameter"));
  EXPECT_FALSE(structural("gain_TRI", "input"));
}

TEST(Judge, TwoEffectsNeedBothNames) {
  const Json label = labelOf("two", Json::array({truthOf("visc", 0.3), truthOf("payload", 0.5)}));
  const auto both = [&](const Json& effects) {
    return judge("a", label, verdictOf("named", effects)).allNamed;
  };
  EXPECT_FALSE(both(Json::array({effectOf("visc", "structure", 1)})));
  EXPECT_TRUE(
      both(Json::array({effectOf("payload", "structure", 1), effectOf("visc", "structure", 1)})));
}

TEST(Judge, SeveralNamesWithoutRivalsAreUnqualified) {
  const Json label = labelOf("out", Json::array({truthOf("cable_1", 0.04)}));
  const Json effects =
      Json::array({effectOf("gain_1", "sensor", 1), effectOf("I_1", "parameter", 1)});
  EXPECT_TRUE(judge("a", label, verdictOf("named", effects, {"gain_1", "I_1"})).unqualified);
  Json vetoed = verdictOf("named", effects, {"gain_1", "I_1"});
  vetoed["probability_vetoed"] = true;
  EXPECT_FALSE(judge("a", label, vetoed).unqualified);
  EXPECT_FALSE(
      judge("a", label, verdictOf("ambiguous", effects, {"gain_1", "I_1", "m_1"})).unqualified);
  EXPECT_FALSE(
      judge("a", label, verdictOf("named", effects, {"gain_1", "I_1", "m_1"})).unqualified);
}

TEST(Judge, NoneAndNumericalClaimNothing) {
  for (const char* word : {"none", "numerical"}) {
    const Outcome o = judge("a", labelOf("null", Json::array()), verdictOf(word, Json::array()));
    EXPECT_FALSE(o.claims) << word;
  }
  EXPECT_TRUE(
      judge("a", labelOf("null", Json::array()), verdictOf("unknown", Json::array())).claims);
}

const Row& rowOf(const Score& score, const std::string& metric) {
  for (const Row& row : score.rows) {
    if (row.metric == metric) return row;
  }
  throw std::runtime_error("no row " + metric);
}

TEST(Score, CountsMissesAndMissingVerdicts) {
  std::vector<Outcome> outcomes;
  const Json visc = labelOf("single", Json::array({truthOf("visc", 0.3)}));
  for (int i = 0; i < 9; ++i) {
    outcomes.push_back(
        judge("r" + std::to_string(i), visc,
              verdictOf("named", Json::array({effectOf("visc", "structure", 0.99, 0.3, 0.01)}))));
  }
  outcomes.push_back(judge("lost", visc, Json()));
  outcomes.push_back(
      judge("quiet", labelOf("null", Json::array()), verdictOf("none", Json::array())));
  outcomes.push_back(judge("odd", labelOf("out", Json::array({truthOf("tremor", 1)})),
                           verdictOf("unknown", Json::array())));
  const Score s = score(outcomes);
  const Row& right = rowOf(s, "right name first, clean EMG, full size");
  EXPECT_EQ(right.k, 9);
  EXPECT_EQ(right.n, 10);
  EXPECT_FALSE(right.met);
  ASSERT_EQ(right.misses.size(), 1u);
  EXPECT_THAT(right.misses[0],
              testing::HasSubstr("lost (single, size 1, EMG noise 0): visc; said: no verdict"));
  EXPECT_EQ(rowOf(s, "false alarms on null data").k, 0);
  EXPECT_TRUE(rowOf(s, "false alarms on null data").met);
  EXPECT_EQ(rowOf(s, "out of catalogue: no unqualified name").k, 1);
  EXPECT_EQ(rowOf(s, "two effects: both named").n, 0);
  EXPECT_FALSE(rowOf(s, "95 % interval covers the truth").met);  // 9 of 9 covers too much
  EXPECT_EQ(rowOf(s, "parameter within 2 sd of the truth").k, 9);
  EXPECT_THAT(s.asMarkdown(),
              testing::HasSubstr("| 9 of 10 | 90.0 % | 59.6–98.2 % | ≥ 97 % | no |"));
  EXPECT_EQ(s.asJson()["shares"][2]["misses"].size(), 1u);
}

// Of 100, a target of 90 % leaves 90 ± 3 to chance; of 4 the bound is 3.6 − 1.2.
TEST(Score, SaysWhatChanceMakesOfATarget) {
  Row row;
  row.bound = 0.9;
  const auto within = [&](int k, int n) {
    row.k = k;
    row.n = n;
    return row.within(2);
  };
  EXPECT_TRUE(within(84, 100) && within(100, 100) && within(3, 4) && within(0, 0));
  EXPECT_FALSE(within(83, 100) || within(2, 4));
  row.bound = 0.02;
  row.atMost = true;
  EXPECT_TRUE(within(0, 6) && within(1, 24) && within(4, 100));
  EXPECT_FALSE(within(1, 6) || within(2, 24) || within(5, 100));

  // of 16 values 8 ± 2 are on the right side of their median
  Spread spread;
  spread.bound = 1;
  spread.atMost = true;
  spread.values.assign(16, 2.0);
  std::fill_n(spread.values.begin(), 4, 0.5);
  EXPECT_TRUE(spread.within(2));
  spread.values[3] = 2;
  EXPECT_FALSE(spread.within(2));
  spread.atMost = false;
  EXPECT_TRUE(spread.within(2));

  // of four or fewer, whose count tells nothing, the median misses by less than half
  for (const std::size_t count : {1u, 2u, 4u}) {
    spread.atMost = false;
    spread.values.assign(count, 0.6);
    EXPECT_FALSE(spread.within(2)) << count;
    spread.values.assign(count, 0.7);
    EXPECT_TRUE(spread.within(2)) << count;
    spread.atMost = true;
    spread.values.assign(count, 1.6);
    EXPECT_FALSE(spread.within(2)) << count;
    spread.values.assign(count, 1.4);
    EXPECT_TRUE(spread.within(2)) << count;
  }
  spread.values.clear();
  EXPECT_TRUE(spread.within(2));
}

TEST(Judge, ALabelWithoutASizeLeavesTheEstimateAlone) {
  const Json label =
      labelOf("single", Json::array({{{"id", "visc"}, {"readings", Json::array()}}}));
  const Outcome o =
      judge("a", label, verdictOf("named", Json::array({effectOf("visc", "structure", 0.99)})));
  EXPECT_TRUE(o.firstIsRight);
  EXPECT_FALSE(o.z.has_value());
}

TEST(Score, ReadsFoldersAndSaysWhichFileIsBroken) {
  const support::ScratchFolder folder;
  const auto write = [&](const std::string& name, const std::string& text) {
    const auto file = folder.path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  };
  write("labels/x.json", labelOf("null", Json::array()).dump());
  write("verdicts/x/verdict.json", verdictOf("none", Json::array()).dump());
  write("verdicts/x/summary.json", R"({"wall_s": 3})");
  const auto outcomes = readOutcomes(folder.path() / "labels", folder.path() / "verdicts");
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_TRUE(outcomes[0].hasVerdict);
  EXPECT_EQ(outcomes[0].seconds.value(), 3);
  write("verdicts/x/verdict.json", "{");
  try {
    readOutcomes(folder.path() / "labels", folder.path() / "verdicts");
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("verdict.json"));
  }
  EXPECT_THROW(readOutcomes(folder.path() / "nowhere", folder.path()), std::runtime_error);
}

}  // namespace
}  // namespace hidden
