#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "apps/ensemble/ensemble_runs.h"

// Runs that are killed, interrupted and gone on with.
namespace {

using namespace ensemble_runs;
using support::runFisherHill;
using testing::HasSubstr;

TEST(EnsembleCommand, GoesOnAfterAKillAndGivesTheSameBytes) {
  const ScratchFolder scratch;
  const std::string whole = (scratch / "whole").string(), cut = (scratch / "cut").string();
  const Words work = {"--draws", "3000", "--parameters", "hand.mass", "--step", "0.02"};
  ASSERT_EQ(runEnsemble(whole, work).status, 0);
  int kills = 0;
  ProgramResult last;
  for (int i = 0; i < 40; ++i) {
    const std::string limit = std::to_string(0.04 * std::pow(1.4, i));
    last = runEnsemble(cut, with(work, {"--threads", "1"}), {"timeout", "-s", "KILL", limit});
    if (last.status != 137) break;
    ++kills;
    if (isDone(cut)) break;  // killed as it was about to end
    // a kill in the middle of a row: the file ends anywhere
    const std::string growing = cut + "/unfinished.csv";
    const std::string content = contentOf(growing);
    if (i % 2 == 0 && content.size() > 400) {
      std::filesystem::resize_file(growing, content.size() - 11);
    }
  }
  ASSERT_TRUE(isDone(cut)) << last.err;
  EXPECT_GT(kills, 0);
  EXPECT_EQ(resultsIn(cut), resultsIn(whole));
  EXPECT_LT(summaryIn(cut)["computed"].get<int>(), 3000);
  EXPECT_FALSE(std::filesystem::exists(cut + "/unfinished.csv"));
}

TEST(EnsembleCommand, RefusesToGoOnWithOtherSettings) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const Words many = {"--draws", "100000", "--parameters", "hand.mass"};
  ASSERT_EQ(endedAtWork(out, many, "KILL").status, 137);
  const std::string before = contentOf(out + "/unfinished.csv");
  for (const auto& [more, words] : std::vector<std::pair<Words, std::string>>{
           {{"--seed", "2"}, "seed is 1 there, 2 here"},
           {{"--step", "0.02"}, "step_s is 0.01 there, 0.02 here"},
           {{"--spread", "2"}, "(parameters is [[\"hand.mass\""},
           {{"--observe", "elbow_flexion.speed"}, "observe is [] there, [\"elbow_flexion.speed\"]"},
           {{"--sobol"}, "scheme is \"draws\" there, \"sobol\" here"}}) {
    const ProgramResult result = runEnsemble(out, with(many, more));
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(linesOf(result.err).size(), 1u) << result.err;
    EXPECT_THAT(result.err, HasSubstr(words));
  }
  EXPECT_EQ(contentOf(out + "/unfinished.csv"), before);
  // fewer draws are not other settings: what is there already is taken
  const ProgramResult less = runEnsemble(out, {"--draws", "3", "--parameters", "hand.mass"});
  EXPECT_EQ(less.status, 0) << less.err;
  EXPECT_EQ(summaryIn(out)["computed"], 0);
}

TEST(EnsembleCommand, GoesOnAfterAKillWhileItNamesTheResults) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string(), growing = out + "/unfinished.csv";
  const Words many = {"--draws", "100000", "--parameters", "hand.mass"};
  const Words few = {"--draws", "3", "--parameters", "hand.mass"};
  ASSERT_EQ(endedAtWork(out, many, "KILL").status, 137);
  const std::string rows = contentOf(growing);
  ASSERT_EQ(runEnsemble(out, few).status, 0);
  const std::string results = resultsIn(out);
  // some have their names, and the rows are there still
  std::ofstream(growing) << rows;
  std::filesystem::remove(out + "/summary.json");
  const ProgramResult other = runEnsemble(out, with(few, {"--seed", "2"}));
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("seed is 1 there, 2 here"));
  EXPECT_EQ(resultsIn(out), results);
  const ProgramResult again = runEnsemble(out, few);
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(resultsIn(out), results);
  EXPECT_FALSE(std::filesystem::exists(growing));
  // without them nothing is overwritten
  EXPECT_EQ(runEnsemble(out, few).status, 2);
}

TEST(EnsembleCommand, CtrlCKeepsWhatIsDoneAndSaysHowToGoOn) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const Words many = {"--draws", "100000", "--parameters", "hand.mass"};
  const ProgramResult result = endedAtWork(out, many, "INT");
  EXPECT_THAT(result.err, HasSubstr("run the same command again to continue"));
  EXPECT_THAT(result.err, HasSubstr("interrupted; finished parts are in " + out));
  EXPECT_GT(linesOf(contentOf(out + "/unfinished.csv")).size(), 2u);
}

}  // namespace
