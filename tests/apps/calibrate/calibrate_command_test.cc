#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "support/replays.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

namespace {

using support::contentOf;
using support::linesOf;
using support::model;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using support::slow;
using testing::HasSubstr;

const std::string fast = "emg_data/curl_fast.sto";

TEST(CalibrateCommand, WritesTheModelTheSummaryAndTheReport) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill({"calibrate", model, slow, "--hold-out", fast,
                                              "--parameters", "TRI.radius,hand.mass", "--profile",
                                              "hand.mass", "--starts", "3", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(scratch.listing(),
              testing::UnorderedElementsAre("out", "out/calibrated.osim", "out/covariance.csv",
                                            "out/parameters.csv", "out/report.html",
                                            "out/reproduce.sh", "out/summary.json"));
  const auto json = nlohmann::json::parse(contentOf(out + "/summary.json"));
  EXPECT_EQ(json["inputs"].size(), 3u);
  EXPECT_LT(json["rmse_train_deg"].get<double>(),
            0.2 * json["rmse_train_before_deg"].get<double>());
  EXPECT_LT(json["rmse_held_out_deg"].get<double>(),
            json["rmse_held_out_before_deg"].get<double>());
  EXPECT_EQ(json["starts"], 6);  // three of them led by held models
  const auto& mass = json["estimates"]["hand.mass"];
  EXPECT_EQ(mass["unit"], "kg");
  EXPECT_EQ(mass["identifiable"], true);
  EXPECT_GT(mass["sd"].get<double>(), 0);
  EXPECT_LT(mass["profile_interval"][0].get<double>(), mass["value"].get<double>());
  EXPECT_EQ(json["correlation"].size(), 2u);
  const auto covariance = linesOf(contentOf(out + "/covariance.csv"));
  ASSERT_EQ(covariance.size(), 3u);
  EXPECT_EQ(covariance[0], "parameter,TRI.radius,hand.mass");
  const double variance = std::stod(covariance[2].substr(covariance[2].rfind(',') + 1));
  EXPECT_NEAR(variance, std::pow(mass["sd"].get<double>(), 2), 1e-6 * variance);

  const std::string report = contentOf(out + "/report.html");
  for (const char* title :
       {"Estimates and priors", "Correlations of the estimates", "Residuals",
        "Autocorrelation of the residuals", "Held-out trials", "Profile likelihood of hand.mass"}) {
    EXPECT_THAT(report, HasSubstr(title));
  }

  // the new model moves as the report says, and tells where it came from
  const ProgramResult replay = runFisherHill({"replay", out + "/calibrated.osim", slow, "--json"});
  ASSERT_EQ(replay.status, 0) << replay.err;
  EXPECT_NEAR(nlohmann::json::parse(replay.out)["rms_error_deg"].get<double>(),
              json["rmse_train_deg"].get<double>(), 1e-6);
  const std::string osim = contentOf(out + "/calibrated.osim");
  EXPECT_THAT(osim, HasSubstr("Calibrated by FisherHill"));
  for (const auto& input : json["inputs"]) {
    EXPECT_THAT(osim, HasSubstr(input["sha256"].get<std::string>()));
  }
  EXPECT_THAT(osim, HasSubstr("kg (was 0.5819)"));
}

// Starts that were estimated, and a step of its own, are the calibrated model's.
TEST(CalibrateCommand, ReplayOfTheCalibratedModelGivesItsFigures) {
  const ScratchFolder scratch;
  const auto calibrated = [&](const std::string& out, const std::string& parameters) {
    const ProgramResult result =
        runFisherHill({"calibrate", model, slow, "--hold-out", fast, "--parameters", parameters,
                       "--own-start", "--step", "0.05", "--out", out});
    EXPECT_EQ(result.status, 0) << result.err;
    const auto json = nlohmann::json::parse(contentOf(out + "/summary.json"));
    EXPECT_EQ(json["trials"].size(), 2u);
    support::expectReplaysAgree(out + "/calibrated.osim", json["trials"], 0.05);
    EXPECT_NEAR(json["trials"][0]["rmse_after_deg"].get<double>(),
                json["rmse_train_deg"].get<double>(), 1e-9);
    EXPECT_NEAR(json["trials"][1]["rmse_after_deg"].get<double>(),
                json["rmse_held_out_deg"].get<double>(), 1e-9);
    // as the fit itself has it
    const auto speed = json["estimates"]["initial.elbow_flexion.speed"]["value"].get<double>();
    EXPECT_NEAR(json["trials"][0]["start"][0]["speed"].get<double>(), speed, 1e-12);
    EXPECT_NE(json["trials"][1]["start"][0]["speed"], 0);  // its own
    return json["trials"];
  };
  const std::string plain = (scratch / "plain").string(), driven = (scratch / "driven").string();
  const auto recorded = calibrated(plain, "TRI.radius,hand.mass");
  EXPECT_EQ(recorded[0]["replay_file"], slow);
  const auto rows = linesOf(contentOf(plain + "/parameters.csv"));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0], "name,unit,nominal,estimate,sd,prior_sd,prior_z");
  EXPECT_THAT(rows[1], testing::StartsWith("TRI.radius,m,0.016,"));
  const auto made = calibrated(driven, "TRI.radius,emg.BRA.gain");
  EXPECT_EQ(made[0]["replay_file"], driven + "/driven_1.sto");
  EXPECT_EQ(made[1]["replay_file"], driven + "/driven_held_out_1.sto");
}

TEST(CalibrateCommand, RefusesAnIntervalInWords) {
  const ProgramResult result =
      runFisherHill({"calibrate", model, slow, "--parameters", "hand.mass,emg.BRA.gain", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("is confounded with"));
  const auto json = nlohmann::json::parse(result.out);
  const auto& gain = json["estimates"]["emg.BRA.gain"];
  EXPECT_EQ(gain["identifiable"], false);
  EXPECT_TRUE(gain["sd"].is_null());
  EXPECT_TRUE(gain["interval"][0].is_null());
  EXPECT_THAT(gain["why"].get<std::string>(), HasSubstr("hand.mass"));
}

// What the way from EMG to excitation became cannot stand in a model file: it goes into the trials.
TEST(CalibrateCommand, WritesTrialsWithTheCalibratedExcitations) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result =
      runFisherHill({"calibrate", model, slow, "--parameters", "emg.gain", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(contentOf(out + "/summary.json"));
  EXPECT_GT(std::abs(json["estimates"]["emg.gain"]["value"].get<double>() - 1), 1e-3);
  const ProgramResult replay =
      runFisherHill({"replay", out + "/calibrated.osim", out + "/driven_1.sto", "--json"});
  ASSERT_EQ(replay.status, 0) << replay.err;
  EXPECT_NEAR(nlohmann::json::parse(replay.out)["rms_error_deg"].get<double>(),
              json["rmse_train_deg"].get<double>(), 1e-3);
}

TEST(CalibrateCommand, NeverOverwritesItsInput) {
  const ScratchFolder scratch;
  const std::string own = (scratch / "calibrated.osim").string();
  std::filesystem::copy_file(std::filesystem::path(FISHERHILL_SOURCE_DIR) / model, own);
  const std::string before = contentOf(own);
  for (const bool force : {false, true}) {
    std::vector<std::string> arguments = {
        "calibrate", own, slow, "--parameters", "hand.mass", "--out", scratch.path().string()};
    if (force) arguments.push_back("--force");
    const ProgramResult result = runFisherHill(arguments);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_EQ(contentOf(own), before);
  }
}

TEST(CalibrateCommand, SameSeedSameBits) {
  const auto run = [](const char* seed, const char* threads) {
    return nlohmann::json::parse(
        runFisherHill({"calibrate", model, slow, "--parameters", "hand.mass", "--bootstrap", "20",
                       "--seed", seed, "--threads", threads, "--json"})
            .out)["estimates"];
  };
  EXPECT_EQ(run("3", "1"), run("3", "2"));
  EXPECT_NE(run("3", "2"), run("4", "2"));
}

TEST(CalibrateCommand, SaysWhereTheParametersDoNotExplainTheTrials) {
  const auto warnings = [](const std::string& noise) {
    return support::runFisherHill({"calibrate", support::model, support::slow, "--parameters",
                                   "TRI.radius", "--noise-deg", noise})
        .err;
  };
  EXPECT_THAT(warnings("0.5"), testing::HasSubstr("times the noise given by --noise-deg"));
  EXPECT_THAT(warnings("5"), testing::Not(testing::HasSubstr("times the noise given")));
}

// A position may lie on either side of its frame, though the default bounds keep it on one.
TEST(CalibrateCommand, BoundsOfAPositionMayBeNegative) {
  const ScratchFolder scratch;
  const ProgramResult result = support::runFisherHill(
      {"calibrate", "models/elbow8.osim", "emg_data/curl_slow.sto", "--parameters", "BRD.point2.x",
       "--bounds", "BRD.point2.x=-0.02:0.06", "--out", (scratch / "out").string()});
  EXPECT_NE(result.status, 2) << result.err;
}

TEST(CalibrateCommand, ListsTheParametersOfSensitivityWithoutATrial) {
  const ProgramResult list = runFisherHill({"calibrate", model, "--list-parameters"});
  EXPECT_EQ(list.status, 0) << list.err;
  EXPECT_THAT(list.out, HasSubstr("TRI.radius"));
  EXPECT_EQ(list.out, runFisherHill({"sensitivity", model, "--list-parameters"}).out);
}

}  // namespace
