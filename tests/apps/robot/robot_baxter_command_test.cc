#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::ProgramResult;
using support::runFisherHill;
using testing::AllOf;
using testing::HasSubstr;

TEST(RobotBaxter, LearnsTheLengthInNineTrialsAndThenDoesTheTask) {
  const support::ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill({"robot", "baxter", "--out", out, "--seed", "1"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(support::contentOf(out + "/summary.json"));
  ASSERT_EQ(json["trials"].size(), 9u);
  for (const auto& trial : json["trials"]) {
    const double initial = trial["initial_m"];
    EXPECT_NEAR(trial["estimate_m"].get<double>(), 0.368, 0.015);
    EXPECT_EQ(trial["success_without_estimation"].get<bool>(), initial > 0.36 && initial < 0.40);
    EXPECT_TRUE(trial["success_with_estimation"].get<bool>()) << initial;
  }
  EXPECT_GT(json["cycle_ms"]["worst"].get<double>(), 0);
  EXPECT_GE(json["cycle_ms"]["worst"], json["cycle_ms"]["median"]);
  EXPECT_TRUE(json["deadline_misses"].is_number_integer());
  EXPECT_THAT(support::contentOf(out + "/task.csv"),
              HasSubstr("initial_m,estimate_m,success_without_estimation"));
  EXPECT_THAT(support::contentOf(out + "/estimates.csv"), HasSubstr("\n9,0.468,6,"));
  EXPECT_THAT(support::contentOf(out + "/samples.csv"), HasSubstr("\n1,6,"));
  EXPECT_THAT(support::contentOf(out + "/swing_success.svg"),
              AllOf(HasSubstr("<svg"), HasSubstr("<animate attributeName=\"cx\"")));
  EXPECT_THAT(support::contentOf(out + "/report.html"),
              AllOf(HasSubstr("Compare figure 6.3"), HasSubstr("Compare figure 6.4"),
                    HasSubstr("Compare figure 6.5"), HasSubstr("Compare figure 6.7"),
                    HasSubstr("Compare figure 6.8"), HasSubstr("table 6.1")));
}

TEST(RobotBaxter, GivesTheSameEstimatesFromTheSameSeed) {
  const auto estimate = [](const std::string& seed) {
    return nlohmann::json::parse(
        runFisherHill({"robot", "baxter", "--duration", "1.5", "--initial-length", "0.42", "--seed",
                       seed, "--json"})
            .out)["trials"];
  };
  EXPECT_EQ(estimate("3"), estimate("3"));
  EXPECT_NE(estimate("3"), estimate("4"));
}

TEST(RobotBaxter, RunsInThreadsAndPrintsItsDeadlines) {
  const ProgramResult result = runFisherHill(
      {"robot", "baxter", "--real-time", "--duration", "1", "--initial-length", "0.42"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("four threads in real time"),
                                HasSubstr("deadline_misses"), HasSubstr("cycle_ms.worst")));
}

TEST(RobotBaxter, EndsInRealTimeSoonAfterCtrlC) {
  const support::ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const auto begin = std::chrono::steady_clock::now();
  const ProgramResult result = support::runProgram(
      {"timeout", "--foreground", "--preserve-status", "--signal=INT", "3", FISHERHILL_PROGRAM,
       "robot", "baxter", "--real-time", "--duration", "30", "--out", out});
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(result.status, 130) << result.err;
  EXPECT_EQ(result.err, "fisherhill robot: interrupted; nothing was written\n");
  EXPECT_THAT(scratch.listing(), testing::IsEmpty());
  EXPECT_LT(taken.count(), 10);  // 3.2 s where nothing else runs
}

TEST(RobotBaxter, SaysWhyNothingWouldMoveWithoutATrackingBias) {
  const ProgramResult result = runFisherHill({"robot", "baxter", "--tracking-weight", "0"});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("Nothing would move"),
                                HasSubstr("--tracking-weight is 0, must be > 0")));
}

TEST(RobotBaxter, TellsWrongUseInOneLine) {
  const auto fails = [](std::vector<std::string> arguments, const std::string& message) {
    const ProgramResult result = runFisherHill(std::move(arguments));
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  fails({"robot", "baxter", "--payload", "-1"}, "--payload");
  fails({"robot", "baxter", "--duration", "nan"}, "duration");
  fails({"robot", "baxter", "--initial-length", "3"}, "--initial-length");
  fails({"robot", "baxter", "--window", "0.01"}, "window: 0.01 s, must be");
  fails({"robot", "baxter", "--discrete"}, "--discrete cannot be combined with baxter");
  fails({"robot", "suspended-mass", "--real-time"},
        "--real-time cannot be combined with suspended-mass");
}

}  // namespace
