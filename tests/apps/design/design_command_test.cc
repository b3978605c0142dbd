#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/design/design_command.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using designing::design;
using designing::designSummary;
using support::ProgramResult;
using support::ScratchFolder;
using testing::HasSubstr;

TEST(DesignCommand, WritesATrialThatReplaysAsPredicted) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "design").string();
  const ProgramResult result = design(out);
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json summary = designSummary(out);
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
  EXPECT_LT(designSummary(played)["rms_error_deg"], 1e-6);
  EXPECT_LT(designSummary(played)["energy_error_J"], 0.1);
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

// One after the other, each adds; uncertain excitations need both groups.
TEST(DesignCommand, RanksExperimentsOfADynamometer) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "design").string();
  const std::vector<std::string> names = {"BRA.max_isometric_force", "TRIlong.max_isometric_force"};
  const ProgramResult result =
      support::runFisherHill({"design",        "models/elbow8.osim",
                              "--dynamometer", "elbow_flexion",
                              "--parameters",  names[0] + "," + names[1],
                              "--angles",      "40deg,100deg",
                              "--speeds",      "60deg",
                              "--efforts",     "50",
                              "--kinds",       "isometric,isokinetic,passive",
                              "--experiments", "3",
                              "--step",        "0.01",
                              "--out",         out});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json summary = designSummary(out);
  EXPECT_EQ(summary["candidates"], 2 * 2 + 2 * (1 + 2));
  ASSERT_EQ(summary["experiments"].size(), 3u);
  for (const std::string& name : names) {
    double before = summary["bound_before"][name];
    for (const auto& one : summary["experiments"]) {
      EXPECT_LE(one["bounds"][name], before * (1 + 1e-12));
      before = one["bounds"][name];
    }
    EXPECT_EQ(summary["bound_after"][name], before);
    EXPECT_LT(before, 0.5 * summary["bound_before"][name].get<double>()) << name;
  }
  // none twice
  EXPECT_NE(summary["experiments"][0]["instruction"], summary["experiments"][1]["instruction"]);
  EXPECT_THAT(summary["experiments"][0]["instruction"].get<std::string>(), HasSubstr("50 % MVC"));
  // where excitations are uncertain, each group has to show what it can do
  const ProgramResult unsure = support::runFisherHill(
      {"design", "models/elbow8.osim", "--dynamometer", "elbow_flexion", "--parameters",
       "BIClong.max_isometric_force,TRIlong.max_isometric_force", "--nuisance", "emg.*.gain",
       "--angles", "40deg,100deg", "--speeds", "60deg", "--efforts", "50", "--experiments", "4",
       "--step", "0.01", "--json"});
  ASSERT_EQ(unsure.status, 0) << unsure.err;
  const auto wide = nlohmann::json::parse(unsure.out);
  std::set<std::string> groups;
  for (const auto& one : wide["experiments"]) groups.insert(one["muscles"]);
  EXPECT_TRUE(groups.contains("flexors") && groups.contains("extensors"));
  EXPECT_GT(wide["bound_after"]["TRIlong.max_isometric_force"], summary["bound_after"][names[1]]);
}

// Bounds after the first experiment are those that sensitivity has for its trial.
class FirstExperiment : public testing::TestWithParam<std::string> {};
TEST_P(FirstExperiment, HasTheBoundsThatSensitivityFinds) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "design").string(), told = (scratch / "told").string();
  const std::string kind = GetParam();
  const std::string names = "BRA.max_isometric_force,TRIlong.optimal_fiber_length";
  const bool isFree = kind == "isotonic";
  std::vector<std::string> command = {"design",        "models/elbow8.osim",
                                      "--dynamometer", "elbow_flexion",
                                      "--parameters",  names,
                                      "--angles",      "40deg,100deg",
                                      "--kinds",       kind,
                                      "--experiments", "1",
                                      "--step",        "0.01",
                                      "--out",         out};
  if (isFree) command.insert(command.end(), {"--noise", "0.7"});
  const ProgramResult result = support::runFisherHill(command);
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json first = designSummary(out)["experiments"][0];
  EXPECT_EQ(first["kind"], kind);
  command = {"sensitivity",
             "models/elbow8.osim",
             out + "/experiment_1.csv",
             "--parameters",
             names,
             "--observe",
             isFree ? "elbow_flexion=0.7deg" : "elbow_flexion.moment=0.5",
             "--step",
             "0.01",
             "--out",
             told};
  if (!isFree) command.insert(command.end(), {"--prescribe", "elbow_flexion"});
  const ProgramResult sensitivity = support::runFisherHill(command);
  ASSERT_EQ(sensitivity.status, 0) << sensitivity.err;
  const nlohmann::json found = designSummary(told);
  ASSERT_EQ(found["parameters"].size(), 2u);
  for (const auto& one : found["parameters"]) {
    const double bound = first["bounds"][one["name"].get<std::string>()];
    EXPECT_NEAR(one["bound_joint"].get<double>() / bound, 1, 1e-9) << one["name"];
  }
}
INSTANTIATE_TEST_SUITE_P(OfADynamometer, FirstExperiment,
                         testing::Values("isometric", "isokinetic", "passive", "release",
                                         "isotonic"),
                         [](const auto& kind) { return kind.param; });

// Let go against the torque in its file, the joint moves as its column says; instructions name the
// torque, and the angle is the only thing that is missing.
TEST(DesignCommand, WritesIsotonicTrialsThatReplay) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "design").string();
  const ProgramResult result = support::runFisherHill(
      {"design", "models/elbow8.osim", "--dynamometer", "elbow_flexion", "--parameters",
       "BRA.max_isometric_force", "--kinds", "isotonic,release", "--loads", "60", "--efforts", "40",
       "--releases", "5deg,15deg", "--experiments", "20", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json summary = designSummary(out);
  EXPECT_EQ(summary["candidates"], 2 * 4 * (1 + 2));
  int isotonic = 0;
  for (std::size_t n = 0; n < summary["experiments"].size(); ++n) {
    const nlohmann::json one = summary["experiments"][n];
    if (one["kind"] != "isotonic") {
      EXPECT_THAT(one["instruction"].get<std::string>(), HasSubstr("after 1 s turn to"));
      continue;
    }
    ++isotonic;
    EXPECT_THAT(one["instruction"].get<std::string>(),
                HasSubstr(one["torque_Nm"] < 0 ? "pushes the angle down" : "pushes the angle up"));
    const ProgramResult replay =
        support::runFisherHill({"replay", "models/elbow8.osim",
                                out + "/experiment_" + std::to_string(n + 1) + ".csv", "--json"});
    ASSERT_EQ(replay.status, 0) << replay.err;
    EXPECT_LT(nlohmann::json::parse(replay.out)["rms_error_deg"], 1e-6);
  }
  EXPECT_GT(isotonic, 4);
  std::ifstream file(out + "/report.html");
  const std::string report((std::istreambuf_iterator<char>(file)), {});
  EXPECT_THAT(report, HasSubstr("replace it by the recorded one"));
}

TEST(DesignCommand, RefusesExperimentsThatADynamometerCannotDo) {
  const auto refused = [](std::vector<std::string> more, const char* words) {
    std::vector<std::string> command = {"design", "models/elbow8.osim", "--parameters",
                                        "BRA.max_isometric_force"};
    command.insert(command.end(), more.begin(), more.end());
    const ProgramResult result = support::runFisherHill(command);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(words));
  };
  refused({}, "either TRIAL or --dynamometer is required");
  refused({"emg_data/curl_slow.sto", "--dynamometer", "elbow_flexion"}, "and not both");
  refused({"--dynamometer", "elbow_flexion", "--priors"}, "cannot be combined with --dynamometer");
  refused({"--dynamometer", "knee"}, "knee");
  refused({"--dynamometer", "elbow_flexion", "--angles", "400deg"}, "is outside the range");
  refused({"--dynamometer", "elbow_flexion", "--angles", "x"}, "--angles: ");
  refused({"--dynamometer", "elbow_flexion", "--speeds", "-1deg"},
          "--speeds: -0.01745 rad/s (-1 deg/s), must be > 0");
  refused({"--dynamometer", "elbow_flexion", "--efforts", "120"}, "at most 100");
  refused({"--dynamometer", "elbow_flexion", "--efforts", "0.5"}, "must be > 1");
  refused({"--dynamometer", "elbow_flexion", "--speeds", "1deg"}, "these would take");
  refused({"--dynamometer", "elbow_flexion", "--angles", "60deg,62deg", "--speeds", "120deg"},
          "these would take 0.0167 s");
  refused({"--dynamometer", "elbow_flexion", "--coordinate", "elbow_flexion"}, "--coordinate");
  refused({"--dynamometer", "elbow_flexion", "--lock", "elbow_flexion=60deg"},
          "must not be locked");
  refused({"emg_data/curl_slow.sto", "--angles", "60deg"}, "--dynamometer");
  refused({"--dynamometer", "elbow_flexion", "--kinds", "isotnic"}, "isotnic");
  refused({"--dynamometer", "elbow_flexion", "--loads", "100"}, "below 100");
  refused({"--dynamometer", "elbow_flexion", "--releases", "0deg"},
          "releases: 0 rad (0 deg), must be > 0");
  refused({"--dynamometer", "elbow_flexion", "--release-speed", "300deg"}, "at least 8 samples");
  refused({"--dynamometer", "elbow_flexion", "--speeds", "501deg"},
          "at most the largest speed, 8.727 rad/s (500 deg/s)");
  refused({"--dynamometer", "elbow_flexion", "--kinds", "isometric", "--loads", "50"},
          "loads: must have isotonic among the kinds of experiments");
  // what only a search uses, or a measured angle
  for (const char* option : {"--iterations", "--generations", "--candidates", "--torque",
                             "--torque-rate", "--excitation-max", "--excitation-rate", "--knots"}) {
    refused({"--dynamometer", "elbow_flexion", option, "1"},
            (std::string(option) + " cannot be combined with --dynamometer").c_str());
  }
  refused({"--dynamometer", "elbow_flexion", "--criterion", "A", "--initial", "elbow_flexion=1"},
          "--criterion, --initial cannot be combined with --dynamometer");
  refused({"--dynamometer", "elbow_flexion", "--kinds", "isometric", "--noise", "1"},
          "--noise: the angle is measured in isotonic experiments only");
  refused({"--dynamometer", "elbow_flexion", "--moment-noise", "0"}, "must be > 0");
}

TEST(DesignCommand, TellsTwoEffectsApart) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "design").string();
  const ProgramResult result = support::runFisherHill(
      {"design", "models/elbow8.osim", "emg_data/curl_slow.sto", "--separate", "delay,clock",
       "--size", "delay=0.03", "--candidates", "8", "--generations", "1", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json summary = designSummary(out);
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
  EXPECT_LT(designSummary(played)["rms_error_deg"], 0.01);  // cubics between rows
}

}  // namespace
