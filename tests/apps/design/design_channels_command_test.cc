// `design` over lists of channels and of joints.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/design/design_command.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using designing::design;
using designing::designSummary;
using support::ProgramResult;
using support::ScratchFolder;
using testing::HasSubstr;

/// The bounds that `sensitivity` finds in a designed trial.
std::map<std::string, double> boundsTold(std::vector<std::string> more) {
  std::vector<std::string> command = {"sensitivity", "models/elbow8.osim"};
  command.insert(command.end(), more.begin(), more.end());
  const ProgramResult result = support::runFisherHill(command);
  EXPECT_EQ(result.status, 0) << result.err;
  std::map<std::string, double> bounds;
  if (result.status != 0) return bounds;
  for (const auto& one : nlohmann::json::parse(result.out)["parameters"]) {
    bounds[one["name"]] = one["bound_joint"];
  }
  return bounds;
}

// A dynamometer moves the elbow and reads its moment; two joints are pushed and everything is
// observed. Each design is what sensitivity finds in the trial that is written.
TEST(DesignOfChannels, ObservesChannelsOfHeldAndOfSeveralFreeCoordinates) {
  const ScratchFolder scratch;
  const std::string curl = "emg_data/curl_slow.sto";
  const std::string still = (scratch / "still.csv").string();  // without an angle
  std::ofstream(still) << "time,BRA,BIClong\n0,0.1,0.1\n1,0.3,0.1\n2,0.1,0.1\n";
  struct Case {
    const char* name;
    std::string trial;
    std::vector<std::string> roles, observed, inputs;
  };
  const std::vector<Case> cases = {
      {"held",
       curl,
       {"--prescribe", "elbow_flexion"},
       {"elbow_flexion.moment=0.5"},
       {"--excite", "flexors,extensors"}},
      {"locked",
       still,
       {"--lock", "elbow_flexion=60deg"},
       {"elbow_flexion.moment=0.5", "BRA.fiber_length=0.001"},
       {"--excite", "flexors"}},
      {"two",
       curl,
       {"--coordinate", "elbow_flexion", "--coordinate", "shoulder_elv"},
       {"elbow_flexion=0.5deg", "shoulder_elv=1deg", "elbow_flexion.speed=5deg",
        "BRA.fiber_length=0.001"},
       {"--torque", "elbow_flexion=3", "--torque", "shoulder_elv=2", "--range",
        "shoulder_elv=-170deg,170deg", "--speed", "1000"}}};
  for (const Case& one : cases) {
    const std::string out = (scratch / one.name).string();
    std::vector<std::string> observing = one.roles;
    for (const std::string& each : one.observed) {
      observing.insert(observing.end(), {"--observe", each});
    }
    std::vector<std::string> command = {"design",
                                        "models/elbow8.osim",
                                        one.trial,
                                        "--parameters",
                                        "BRA.max_isometric_force,hand.mass",
                                        "--priors",
                                        "--candidates",
                                        "8",
                                        "--generations",
                                        "1",
                                        "--iterations",
                                        "0",
                                        "--out",
                                        out};
    command.insert(command.end(), observing.begin(), observing.end());
    command.insert(command.end(), one.inputs.begin(), one.inputs.end());
    const ProgramResult result = support::runFisherHill(command);
    ASSERT_LE(result.status, 1) << one.name << result.err;
    const nlohmann::json summary = designSummary(out);
    ASSERT_EQ(summary["outputs"].size(), one.observed.size()) << one.name;
    for (std::size_t o = 0; o < one.observed.size(); ++o) {
      EXPECT_TRUE(one.observed[o].starts_with(summary["outputs"][o]["name"].get<std::string>()));
    }
    const bool isTwo = std::string(one.name) == "two";
    EXPECT_EQ(summary["coordinates"].size(), isTwo ? 2u : 0u);
    if (isTwo) {
      EXPECT_EQ(summary["coordinates"][0]["torque_unit"], "N m");
    }
    observing.insert(observing.end(), {out + "/design.sto", "--parameters",
                                       "BRA.max_isometric_force,hand.mass", "--json"});
    for (const auto& [name, bound] : boundsTold(observing)) {
      EXPECT_NEAR(bound / summary["bound_after"][name].get<double>(), 1, 1e-9)
          << one.name << " " << name;
    }
    std::ifstream file(out + "/report.html");
    const std::string report((std::istreambuf_iterator<char>(file)), {});
    EXPECT_THAT(report, HasSubstr(isTwo ? "shoulder_elv [deg]" : "elbow_flexion.moment [N m]"));
  }
}

TEST(DesignOfChannels, SaysWhatCannotBeObservedOrPushed) {
  const auto refused = [](const std::vector<std::string>& more, const char* words) {
    const ScratchFolder scratch;
    const ProgramResult result = design((scratch / "design").string(), more);
    EXPECT_EQ(result.status, 2) << words << result.out;
    EXPECT_THAT(result.err, HasSubstr(words));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  const std::vector<std::string> held = {"--prescribe", "elbow_flexion", "--prescribe-cutoff", "6"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), held.begin(), held.end());
    return more;
  };
  refused(held, "no coordinate is free to be observed: --observe must name what is measured");
  refused(with({"--observe", "elbow_flexion.moment=0.5"}), "no input to design");
  refused(with({"--observe", "elbow_flexion.moment=0.5", "--excite", "BRA", "--torque", "3"}),
          "--torque: no coordinate is free to move");
  refused(with({"--observe", "elbow_flexion.moment=0.5", "--torque", "elbow_flexion=3"}),
          "torque of 'elbow_flexion': must be a coordinate that is free to move");
  refused({"--observe", "elbow_flexion.moment=0.5"}, "is free to move, where nothing holds it");
  refused({"--observe", "elbow_flexion=0deg"}, "must be > 0");
  refused({"--observe", "elbow_flexoin=1deg"}, "'elbow_flexoin' is nothing that can be measured");
  refused({"--observe", "elbow_flexion=1deg", "--observe", "elbow_flexion=2deg"},
          "'elbow_flexion' is observed twice");
  refused({"--observe", "elbow_flexion=1deg", "--noise", "1"}, "--noise cannot be combined");
  refused({"--torque", "x"}, "--torque: ");
  refused({"--torque", "-1"}, "must be ≥ 0");
  refused({"--torque", "1", "--torque", "2"}, "--torque: '2' is given twice");
  refused({"--torque", "knee=2"}, "torque of 'knee': must be a coordinate that is free");
  refused({"--range", "10deg"}, "'10deg' must be LOW,HIGH");
  refused({"--range", "60deg,10deg"}, "must rise");
  refused(
      {"--coordinate", "elbow_flexion", "--coordinate", "shoulder_elv", "--range", "10deg,60deg"},
      "range: must name its coordinate, of which 2 are free");
}

// Both joints are pushed and observed; a dynamometer's moment.
TEST(DesignOfChannels, TellsTwoEffectsApartBySeveralChannels) {
  const ScratchFolder scratch;
  const auto separated = [&](const char* name, const char* effects, std::vector<std::string> more) {
    const std::string out = (scratch / name).string();
    std::vector<std::string> command = {"design",
                                        "models/elbow8.osim",
                                        "emg_data/curl_slow.sto",
                                        "--separate",
                                        effects,
                                        "--candidates",
                                        "2",
                                        "--generations",
                                        "0",
                                        "--out",
                                        out};
    command.insert(command.end(), more.begin(), more.end());
    const ProgramResult result = support::runFisherHill(command);
    EXPECT_LE(result.status, 1) << result.err;
    return designSummary(out);
  };
  const nlohmann::json moment = separated("held", "fatigue,shape",
                                          {"--prescribe", "elbow_flexion", "--observe",
                                           "elbow_flexion.moment=0.5", "--excite", "flexors"});
  EXPECT_EQ(moment["outputs"][0]["unit"], "N m");
  EXPECT_TRUE(moment["coordinates"].empty());
  EXPECT_GT(moment["nats_after"]["fatigue"], 0);
  const nlohmann::json two =
      separated("two", "elbow_flexion.visc,shoulder_elv.visc",
                {"--coordinate", "elbow_flexion,shoulder_elv", "--torque", "3", "--speed", "1000"});
  EXPECT_EQ(two["outputs"].size(), 2u);
  EXPECT_EQ(two["coordinates"].size(), 2u);
  EXPECT_GT(two["nats_before"]["shoulder_elv.visc"], 0);
}

// A robot at rest tells nothing; pushed along its rail it does.
TEST(DesignOfChannels, SaysThatATrialAtRestDeterminesNothing) {
  const ScratchFolder scratch;
  const std::string rest = (scratch / "rest.csv").string();
  std::ofstream(rest) << "time,cart_x,link1,link2\n0,0,0,0\n1,0,0,0\n2,0,0,0\n";
  const ProgramResult result = support::runFisherHill(
      {"design", "models/robots/cart_double_pendulum.osim", rest, "--torque", "cart_x=5",
       "--torque", "link1=0", "--torque", "link2=0", "--parameters", "link1.mass", "--observe",
       "link1=0.2deg", "--candidates", "10", "--generations", "0"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out,
              HasSubstr("(Cramér–Rao bound), which " + rest + " does not determine at all."));
}

}  // namespace
