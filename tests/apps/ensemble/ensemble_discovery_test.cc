#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "apps/ensemble/ensemble_runs.h"

// Discovery over many data sets.
namespace {

using namespace ensemble_runs;
using support::runFisherHill;
using testing::HasSubstr;

TEST(EnsembleCommand, AsksOfEveryDataSetWhatDiscoverAsksOfOne) {
  const ScratchFolder scratch;
  writeSets(scratch, 2);
  const ProgramResult result = discoverSets(scratch, "out", {});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(linesOf(result.out).front().find("Of 2 data sets: "), 0u) << result.out;
  const auto lines = linesOf(contentOf(scratch / "out/verdicts.csv"));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "set,verdict,effects,probability,gap_closed_train,gap_closed_held_out");
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string name(1, static_cast<char>('a' + i));
    const ProgramResult alone = runFisherHill(
        with({"discover", model, (scratch / ("sets/" + name + "/train_1.sto")).string(), "--out",
              (scratch / ("alone_" + name)).string()},
             quick));
    ASSERT_EQ(alone.status, 0) << alone.err;
    auto one = nlohmann::json::parse(contentOf(scratch / ("alone_" + name + "/verdict.json")));
    auto many =
        nlohmann::json::parse(contentOf(scratch / ("out/verdicts/" + name + "/verdict.json")));
    for (const char* time : {"wall_s", "processor_s"}) {
      one.erase(time);
      many.erase(time);
    }
    EXPECT_EQ(one, many);
    EXPECT_EQ(lines[i + 1].find(name + "," + one["verdict"].get<std::string>() + ","), 0u);
  }
  // nothing is asked twice
  std::filesystem::remove_all(scratch / "out/verdicts");
  EXPECT_THAT(discoverSets(scratch, "out", {}).err, HasSubstr("verdicts.csv exists already"));
}

TEST(EnsembleCommand, DiscoveryGoesOnAfterAKillAndLooksAtNoSetTwice) {
  const ScratchFolder scratch;
  writeSets(scratch, 3);
  ASSERT_EQ(discoverSets(scratch, "whole", {}).status, 0);
  ProgramResult last;
  std::string before;
  for (int i = 0; i < 60; ++i) {
    last = discoverSets(scratch, "cut", {"--threads", "1"},
                        {"timeout", "-s", "KILL", std::to_string(0.25 * std::pow(1.6, i))});
    if (last.status != 137 || isDone((scratch / "cut").string())) break;
    const std::string growing = contentOf(scratch / "cut/unfinished.csv");
    EXPECT_TRUE(growing.starts_with(before));
    before = growing;
  }
  ASSERT_TRUE(isDone((scratch / "cut").string())) << last.err;
  EXPECT_EQ(contentOf(scratch / "cut/verdicts.csv"), contentOf(scratch / "whole/verdicts.csv"));
  const auto rows = linesOf(before).size();
  EXPECT_EQ(summaryIn((scratch / "cut").string())["computed"], 3 - (rows < 2 ? 0 : rows - 2));
}

}  // namespace
