#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "apps/ensemble/ensemble_runs.h"

// Under mpirun.
namespace {

using namespace ensemble_runs;
using support::runFisherHill;
using testing::HasSubstr;

#ifdef FISHERHILL_MPIRUN

Words ranks(int n) {
  const std::string leaks = "ASAN_OPTIONS=detect_leaks=0";  // Open MPI's own, in sanitized builds
  return {FISHERHILL_MPIRUN, "--oversubscribe", "--allow-run-as-root", "-x", leaks, "-n",
          std::to_string(n)};
}

TEST(EnsembleCommand, SameBytesWhateverTheRanks) {
  const ScratchFolder scratch;
  const std::string alone = (scratch / "alone").string();
  ASSERT_EQ(runEnsemble(alone, four).status, 0);
  for (const int n : {1, 2, 4}) {
    const std::string out = (scratch / std::to_string(n)).string();
    const Words threads = {"--threads", n == 2 ? "2" : "1"};
    const ProgramResult result = runEnsemble(out, with(four, threads), ranks(n));
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(summaryIn(out)["ranks"], n);
    EXPECT_EQ(resultsIn(out), resultsIn(alone));
  }
}

TEST(EnsembleCommand, RanksShareTheDataSets) {
  const ScratchFolder scratch;
  writeSets(scratch, 2);
  ASSERT_EQ(discoverSets(scratch, "alone", {}).status, 0);
  const ProgramResult result = discoverSets(scratch, "ranks", {}, ranks(2));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(contentOf(scratch / "ranks/verdicts.csv"), contentOf(scratch / "alone/verdicts.csv"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "ranks/verdicts/b/verdict.json"));
}

/// Whether a program lives that was started with this word.
bool isAlive(const std::string& word) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    if (contentOf(entry.path() / "cmdline").find(word) != std::string::npos) return true;
  }
  return false;
}

TEST(EnsembleCommand, CtrlCStopsEveryRankKeepsTheRowsAndTheSameCommandGoesOn) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string(), growing = out + "/unfinished.csv";
  const Words work = {"--parameters", "hand.mass", "--step", "0.02"};
  const Words many = with({"--draws", "100000"}, work), few = with({"--draws", "20"}, work);
  // Ctrl-C as soon as there are rows; mpirun hears it in a group of its own, as on a terminal
  const std::string untilRows =
      "set -m; \"$@\" & job=$!; for i in {1..1200}; do sleep 0.05; "
      "[ \"$(wc -l < \"$0\")\" -gt 40 ] && break; done 2>/dev/null; kill -INT $job; wait $job";
  const ProgramResult result =
      runEnsemble(out, many, with({"bash", "-c", untilRows, growing}, ranks(3)));
  EXPECT_NE(result.status, 0);
  EXPECT_THAT(result.err, HasSubstr("run the same command again to continue"));
  EXPECT_FALSE(isAlive(out));
  std::set<std::string> numbers;
  for (const std::string& line : linesOf(contentOf(growing))) numbers.insert(cells(line)[0]);
  std::size_t there = 0;
  for (int i = 0; i < 20; ++i) there += numbers.count(std::to_string(i));
  ASSERT_EQ(runEnsemble(out, few, ranks(2)).status, 0);
  EXPECT_EQ(summaryIn(out)["computed"], 20 - there);
  const std::string alone = (scratch / "alone").string();
  ASSERT_EQ(runEnsemble(alone, few).status, 0);
  EXPECT_EQ(resultsIn(out), resultsIn(alone));
}

TEST(EnsembleCommand, OnlyOneRankSaysWhatIsWrong) {
  const ScratchFolder scratch;
  for (const Words& more : {Words{"--draws", "0"}, Words{"--parameters", "nothing"}}) {
    const ProgramResult result = runEnsemble((scratch / "out").string(), more, ranks(3));
    EXPECT_EQ(result.status, 2);
    const auto lines = linesOf(result.err);
    EXPECT_EQ(std::count_if(lines.begin(), lines.end(),
                            [](const std::string& line) {
                              return line.starts_with("fisherhill ensemble: ");
                            }),
              1)
        << result.err;
  }
}

#endif

}  // namespace
