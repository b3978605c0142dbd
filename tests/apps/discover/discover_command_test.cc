#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "support/replays.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::contentOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

const std::string elbow = "models/elbow8.osim";
const std::string train = "emg_data/hidden_a/train_1.sto";

TEST(DiscoverCommand, NamesTheDampingThatIsHiddenAddsItAndFindsNothingMore) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill(
      {"discover", elbow, train, "--noise-deg", "0.5", "--max-effects", "1", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(scratch.listing(), testing::UnorderedElementsAre(
                                     "out", "out/report.html", "out/reproduce.sh",
                                     "out/summary.json", "out/verdict.json", "out/with_effect.osim",
                                     "out/effect_only.osim", "out/parameters.csv"));
  const auto verdict = nlohmann::json::parse(contentOf(out + "/verdict.json"));
  EXPECT_EQ(verdict["verdict"], "named");
  const auto told = nlohmann::json::parse(contentOf(out + "/summary.json"));
  EXPECT_EQ(told["integrator"], "vi");
  EXPECT_EQ(told["step_s"], 0.01);
  EXPECT_NEAR(told["duration_s"].get<double>(), 4.5, 0.1);
  EXPECT_EQ(told["wall_s"], verdict["wall_s"]);
  // the search is a part of the run, and what its thread computes a part of the search
  EXPECT_LT(told["wall_s"].get<double>(), result.seconds);
  EXPECT_LT(verdict["processor_s"].get<double>(), told["wall_s"].get<double>() + 0.01);
  EXPECT_GT(verdict["processor_s"].get<double>(), 0.1);  // some ten seconds
  EXPECT_NEAR(told["noise_deg"].get<double>(), 0.5, 1e-12);
  EXPECT_FALSE(verdict["held_out_fitted"].get<bool>());
  ASSERT_EQ(verdict["effects"].size(), 1u);
  const auto& effect = verdict["effects"][0];
  EXPECT_EQ(effect["id"], "visc");
  // the truth, emg_data/answers/hidden.json, is 0.3
  const auto& viscosity = effect["parameters"]["visc.viscosity"];
  EXPECT_NEAR(viscosity["value"].get<double>(), 0.3, 3 * viscosity["sd"].get<double>());
  EXPECT_LT(viscosity["sd"].get<double>(), 0.03);
  EXPECT_GT(effect["log_bayes_factor"].get<double>(), 5);
  EXPECT_GT(verdict["gap"]["train"]["gap_closed"].get<double>(), 0.9);
  EXPECT_TRUE(verdict["gap"]["held_out"].is_null());

  // the model that was written is the one that was scored
  EXPECT_EQ(verdict["model"], "with_effect.osim");
  support::expectReplaysAgree(out + "/with_effect.osim", verdict["trials"], 0.01);
  const auto& after = verdict["gap"]["train"]["rmse_after_deg"];
  EXPECT_EQ(after, verdict["trials"][0]["rmse_after_deg"]);
  EXPECT_LT(after.get<double>(), 0.55);
  const ProgramResult nominal = runFisherHill({"replay", elbow, train, "--json"});
  EXPECT_NEAR(nlohmann::json::parse(nominal.out)["rms_error_deg"].get<double>(),
              verdict["trials"][0]["rmse_nominal_deg"].get<double>(), 1e-9);
  EXPECT_EQ(verdict["trials"][0]["rmse_nominal_deg"], verdict["gap"]["train"]["rmse_nominal_deg"]);
  EXPECT_EQ(runFisherHill({"check", out + "/with_effect.osim", out + "/effect_only.osim"}).status,
            0);

  // a page shows it with and without the effect
  const std::string page = (scratch / "page").string();
  const ProgramResult explored =
      runFisherHill({"explore", elbow, train, "--verdict", out, "--out", page});
  ASSERT_EQ(explored.status, 0) << explored.err;
  EXPECT_THAT(explored.out, HasSubstr("Missing: viscous joint damping.\n"));
  const std::string html = contentOf(page + "/report.html");
  for (const char* part : {"without it, all else as fitted", "with viscous joint damping",
                           "elbow_flexion_visc.viscosity"})
    EXPECT_THAT(html, HasSubstr(part));
  const auto rows = support::linesOf(contentOf(out + "/parameters.csv"));
  EXPECT_EQ(rows.at(0), "name,unit,nominal,estimate,sd,prior_sd,prior_z");
  EXPECT_EQ(rows.size(), 1 + verdict["fitted_parameters"].size());
  EXPECT_EQ(rows.size(), 1U + 1U + 24U + 2U + 2U);
  EXPECT_THAT(rows.at(1), testing::StartsWith("visc.viscosity,N m s/rad,0,"));
  EXPECT_THAT(contentOf(out + "/parameters.csv"), HasSubstr("\nTRIlong.max_isometric_force,N,"));
  EXPECT_THAT(result.out, HasSubstr("The residual is at the noise floor (0.49°)."));
  EXPECT_GT(effect["moment_rms_Nm"].get<double>(), 0.1);
  EXPECT_GT(effect["moment_peak_Nm"].get<double>(), effect["moment_rms_Nm"].get<double>());
  EXPECT_GT(effect["share_of_muscle_moment"].get<double>(), 0.01);
  EXPECT_GT(effect["motion_rms_deg"].get<double>(), 3);
  EXPECT_GT(verdict["undetectable_below"]["coulomb"].get<double>(), 0);
  EXPECT_THAT(result.err, HasSubstr("is untested"));

  // what is added is OpenSim's own, says where it came from, and the input is untouched
  const std::string osim = contentOf(out + "/with_effect.osim");
  EXPECT_THAT(osim, HasSubstr("<SpringGeneralizedForce name=\"elbow_flexion_visc\">"));
  EXPECT_THAT(osim, HasSubstr("viscous joint damping (visc)"));
  EXPECT_THAT(
      osim, HasSubstr(nlohmann::json::parse(contentOf(out + "/summary.json"))["inputs"][1]["sha256"]
                          .get<std::string>()));
  const std::string report = contentOf(out + "/report.html");
  for (const char* title :
       {"Missing effects", "All hypotheses compared", "Score over time", "Missing force",
        "Residual diagnostics", "Smallest detectable effects", "Next experiment", "Reproduce",
        "On emg_data/hidden_a/train_1.sto its moment is", "fisherhill replay"}) {
    EXPECT_THAT(report, HasSubstr(title));
  }

  const ProgramResult again = runFisherHill({"discover", out + "/with_effect.osim", train,
                                             "--noise-deg", "0.5", "--max-effects", "1", "--json"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(nlohmann::json::parse(again.out)["verdict"], "none");
}

// The recording begins at 63.3°.
TEST(DiscoverCommand, ExpectsTheTrialToBeginWhereInitialSays) {
  const ScratchFolder scratch;
  const auto startFrom = [&](const std::string& start) {
    const std::string out = (scratch / ("out" + start)).string();
    const ProgramResult result =
        runFisherHill({"discover", elbow, train, "--noise-deg", "0.5", "--max-effects", "1",
                       "--initial", "elbow_flexion=" + start, "--out", out});
    EXPECT_EQ(result.status, 0) << result.err;
    const auto verdict = nlohmann::json::parse(contentOf(out + "/verdict.json"));
    const ProgramResult replayed =
        runFisherHill({"replay", elbow, train, "--initial", "elbow_flexion=" + start, "--json"});
    EXPECT_NEAR(nlohmann::json::parse(replayed.out)["rms_error_deg"].get<double>(),
                verdict["trials"][0]["rmse_nominal_deg"].get<double>(), 1e-9);
    for (const auto& fitted : verdict["fitted_parameters"]) {
      if (fitted["name"] == "trial1.initial.elbow_flexion")
        return std::pair(fitted["nominal"].get<double>(), fitted["estimate"].get<double>());
    }
    throw std::runtime_error("no start was fitted");
  };
  const auto [near, nearEstimate] = startFrom("63deg");
  const auto [far, farEstimate] = startFrom("66deg");
  EXPECT_NEAR(near, 63 * 3.14159265358979 / 180, 1e-12);
  EXPECT_NEAR(far, 66 * 3.14159265358979 / 180, 1e-12);
  EXPECT_GT(std::abs(farEstimate - nearEstimate), 1e-5);
}

TEST(DiscoverCommand, RefusesAStartOfWhatIsNotFree) {
  const ProgramResult result =
      runFisherHill({"discover", elbow, train, "--initial", "shoulder_elv=10deg"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("start of 'shoulder_elv': must be a free coordinate"));
}

}  // namespace
