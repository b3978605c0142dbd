#include "score/hard_suites.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "generator/data_set.h"
#include "generator/open_loop_trial.h"

namespace hidden {
namespace {

const std::string root = FISHERHILL_SOURCE_DIR;

const ElbowNumbers& shippedElbow() {
  static const ElbowNumbers numbers = readElbow(root + "/models/elbow8.osim");
  return numbers;
}

DataSetPlan planOf(const std::string& suite, std::uint64_t seed) {
  DataSetPlan plan;
  plan.suite = suite, plan.seed = seed;
  return plan;
}

TEST(FarSuite, HidesNothingInOneOfFourSetsAndEverythingInTurn) {
  int nothing = 0, parameters = 0;
  std::set<std::string> effects;
  for (std::uint64_t seed = 800; seed < 896; ++seed) {
    const DataSetPlan plan = planOf("far", seed);
    const std::string kind = hides(plan);
    nothing += kind == "null";
    parameters += kind == "parameter";
    const auto chosen = chosenEffects(plan);
    ASSERT_EQ(chosen.size(), kind == "null" ? 0u : 1u);
    for (const std::string& id : chosen) {
      EXPECT_EQ(hiddenEffect(id).kind == "parameter", kind == "parameter") << id;
      EXPECT_TRUE(hiddenEffect(id).inCatalogue) << id;
      effects.insert(id);
    }
  }
  EXPECT_EQ(nothing, 24);
  EXPECT_EQ(parameters, 24);
  EXPECT_EQ(effects.size(), 25u + 7u);
}

TEST(FarSuite, AnEffectThatIsNamedSaysWhatIsHidden) {
  DataSetPlan plan = planOf("far", 800);
  plan.effects = {"Fmax_TRI"};
  EXPECT_EQ(hides(plan), "parameter");
  plan.effects = {"visc"};
  EXPECT_EQ(hides(plan), "single");
  EXPECT_EQ(chosenEffects(plan), plan.effects);
  plan.effects = {"tremor"};
  EXPECT_THROW(chosenEffects(plan), std::invalid_argument);
}

// Played again without anybody, the pulses make the same motion; no two muscles get the same;
// nothing balances the start; trials end at either end of the range, at rest and moving.
TEST(FarSuite, NobodySteersItsTrials) {
  Truth truth;
  truth.numbers = shippedElbow();
  const TrueElbow elbow(truth.numbers, truth.chain, truth.extras);
  TrialPlan plan;
  int made = 0, slow = 0, fast = 0;
  double lowest = 180, highest = 0, firstLow = 180, firstHigh = 0, unbalanced = 0;
  for (std::uint64_t seed = 0; seed < 40 && made < 12; ++seed) {
    RandomNumbers random(seed, 3);
    Trial trial;
    try {
      trial = makeOpenLoopTrial(truth, plan, random);
    } catch (const std::runtime_error&) {
      continue;
    }
    ++made;
    ASSERT_EQ(trial.angle.size(), 451u);
    ASSERT_EQ(trial.measured_deg.size(), 451u);
    const double q0 = trial.angle.front() / degree, q1 = trial.angle.back() / degree;
    firstLow = std::min(firstLow, q0), firstHigh = std::max(firstHigh, q0);
    lowest = std::min(lowest, q1), highest = std::max(highest, q1);
    const double speed = std::abs(trial.angle[450] - trial.angle[449]) / degree * plan.rate;
    (speed < 30 ? slow : fast) += 1;
    unbalanced = std::max(unbalanced, std::abs(elbow.startTorque(trial.truth, trial.angle[0])));
    for (const double q : trial.angle) {
      ASSERT_GT(q, -12 * degree);
      ASSERT_LT(q, 140 * degree);
    }
    EXPECT_NE(trial.recorded[200][4], trial.recorded[200][5]);
    if (made > 2) continue;
    const auto again = replayed(truth, trial.truth, trial.angle.front(), 1e-10);
    for (std::size_t k = 0; k < again.size(); ++k) EXPECT_NEAR(again[k], trial.angle[k], 1e-6);
  }
  EXPECT_EQ(made, 12);
  EXPECT_LT(firstLow, 40);
  EXPECT_GT(firstHigh, 90);
  EXPECT_LT(lowest, 50);
  EXPECT_GT(highest, 95);
  EXPECT_GT(slow, 0);
  EXPECT_GT(fast, 0);
  EXPECT_GT(unbalanced, 0.5);
}

TEST(FarSuite, TheLabelSaysWhoItIs) {
  const DataSet set = makeDataSet(shippedElbow(), planOf("far", 801));
  EXPECT_EQ(set.label["suite"], "far");
  EXPECT_EQ(set.label["hides"], "single");
  EXPECT_FALSE(set.label.contains("violation"));
  ASSERT_EQ(set.trials.size(), 4u);
  EXPECT_EQ(set.label["nuisance_factors"]["forearm.mass"], 1);
  EXPECT_EQ(set.label["nuisance_factors"]["activation.time"], 1);
  double square = 0;
  std::set<double> factors;
  for (const auto& [name, factor] : set.label["nuisance_factors"].items()) {
    if (!name.ends_with("max_isometric_force")) continue;
    square += std::pow(std::log(factor.get<double>()), 2);
    factors.insert(factor.get<double>());
    EXPECT_LE(std::abs(std::log(factor.get<double>())), 2.5 * 0.12);
  }
  EXPECT_EQ(factors.size(), 8u);  // each muscle by itself
  EXPECT_GT(std::sqrt(square / 8), 0.04);
  for (const auto& trial : set.label["strength"]) EXPECT_LE(trial["nominal_rms_deg"], 40);
}

TEST(ViolatedSuite, GoesThroughTenViolationsInThreeVersions) {
  std::set<std::pair<std::string, std::string>> seen;
  for (std::uint64_t seed = 900; seed < 930; ++seed) {
    const DataSetPlan plan = planOf("violated", seed);
    seen.emplace(chosenViolation(plan).id, hides(plan));
    EXPECT_EQ(chosenEffects(plan).size(), hides(plan) == "null" ? 0u : 1u);
  }
  EXPECT_EQ(seen.size(), 30u);
  DataSetPlan plan = planOf("violated", 900);
  plan.violation = "weather";
  EXPECT_THROW(chosenViolation(plan), std::invalid_argument);
}

// An angle that is known: what each laboratory makes of it.
class Violated : public testing::Test {
 protected:
  // the distances of what is written down from the angle [deg], NaN where nothing is
  std::vector<double> errorsOf(const std::string& id, Trial* kept = nullptr) {
    TrialPlan plan = planFor(violation(id), {});
    Truth truth;
    Trial trial;
    const auto rows = static_cast<std::size_t>(std::lround(plan.duration * plan.rate)) + 1;
    for (std::size_t k = 0; k < rows; ++k) {
      const double t = static_cast<double>(k) / plan.rate;
      trial.truth.times.push_back(t);
      trial.angle.push_back(1 + 0.4 * std::sin(2 * t));
      std::array<double, 8> emg{};
      emg.fill(0.1 + (k / 50 % 2 == 1 ? 0.05 : 0.0));
      trial.truth.emg.push_back(emg);
    }
    trial.recorded = trial.truth.emg;
    RandomNumbers random(11, 0);
    measure(truth, plan, trial, random);
    violate(violation(id), truth, plan, trial, random);
    std::vector<double> errors;
    for (std::size_t k = 0; k < trial.angle.size(); ++k) {
      errors.push_back(trial.measured_deg[k] - trial.angle[k] / degree);
    }
    if (kept) *kept = trial;
    return errors;
  }
  static double meanOf(const std::vector<double>& x) {
    double sum = 0;
    for (const double v : x) sum += v;
    return sum / static_cast<double>(x.size());
  }
  static double sd(const std::vector<double>& x, std::size_t lag = 0) {
    double sum = 0;
    for (std::size_t k = lag; k < x.size(); ++k) sum += x[k] * x[k - lag];
    return std::sqrt(std::abs(sum) / static_cast<double>(x.size() - lag));
  }
};

TEST_F(Violated, NoiseIsCorrelatedHeavyOrHasOutliers) {
  const auto correlated = errorsOf("correlated_noise");
  EXPECT_NEAR(sd(correlated), 0.5, 0.12);  // some 50 independent values
  EXPECT_GT(sd(correlated, 1), 0.45 * sd(correlated) / 0.5);
  const auto heavy = errorsOf("heavy_tails");
  const auto beyond = [&](const std::vector<double>& x, double bound) {
    return std::count_if(x.begin(), x.end(), [&](double e) { return std::abs(e) > bound; });
  };
  // of 451: more than 3 deviations off 6.3 are expected, of a normal's 1.2; yet half of them are
  // within 0.22 deg, where of a normal's 0.34
  EXPECT_GT(beyond(heavy, 1.5), 3);
  EXPECT_LT(beyond(heavy, 0.22), 270);
  EXPECT_GT(beyond(heavy, 0.22), 180);
  const auto outliers = errorsOf("outliers");
  EXPECT_GT(beyond(outliers, 8), 8);  // 22.5 expected
  EXPECT_LT(beyond(outliers, 8), 40);
  EXPECT_LT(beyond(outliers, 12), 1);
}

TEST_F(Violated, TheSensorRoundsDriftsOrLags) {
  Trial trial;
  errorsOf("quantised", &trial);
  for (const double y : trial.measured_deg) EXPECT_EQ(y, std::round(y));
  const auto drift = errorsOf("drift");
  const std::vector<double> late(drift.end() - 100, drift.end());
  EXPECT_NEAR(std::abs(meanOf(late)), 0.89, 0.2);
  EXPECT_NEAR(meanOf({drift.begin(), drift.begin() + 50}), 0, 0.3);
  // 30 ms of 0.8 rad/s at the zero crossings are 1.4 deg
  const auto lag = errorsOf("lag", &trial);
  double against = 0, square = 0;
  for (std::size_t k = 30; k < lag.size(); ++k) {
    const double speed = 0.8 * std::cos(2 * trial.truth.times[k]) / degree;
    against += lag[k] * speed, square += speed * speed;
  }
  EXPECT_NEAR(against / square, -0.03, 0.004);
}

TEST_F(Violated, SamplesAreMissingInBlocks) {
  Trial trial;
  errorsOf("gaps", &trial);
  int missing = 0, blocks = 0;
  for (std::size_t k = 0; k < 451; ++k) {
    if (!std::isnan(trial.measured_deg[k])) continue;
    ++missing;
    blocks += !std::isnan(trial.measured_deg[k - 1]);
  }
  EXPECT_NEAR(missing, 91, 1);
  EXPECT_GT(blocks, 1);
  EXPECT_LT(blocks, 10);
  EXPECT_FALSE(std::isnan(trial.measured_deg[0]));
  EXPECT_THAT(asTable({"t", trial}, "t"), testing::HasSubstr("\tnan\n"));
}

TEST_F(Violated, TheTrialStartsInMotion) {
  Trial trial;
  const auto errors = errorsOf("moving_start", &trial);
  ASSERT_EQ(trial.angle.size(), 451u);
  EXPECT_EQ(trial.truth.times.front(), 0);
  EXPECT_EQ(trial.truth.times.size(), 451u);
  EXPECT_EQ(trial.recorded.size(), 451u);
  // 0.8·cos(2·0.3) rad/s at its fastest, at 0.3 s
  EXPECT_NEAR((trial.angle[1] - trial.angle[0]) * 100, 0.66, 0.02);
  EXPECT_NEAR(sd(errors), 0.5, 0.1);
}

TEST_F(Violated, TheEmgIsNoisyOrSlow) {
  EXPECT_EQ(planFor(violation("emg_noise"), {}).emgNoise, 0.1);
  EXPECT_EQ(planFor(violation("gaps"), {}).emgNoise, 0);
  Trial trial;
  errorsOf("slow_emg", &trial);
  EXPECT_EQ(trial.truth.emg[149][0], 0.1 + 0.0);
  // a jump of 0.05 takes some 0.1 s, and its middle stays where it is
  EXPECT_NEAR(trial.recorded[149][0], 0.125, 0.004);
  EXPECT_GT(trial.recorded[160][3], 0.138);
  EXPECT_LT(trial.recorded[139][3], 0.112);
}

TEST(HardSuites, NamingALagOfTheSensorIsRightWhereItLags) {
  Outcome o;
  o.name = "s1", o.suite = "violated", o.hides = "null", o.hasVerdict = true, o.verdict = "named";
  o.claims = o.confident = true;
  o.named = {"lag"};
  for (const auto& [violation, wrong] : {std::pair{"lag", 0}, std::pair{"gaps", 1}}) {
    o.violation = violation;
    const auto rows = hardRows({o});
    EXPECT_EQ(rows.front().alarms, wrong) << violation;
    EXPECT_EQ(rows.front().confidentlyWrong, wrong) << violation;
  }
}

TEST(HardSuites, AreCountedByThemselves) {
  const auto outcome = [](const std::string& suite, const std::string& kind, bool claims,
                          bool confident) {
    Outcome o;
    o.name = "s1", o.suite = suite, o.hides = kind, o.hasVerdict = true, o.verdict = "named";
    o.claims = claims, o.confident = confident;
    if (kind != "null") o.truth = {"visc"};
    return o;
  };
  std::vector<Outcome> outcomes = {
      outcome("null", "null", true, true),           outcome("far", "null", true, false),
      outcome("far", "single", true, true),          outcome("violated", "null", true, true),
      outcome("violated", "parameter", true, false), outcome("violated", "null", false, false)};
  outcomes[2].firstIsRight = outcomes[2].classHasTruth = true;
  outcomes[3].violation = outcomes[4].violation = "gaps";
  outcomes[4].namesStructure = true;
  outcomes[5].violation = "drift";
  const auto rows = hardRows(outcomes);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].kind, "far");
  EXPECT_EQ(rows[0].sets, 2);
  EXPECT_EQ(rows[0].alarms, 1);
  EXPECT_EQ(rows[0].right, 1);
  EXPECT_EQ(rows[0].confidentlyWrong, 0);
  EXPECT_EQ(rows[1].kind, "drift");
  EXPECT_EQ(rows[1].alarms, 0);
  EXPECT_EQ(rows[2].kind, "gaps");
  EXPECT_EQ(rows[2].alarms, 1);
  EXPECT_EQ(rows[2].structures, 1);
  EXPECT_EQ(rows[2].confidentlyWrong, 1);
  EXPECT_EQ(rows[2].wrong.size(), 2u);
  EXPECT_EQ(rows[3].kind, "violated");
  EXPECT_EQ(rows[3].sets, 3);
  EXPECT_THAT(hardTable(outcomes), testing::HasSubstr("| gaps | 2 | 1 of 2 ("));
  EXPECT_EQ(hardJson(outcomes)[3]["false_alarms"], 1);
  EXPECT_EQ(hardTable({outcomes[0]}), "");
}

// A label without "hides" is of an older suite, which hides what it is called.
TEST(HardSuites, TheLabelTellsWhatIsHidden) {
  const Json verdict = {{"verdict", "none"}, {"effects", Json::array()}};
  const Json old = {{"suite", "null"}, {"effects", Json::array()}};
  EXPECT_EQ(judge("a", old, verdict).hides, "null");
  EXPECT_FALSE(isHard(judge("a", old, verdict)));
  const Json violated = {{"suite", "violated"},
                         {"hides", "null"},
                         {"violation", {{"id", "gaps"}, {"what", "…"}}},
                         {"effects", Json::array()}};
  EXPECT_EQ(judge("b", violated, verdict).violation, "gaps");
  EXPECT_TRUE(isHard(judge("b", violated, verdict)));
}

}  // namespace
}  // namespace hidden
