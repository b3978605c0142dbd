#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "robots/hidden_robots.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using nlohmann::json;
using support::contentOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

// Three trials of 5 s to fit and one held out, from the blind benchmark's own robot.
hidden::RobotDataSet hiding(const ScratchFolder& scratch, const std::string& system,
                            const std::string& effect, std::uint64_t seed) {
  hidden::RobotPlan plan;
  plan.system = system;
  plan.seed = seed;
  plan.effects = {effect};
  hidden::RobotDataSet set = hidden::makeRobotDataSet(plan);
  hidden::writeRobotDataSet(set, hidden::robotKind(system), scratch / "set", scratch / "labels");
  return set;
}

std::string robotFileOf(const ScratchFolder& scratch, const char* name) {
  return (scratch / "set" / name).string();
}

/// What the program says of the set, written to `out` in the scratch folder.
json verdictOnRobot(const ScratchFolder& scratch, const std::string& system) {
  const ProgramResult result =
      runFisherHill({"discover", "--system", system, robotFileOf(scratch, "train_1.sto"),
                     robotFileOf(scratch, "train_2.sto"), robotFileOf(scratch, "train_3.sto"),
                     "--hold-out", robotFileOf(scratch, "held_out.sto"), "--max-effects", "1",
                     "--out", (scratch / "out").string()});
  if (result.status != 0) throw std::runtime_error(result.err);
  return json::parse(contentOf(scratch / "out" / "verdict.json"));
}

TEST(DiscoverRobotCommand, NamesTheDryFrictionOfADoublePendulumAndFindsNothingMoreOnceItIsBuiltIn) {
  const ScratchFolder scratch;
  const auto set = hiding(scratch, "double-pendulum", "coulomb_1", 10000);
  const json verdict = verdictOnRobot(scratch, "double-pendulum");
  EXPECT_EQ(verdict["verdict"], "named") << verdict["sentence"];
  ASSERT_EQ(verdict["effects"].size(), 1u);
  EXPECT_EQ(verdict["effects"][0]["id"], "coulomb_1");
  const auto& moment = verdict["effects"][0]["parameters"]["dry moment 1"];
  const double truth = set.label["effects"][0]["amplitude"];
  EXPECT_NEAR(moment["value"].get<double>(), truth, 2 * moment["sd"].get<double>());
  EXPECT_LT(moment["sd"].get<double>(), 0.2 * truth);
  EXPECT_GT(verdict["gap"]["held_out"]["gap_closed"].get<double>(), 0.9);
  // three trials leave little unknown, so an error of about the noise is to be expected
  const auto& heldOut = verdict["gap"]["held_out"];
  const double floor = heldOut["noise_floor_deg"], expected = heldOut["rmse_expected_deg"];
  EXPECT_GT(expected, 0.98 * floor);
  EXPECT_LT(expected, 1.1 * floor);
  EXPECT_NEAR(heldOut["rmse_after_deg"].get<double>(), expected, 0.15 * floor);
  EXPECT_TRUE(verdict["localisation"].contains("inputs"));
  const std::string report = contentOf(scratch / "out" / "report.html");
  for (const char* title : {"link1 [deg]", "link2 [deg]", "Missing effects", "Score over time",
                            "Score over angle and speed", "Acceleration of the cart"})
    EXPECT_THAT(report, HasSubstr(title));

  const ProgramResult again =
      runFisherHill({"discover", "--system", "double-pendulum", "--with",
                     (scratch / "out" / "with_effect.json").string(),
                     robotFileOf(scratch, "train_1.sto"), "--max-effects", "1", "--json"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(json::parse(again.out)["verdict"], "none");
}

TEST(DiscoverRobotCommand, NamesTheBiasOfALoadCell) {
  const ScratchFolder scratch;
  const auto set = hiding(scratch, "suspended-mass", "bias", 10000);
  const json verdict = verdictOnRobot(scratch, "suspended-mass");
  EXPECT_EQ(verdict["verdict"], "named") << verdict["sentence"];
  ASSERT_EQ(verdict["effects"].size(), 1u);
  EXPECT_EQ(verdict["effects"][0]["id"], "bias");
  const auto& bias = verdict["effects"][0]["parameters"]["bias"];
  EXPECT_NEAR(bias["value"].get<double>(), set.label["effects"][0]["amplitude"].get<double>(),
              2 * bias["sd"].get<double>());
  EXPECT_TRUE(verdict["gap"]["train"].contains("rmse_after_N"));
  EXPECT_THAT(contentOf(scratch / "out" / "report.html"), HasSubstr("no angle was measured"));
}

TEST(DiscoverRobotCommand, RefusesBadInputInOneLine) {
  const ScratchFolder scratch;
  const auto table = [&](const char* name, const std::string& text) {
    std::ofstream(scratch / name) << text;
    return (scratch / name).string();
  };
  const auto refused = [&](const std::vector<std::string>& more, const std::string& what) {
    std::vector<std::string> arguments = {"discover", "--system", "suspended-mass"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = runFisherHill(arguments);
    EXPECT_EQ(result.status, 2) << what;
    EXPECT_THAT(result.err, HasSubstr(what));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  std::string rows = "time,input,force_N\n", noInput = "time,force_N\n",
              extra = "time,input,force_N,colour\n";
  for (int k = 0; k < 12; ++k) {
    const double t = 0.01 * k, force = 1.1 + 0.01 * std::sin(9.0 * k);
    rows += std::to_string(t) + ",0," + std::to_string(force) + "\n";
    noInput += std::to_string(t) + "," + std::to_string(force) + "\n";
    extra += std::to_string(t) + ",0," + std::to_string(force) + ",1\n";
  }
  const std::string good = table("good.csv", rows);
  refused({table("a.csv", noInput)}, "has no column input");
  refused({table("b.csv", extra)}, "column colour is unknown");
  refused({table("c.csv", "time,input\n0,0\n0.01,0\n")}, "has no column force_N");
  refused({table("d.csv", "time,input,force_N\n0,,1\n0.01,0,1\n")}, "row 1 is empty");
  refused({good, good}, "is the same trial as");
  refused({good, "--step", "0.2"}, "good.csv: lasts 0.11 s, --step 0.2 s must not be longer");
  refused({good, "--without", "visc_1"}, "not in the catalogue of suspended-mass");
  refused({good, "--integrator", "rk4"}, "cannot be combined with --system");
  refused({good, "--noise", "1,2"}, "2 values for 1 channels");
  refused({good, "--with", table("e.json", "{\"system\": \"double-pendulum\", \"effects\": []}")},
          "system is double-pendulum, must be suspended-mass");
  const ProgramResult none = runFisherHill({"discover", "models/elbow8.osim"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("TRIAL is required"));
}

}  // namespace
