// A slice of the blind benchmark (validation/discovery) for every day: data sets from the
// benchmark's own generators, verdicts of the engine, judged by the benchmark's scorer. What holds
// is the design's target less two binomial deviations, computed from the number of sets:
// Row::within and Spread::within of discovery_score.h. Of 8 single effects with a target of 97 %,
// for example, 7.76 − 2·√(8·0.97·0.03) = 6.8, so that 7 right names pass; of 6 null sets with 2 %,
// 0.12 + 2·√(6·0.02·0.98) = 0.8, so that none may be given a name. Every set must be counted.
#include <gtest/gtest.h>

#include <chrono>

#include "bio/model/units.h"
#include "discover/discover_verdict.h"
#include "generator/data_set.h"
#include "reduced/reduced_plan.h"
#include "robots/hidden_robots.h"
#include "score/discovery_score.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using hidden::Outcome;

// The program's verdict on a set of the reduced elbow, which no command reads from files, and what
// the scorer makes of it.
struct OnReducedElbow {
  nlohmann::ordered_json verdict;
  Outcome outcome;
};
OnReducedElbow verdictOnReducedElbow(const reduced::Plan& plan, bool leaveOut) {
  reduced::DataSet set = reduced::makeDataSet(plan);
  const std::vector<std::string> lacking = leaveOut ? set.explaining() : std::vector<std::string>{};
  const reduced::Elbow elbow(std::move(set.trials), lacking);
  info::discover::Options options;
  options.sds = set.recipe.outputNoise;
  options.latentTolerance = 0.02;
  options.heldOut = {plan.trials - 1};
  const auto begin = std::chrono::steady_clock::now();
  const info::discover::Verdict verdict = info::discover::run(elbow, options);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  app::DiscoverWording wording;
  wording.outputs = {{"elbow", "deg", bio::degreesPerRadian}};
  wording.axes = {{"elbow", "deg", bio::degreesPerRadian, "angle", "Torque [N·m]", "N·m"}};
  wording.unit = bio::degreesPerRadian;
  wording.errorEnd = "_deg";
  wording.inputs = "muscles";
  const std::string name = plan.suite + " " + std::to_string(plan.seed);
  const auto fitted = info::discover::fittedNumbers(elbow, verdict);
  OnReducedElbow result;
  result.verdict = app::verdictJson(
      {name, {}, elbow, wording, options, verdict, name, {}, taken.count(), taken.count(), fitted});
  result.outcome = hidden::judge(name, set.label, result.verdict);
  return result;
}
Outcome onReducedElbow(const reduced::Plan& plan) {
  return verdictOnReducedElbow(plan, false).outcome;
}

// The command's verdict on a set in files, the truth being read by the scorer alone.
Outcome byCommand(const support::ScratchFolder& scratch, std::vector<std::string> of) {
  const auto file = [&](const char* name) { return (scratch / "set" / name).string(); };
  of.insert(of.begin(), "discover");
  for (const char* trial : {"train_1.sto", "train_2.sto", "train_3.sto"}) of.push_back(file(trial));
  of.insert(of.end(),
            {"--hold-out", file("held_out.sto"), "--out", (scratch / "verdicts" / "set").string()});
  const auto result = support::runFisherHill(of);
  EXPECT_EQ(result.status, 0) << result.err;
  return hidden::readOutcomes(scratch / "labels", scratch / "verdicts").at(0);
}

Outcome onRobot(const hidden::RobotPlan& plan) {
  const support::ScratchFolder scratch;
  hidden::writeRobotDataSet(hidden::makeRobotDataSet(plan), hidden::robotKind(plan.system),
                            scratch / "set", scratch / "labels");
  return byCommand(scratch, {"--system", plan.system});
}

// All eight muscles; the data set's own model, where it brings one.
Outcome onElbow(const hidden::DataSetPlan& plan) {
  const support::ScratchFolder scratch;
  const std::filesystem::path shipped = std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim";
  hidden::writeDataSet(hidden::makeDataSet(hidden::readElbow(shipped), plan), shipped,
                       scratch / "set", scratch / "labels");
  const std::filesystem::path own = scratch / "set/model.osim";
  return byCommand(scratch, {std::filesystem::exists(own) ? own.string() : shipped.string()});
}

/// How many sets hide nothing, a wrong parameter only, or one effect.
struct Sets {
  int nothing = 0, parameter = 0, effect = 0;
};

/// A row without sets is within its target, so that the sets are counted here.
void expectCounted(const hidden::Score& score, const Sets& sets) {
  int nothing = 0, parameter = 0, effect = 0, all = 0;
  for (const hidden::Row& row : score.rows) {
    if (row.metric == "false alarms on null data") nothing += row.n;
    if (row.metric == "structure named when only parameters are wrong") parameter += row.n;
    if (row.metric.starts_with("right name first, ")) effect += row.n;
    if (row.metric == "confidently wrong") all += row.n;
  }
  EXPECT_EQ(nothing, sets.nothing);
  EXPECT_EQ(parameter, sets.parameter);
  EXPECT_EQ(effect, sets.effect + sets.parameter);
  EXPECT_EQ(all, sets.nothing + sets.parameter + sets.effect);
  for (const hidden::Spread& spread : score.spreads) {
    if (spread.metric == "time per data set") {
      EXPECT_EQ(std::ssize(spread.values), all);
    }
  }
}

void expectTargets(const std::vector<Outcome>& outcomes, const Sets& sets) {
  const hidden::Score score = hidden::score(outcomes);
  expectCounted(score, sets);
  for (const hidden::Row& row : score.rows) {
    EXPECT_TRUE(row.target == "–" || row.within(2)) << row.metric;
  }
  for (const hidden::Spread& spread : score.spreads) EXPECT_TRUE(spread.within(2)) << spread.metric;
  std::printf("%s", score.asMarkdown().c_str());
}

void expectTargetsOnReducedElbows(const std::string& suite, std::uint64_t first, int count) {
  std::vector<Outcome> outcomes;
  for (int i = 0; i < count; ++i) {
    reduced::Plan plan;
    plan.suite = suite;
    plan.seed = first + static_cast<std::uint64_t>(i);
    outcomes.push_back(onReducedElbow(plan));
  }
  expectTargets(outcomes, {.nothing = suite == "null" ? count : 0,
                           .parameter = suite == "parameter" ? count : 0,
                           .effect = suite == "single" ? count : 0});
}

void expectTargetsOnRobots(const std::string& system, std::uint64_t first, int single, int null) {
  std::vector<Outcome> outcomes;
  for (int i = 0; i < single + null; ++i) {
    hidden::RobotPlan plan;
    plan.system = system;
    plan.suite = i < single ? "single" : "null";
    plan.seed = first + static_cast<std::uint64_t>(i);
    outcomes.push_back(onRobot(plan));
  }
  expectTargets(outcomes, {.nothing = null, .effect = single});
}

TEST(DiscoverySlice, OfReducedElbowsWithNothingHidden) {
  expectTargetsOnReducedElbows("null", 45000, 6);
}
TEST(DiscoverySlice, OfReducedElbowsWithOneEffect) {
  expectTargetsOnReducedElbows("single", 45100, 8);
}
TEST(DiscoverySlice, OfReducedElbowsWithOneWrongParameter) {
  expectTargetsOnReducedElbows("parameter", 45200, 2);
}
// What was raced from the base's fit said "another muscle's optimal length, probability 1".
TEST(DiscoverySlice, AWrongParameterIsNotTakenForAnother) {
  reduced::Plan plan;
  plan.suite = "parameter";
  plan.seed = 13010;
  const Outcome outcome = onReducedElbow(plan);
  EXPECT_TRUE(outcome.claims);
  EXPECT_TRUE(outcome.classHasTruth);
  EXPECT_FALSE(outcome.confidentlyWrong());
}
// Joint limits that the catalogue lacks were "another wrap radius", with probability 1. A force
// that follows the angle alone explains more.
TEST(DiscoverySlice, WhatIsLeftOutOfTheCatalogueIsNotTakenForAnother) {
  reduced::Plan plan;
  plan.suite = "single";
  plan.effect = "limit";
  plan.seed = 13403;
  const auto json = verdictOnReducedElbow(plan, true).verdict;
  EXPECT_EQ(json.at("verdict"), "unknown");
  EXPECT_EQ(json.at("force_without_a_name").at("follows"), "angle");
  EXPECT_GT(json.at("force_without_a_name").at("nats_ahead_of_names"), 5);
}
TEST(DiscoverySlice, OfElbowsWithEightMuscles) {
  hidden::DataSetPlan nothing, visc, missing;
  nothing.suite = "null";
  visc.effects = {"visc"};
  missing.effects = {"missing_BRD"};
  nothing.seed = 45500, visc.seed = 45501, missing.seed = 45502;
  expectTargets({onElbow(nothing), onElbow(visc), onElbow(missing)}, {.nothing = 1, .effect = 2});
}
TEST(DiscoverySlice, OfDoublePendulums) {
  expectTargetsOnRobots("double-pendulum", 45300, 3, 1);
}
TEST(DiscoverySlice, OfSuspendedMasses) {
  expectTargetsOnRobots("suspended-mass", 45400, 3, 1);
}

}  // namespace
