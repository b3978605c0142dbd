#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;
using testing::Not;

/// The shipped configuration without the electrode of BRD.
std::string configWithout(const std::string& instead) {
  std::string text =
      support::contentOf(std::string(FISHERHILL_SOURCE_DIR) + "/emg_data/configs/shipped_raw.toml");
  const auto begin = text.find("[[electrode]]\nchannel = \"BRD_uV\"");
  text.erase(begin, text.find("[measured]") - begin);
  text.insert(text.find("rate_Hz = 200"), "end_s = 1.2\n");
  return text + instead;
}

// From a recording that lacks an electrode to a calibration that says how far the data pulled.
TEST(LatentCommand, AMuscleWithoutAnElectrodeIsPulledAndNamed) {
  const ScratchFolder scratch;
  const std::string config = scratch.file(
      "c.toml", configWithout("\n[[unrecorded]]\nmuscle = \"BRD\"\nsynergy = { BRA_uV = 1, "
                              "BIClong_uV = 3 }\nlatent_sd = 1\nknots_s = 0.4\n"));
  const std::string out = (scratch / "emg").string(), fit = (scratch / "fit").string();
  const ProgramResult emg =
      runFisherHill({"emg", "emg_data/curl_slow_raw.csv", "--config", config, "--out", out});
  ASSERT_EQ(emg.status, 0) << emg.err;
  const auto made = nlohmann::json::parse(support::contentOf(out + "/summary.json"));
  EXPECT_EQ(made["muscles_without_electrode"][0]["muscle"], "BRD");
  EXPECT_EQ(made["muscles_without_electrode"][0]["excitation"],
            "the mean of 0.25 of 'BRA_uV' and 0.75 of 'BIClong_uV'");
  EXPECT_THAT(support::contentOf(out + "/report.html"), HasSubstr("BRD has no electrode"));
  const std::string trial = out + "/excitations.sto";
  EXPECT_THAT(support::contentOf(trial), HasSubstr("latent_excitation=BRD 1 0.4\n"));
  const ProgramResult result =
      runFisherHill({"calibrate", "models/elbow8.osim", trial, "--parameters", "hand.mass",
                     "--step", "0.01", "--noise-deg", "0.5", "--out", fit});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(support::contentOf(fit + "/summary.json"));
  ASSERT_EQ(json["latent_excitations"].size(), 1u);
  const auto& latent = json["latent_excitations"][0];
  EXPECT_EQ(latent["muscle"], "BRD");
  ASSERT_EQ(latent["knots_s"].size(), 4u);
  // z-scores are those of the log-odds
  double largest = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto logOdds = [](double x) { return std::log(x / (1 - x)); };
    const double z = latent["prior_z"][k], x = latent["estimate"][k],
                 expected = std::max(0.001, latent["expected"][k].get<double>());
    EXPECT_NEAR(z, logOdds(x) - logOdds(expected), 1e-6);
    largest = std::max(largest, std::abs(z));
  }
  EXPECT_NEAR(latent["largest_prior_z"], largest, 1e-9);
  EXPECT_GT(largest, 0.01);
  EXPECT_LT(json["rmse_train_deg"], json["rmse_train_before_deg"]);
  const std::string report = support::contentOf(fit + "/report.html");
  EXPECT_THAT(report, HasSubstr("Muscles without an electrode"));
  EXPECT_THAT(report, HasSubstr("pulled from what was expected by"));
  // knots are in their own place
  EXPECT_EQ(json["estimates"].size(), 1u);
  EXPECT_EQ(json["correlation"].size(), 1u);
  EXPECT_THAT(support::contentOf(fit + "/parameters.csv"), Not(HasSubstr("latent")));
  ASSERT_EQ(latent["sd_log_odds"].size(), 4u);
  for (const auto& sd : latent["sd_log_odds"]) {  // null: the data do not determine it
    EXPECT_TRUE(sd.is_null() || (sd > 0 && sd < 1)) << sd;
  }
  // what it wrote replays as it was scored
  const ProgramResult replay =
      runFisherHill({"replay", fit + "/calibrated.osim", fit + "/driven_1.sto", "--json"});
  ASSERT_EQ(replay.status, 0) << replay.err;
  EXPECT_NEAR(nlohmann::json::parse(replay.out)["rms_error_deg"].get<double>(),
              json["rmse_train_deg"].get<double>(), 1e-3);
}

TEST(LatentCommand, TheOptionDoesWithoutTheHeaderAndIsHeldToItsRules) {
  const std::vector<std::string> command = {"calibrate",
                                            "models/elbow8.osim",
                                            "emg_data/curl_fast.sto",
                                            "--parameters",
                                            "hand.mass",
                                            "--step",
                                            "0.01",
                                            "--json"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), command.begin(), command.end());
    return runFisherHill(more);
  };
  const ProgramResult two = with({"--latent", "BRD=0.5:1,ANC=1:2"});
  ASSERT_LE(two.status, 1) << two.err;
  const auto json = nlohmann::json::parse(two.out);
  ASSERT_EQ(json["latent_excitations"].size(), 2u);
  const auto refused = [&](const std::string& text, const std::string& message) {
    const ProgramResult result = with({"--latent", text});
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  refused("DELT=1:0.5", "latent excitation of 'DELT'");
  refused("BRD=0:0.5", "sd = 0, must be > 0");
  refused("BRD=1:0", "knots every 0 s, must be > 0");
  refused("BRD=1", "--latent");
}

// They are estimated anyway, belong to trials, and have the prior that is declared with them.
TEST(LatentCommand, KnotsCannotBeNamed) {
  const auto refused = [](std::vector<std::string> more, const std::string& message) {
    more.insert(more.begin(), {"calibrate", "models/elbow8.osim", "emg_data/curl_fast.sto"});
    const ProgramResult result = runFisherHill(more);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  for (const char* name :
       {"emg.BRD.latent1", "emg.*.latent*", "hand.mass,trial1.emg.BRD.latent2"}) {
    for (const bool declared : {true, false}) {
      std::vector<std::string> more = {"--parameters", name};
      if (declared) more.insert(more.end(), {"--latent", "BRD=1:0.5"});
      refused(more, "knots of latent excitations are estimated without being named");
    }
  }
  const std::vector<std::string> with = {"--parameters", "hand.mass", "--latent", "BRD=1:0.5"};
  for (const auto& [option, value, words] :
       {std::tuple{"--prior", "emg.BRD.latent1=0:1", "prior of 'emg.BRD.latent1': knots"},
        std::tuple{"--bounds", "emg.BRD.latent1=-1:1", "bounds of 'emg.BRD.latent1': knots"},
        std::tuple{"--prior", "emg.ANC.latent1=0:1", "have the prior that the trial's header"}}) {
    std::vector<std::string> more = with;
    more.insert(more.end(), {option, value});
    refused(more, words);
  }
}

}  // namespace
