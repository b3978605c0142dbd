#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::ProgramResult;
using support::ScratchFolder;
using testing::HasSubstr;

nlohmann::json summaryIn(const std::string& folder) {
  std::ifstream file(folder + "/summary.json");
  return nlohmann::json::parse(file);
}

ProgramResult design(const std::string& folder, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"design",
                                        "models/elbow8.osim",
                                        "emg_data/cocontraction.sto",
                                        "--parameters",
                                        "TRI.radius",
                                        "--candidates",
                                        "8",
                                        "--generations",
                                        "2",
                                        "--iterations",
                                        "0",
                                        "--out",
                                        folder};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return support::runFisherHill(arguments);
}

TEST(DesignCommand, WritesATrialThatReplaysAsPredicted) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "design").string();
  const ProgramResult result = design(out);
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json summary = summaryIn(out);
  const double before = summary["bound_before"]["TRI.radius"];
  const double after = summary["bound_after"]["TRI.radius"];
  EXPECT_GT(before, 0);
  EXPECT_LT(after, before);
  EXPECT_LE(summary["largest_torque_Nm"], 10);
  EXPECT_LE(summary["largest_torque_rate_Nm_per_s"], 50.001);
  EXPECT_GE(summary["lowest_deg"], 0);
  EXPECT_LE(summary["highest_deg"], 130);

  const std::string played = (scratch / "replay").string();
  const ProgramResult replay = support::runFisherHill(
      {"replay", "models/elbow8.osim", out + "/design.sto", "--out", played});
  ASSERT_EQ(replay.status, 0) << replay.err;
  EXPECT_LT(summaryIn(played)["rms_error_deg"], 1e-6);
  EXPECT_LT(summaryIn(played)["energy_error_J"], 0.1);
  const ProgramResult checked =
      support::runFisherHill({"check", "models/elbow8.osim", out + "/design.sto"});
  EXPECT_EQ(checked.status, 0) << checked.out;
}

TEST(DesignCommand, SaysNoWhenNothingBetterIsFound) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "design").string();
  const ProgramResult result = design(out, {"--range", "60deg,61deg"});
  EXPECT_EQ(result.status, 1) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("No experiment was found"));
}

TEST(DesignCommand, TellsTwoEffectsApart) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "design").string();
  const ProgramResult result = support::runFisherHill(
      {"design", "models/elbow8.osim", "emg_data/curl_slow.sto", "--separate", "delay,clock",
       "--size", "delay=0.03", "--candidates", "8", "--generations", "1", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json summary = summaryIn(out);
  EXPECT_EQ(summary["separates"], nlohmann::json({"delay", "clock"}));
  EXPECT_EQ(summary["size"]["delay"], 0.03);
  for (const char* id : {"delay", "clock"}) {
    const double before = summary["nats_before"][id], after = summary["nats_after"][id];
    EXPECT_GT(before, 0);
    EXPECT_GT(after, 2 * before) << id;
    EXPECT_NEAR(summary["bound_after"][id].get<double>(),
                summary["size"][id].get<double>() / std::sqrt(2 * after), 1e-9);
  }
  const std::string played = (scratch / "replay").string();
  const ProgramResult replay = support::runFisherHill(
      {"replay", "models/elbow8.osim", out + "/design.sto", "--out", played});
  ASSERT_EQ(replay.status, 0) << replay.err;
  EXPECT_LT(summaryIn(played)["rms_error_deg"], 0.01);  // cubics between rows
}

}  // namespace
