#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/run_program.h"
#include "support/scratch_folder.h"

// Robots in URDF and MJCF through the program.
namespace {

using support::contentOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

constexpr const char* asUrdf = R"(<robot name="pendulum"><link name="world"/>
  <link name="rod"><inertial><origin xyz="0 0 -0.3"/><mass value="2"/>
    <inertia ixx="0.05" iyy="0.04" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="swing" type="continuous"><parent link="world"/><child link="rod"/><axis xyz="0 1 0"/>
    <dynamics damping="0.1"/></joint></robot>)";

constexpr const char* asMjcf = R"(<mujoco model="pendulum"><worldbody><body name="rod">
  <joint name="swing" axis="0 1 0" damping="0.1" armature="0.01"/>
  <inertial pos="0 0 -0.3" mass="2" diaginertia="0.05 0.04 0.01"/></body></worldbody>
  <actuator><motor name="motor" joint="swing" gear="0.5"/></actuator></mujoco>)";

constexpr const char* trial = "time,swing\n0,1\n0.25,\n0.5,\n0.75,\n1,\n";

TEST(RobotDescriptionCommand, CheckSaysWhatTheFileWasAndWhatBecameOfIt) {
  const ScratchFolder scratch;
  const std::string urdf = scratch.file("a.urdf", asUrdf), mjcf = scratch.file("b.xml", asMjcf);
  const ProgramResult text = runFisherHill({"check", urdf, mjcf, scratch.file("t.csv", trial)});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("a.urdf: URDF of “pendulum”, translated to 1 body"));
  EXPECT_THAT(text.out, HasSubstr("b.xml: MJCF of “pendulum”, translated to 1 body"));
  EXPECT_THAT(text.out, HasSubstr("not simulated: the rotors' inertia (armature) (swing)"));
  const ProgramResult asJson = runFisherHill({"check", urdf, mjcf, "--json"});
  const auto told = nlohmann::json::parse(asJson.out);
  ASSERT_EQ(told["robot_descriptions"].size(), 4u);
  EXPECT_EQ(told["robot_descriptions"][0]["file"], urdf);
  EXPECT_THAT(std::string(told["robot_descriptions"][2]["translated"]), HasSubstr("1 motor"));
  EXPECT_EQ(told["errors"], 0);
}

TEST(RobotDescriptionCommand, BothFormatsReplayToTheSameMotion) {
  const ScratchFolder scratch;
  const std::string csv = scratch.file("t.csv", trial);
  std::vector<std::string> states;
  for (const auto& [name, text] : {std::pair("a.urdf", asUrdf), std::pair("b.xml", asMjcf)}) {
    const std::string out = (scratch / (std::string(name) + "-out")).string();
    const ProgramResult replay =
        runFisherHill({"replay", scratch.file(name, text), csv, "--out", out});
    ASSERT_EQ(replay.status, 0) << replay.err;
    std::string written = contentOf(out + "/states.sto");
    states.push_back(written.substr(written.find("endheader")));
  }
  EXPECT_EQ(states[0], states[1]);
  EXPECT_GT(std::count(states[0].begin(), states[0].end(), '\n'), 50);
}

TEST(RobotDescriptionCommand, DiscoverListsTheEffectsOfARobot) {
  const ScratchFolder scratch;
  const ProgramResult list = runFisherHill(
      {"discover", scratch.file("a.urdf", asUrdf), scratch.file("t.csv", trial), "--list-effects"});
  EXPECT_EQ(list.status, 0) << list.err;
  EXPECT_THAT(list.out, HasSubstr("coulomb"));
  EXPECT_THAT(list.out, HasSubstr("viscosity_swing_damping"));
}

TEST(RobotDescriptionCommand, ARobotThatBreaksARuleIsRefusedInOneLine) {
  const ScratchFolder scratch;
  const std::string broken =
      scratch.file("b.urdf", "<robot name='b'><link name='a'/><link name='c'/></robot>");
  const ProgramResult replay = runFisherHill({"replay", broken, scratch.file("t.csv", trial)});
  EXPECT_EQ(replay.status, 2);
  EXPECT_EQ(std::count(replay.err.begin(), replay.err.end(), '\n'), 1);
  EXPECT_THAT(replay.err, HasSubstr("b.urdf:1: link 'c': is a second root beside link 'a'"));
  EXPECT_EQ(runFisherHill({"check", broken}).status, 1);
}

}  // namespace
