#include "apps/command/mistakes.h"

#include <gmock/gmock.h>

#include <algorithm>

// What people type wrongly, and files that are broken: one line that names it, status 2, nothing
// left behind, whatever the subcommand.
namespace mistakes {
namespace {

using support::ProgramResult;
using testing::HasSubstr;

std::string replaced(std::string text, const std::string& with) {
  for (std::size_t at = 0; (at = text.find('$', at)) != text.npos; at += with.size()) {
    text.replace(at, 1, with);
  }
  return text;
}

TEST_P(EveryMistake, IsOneLineStatusTwoAndLeavesNothing) {
  const ScratchFolder scratch;
  writeFiles(scratch);
  const auto before = scratch.listing();
  std::vector<std::string> arguments;
  for (const std::string& argument : GetParam().arguments) {
    arguments.push_back(replaced(argument, scratch.path().string()));
  }
  const ProgramResult result = support::runFisherHill(arguments);
  EXPECT_EQ(result.status, 2) << result.out;
  EXPECT_EQ(result.out, "");
  // Warnings may stand before the error; the last line is the one.
  const std::size_t last = result.err.rfind("fisherhill " + arguments[0] + ": ");
  ASSERT_NE(last, result.err.npos) << result.err;
  const std::string error = result.err.substr(last);
  EXPECT_THAT(error, HasSubstr(replaced(GetParam().message, scratch.path().string())));
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
  EXPECT_EQ(scratch.listing(), before);
}

INSTANTIATE_TEST_SUITE_P(
    Check, EveryMistake,
    testing::ValuesIn(std::vector<Mistake>{
        {"NoFile", {"check"}, "FILE"},
        {"MissingFile", {"check", "$/missing.osim"}, "does not exist: $/missing.osim"},
        {"Folder", {"check", "$"}, "directory"},
        {"UnknownOption", {"check", "$/good.csv", "--fast"}, "--fast"},
        {"OutWithoutFolder", {"check", "$/good.csv", "--out"}, "--out"},
        {"OutIsAFile", {"check", "$/good.csv", "--out", "$/good.csv"}, "is not a folder"},
        {"OutIsEmpty", {"check", "$/good.csv", "--out", ""}, "--out"},
        {"OutCannotBeMade", {"check", "$/good.csv", "--out", "/dev/null/out"}, "/dev/null/out"},
        {"OutCannotBeWritten", {"check", "$/good.csv", "--out", "/proc/out"}, "/proc/out"},
        {"OneOfTwoIsMissing", {"check", "$/good.csv", "no.csv", "--out", "$/out"}, "no.csv"},
        {"BadThreads", {"check", "$/good.csv", "--threads", "none", "--out", "$/out"}, "--threads"},
        {"BadSeed", {"check", "$/good.csv", "--seed", "-3", "--out", "$/out"}, "--seed"}}),
    nameOf);

INSTANTIATE_TEST_SUITE_P(
    Emg, EveryMistake,
    testing::ValuesIn(std::vector<Mistake>{
        {"NoConfig", {"emg", "$/good.csv", "--out", "$/out"}, "--config"},
        {"MissingConfig", {"emg", "$/good.csv", "--config", "$/no.toml"}, "$/no.toml"},
        {"MissingRecording", {"emg", "$/no.csv", "--config", "$/empty.toml"}, "$/no.csv"},
        {"EmptyConfig",
         {"emg", "$/good.csv", "--config", "$/empty.toml", "--out", "$/out"},
         "$/empty.toml"},
        {"ConfigIsATable",
         {"emg", "$/good.csv", "--config", "$/good.csv", "--out", "$/out"},
         "$/good.csv"}}),
    nameOf);

INSTANTIATE_TEST_SUITE_P(
    MomentArms, EveryMistake,
    testing::ValuesIn(std::vector<Mistake>{
        {"NoModel", {"moment-arms"}, "MODEL"},
        {"MissingModel", {"moment-arms", "$/no.osim"}, "$/no.osim"},
        {"NotAModel", {"moment-arms", "$/text.osim", "--out", "$/out"}, "$/text.osim"},
        {"Backwards",
         {"moment-arms", model, "--from", "90", "--to", "10", "--out", "$/out"},
         "--to"},
        {"FromNothing",
         {"moment-arms", model, "--from", "nan", "--out", "$/out"},
         "--from: 'nan' is not a finite number"},
        {"OnePoint", {"moment-arms", model, "--points", "1", "--out", "$/out"}, "--points"},
        {"HalfAPoint", {"moment-arms", model, "--points", "10.5"}, "--points"},
        {"FromNowhere", {"moment-arms", model, "--from", "nan", "--out", "$/out"}, "--from"},
        {"UnknownCoordinate",
         {"moment-arms", model, "--coordinate", "knee", "--out", "$/out"},
         "knee"},
        {"UnknownLock", {"moment-arms", model, "--lock", "knee=1", "--out", "$/out"}, "knee"},
        {"UnknownWrap",
         {"moment-arms", model, "--wrap-as-cylinder", "ball", "--out", "$/out"},
         "ball"}}),
    nameOf);

INSTANTIATE_TEST_SUITE_P(
    Replay, EveryMistake,
    testing::ValuesIn(std::vector<Mistake>{
        {"NoTrial", {"replay", model, "--out", "$/out"}, "TRIAL"},
        {"MissingTrial", {"replay", model, "$/no.sto", "--out", "$/out"}, "$/no.sto"},
        {"MissingModel", {"replay", "$/no.osim", "$/good.csv", "--out", "$/out"}, "$/no.osim"},
        {"NotAModel", {"replay", "$/text.osim", "$/good.csv", "--out", "$/out"}, "$/text.osim"},
        {"TheOtherWayRound", {"replay", "$/good.csv", model, "--out", "$/out"}, "$/good.csv"},
        {"ExcitationNaN", {"replay", model, "$/nan.csv", "--out", "$/out"}, "BIClong"},
        {"ExcitationAboveOne", {"replay", model, "$/high.csv", "--out", "$/out"}, "1.2"},
        {"ExcitationNegative", {"replay", model, "$/negative.csv", "--out", "$/out"}, "-0.2"},
        {"ColumnOfNothing", {"replay", model, "$/extra.csv", "--out", "$/out"}, "GLUTmax"},
        {"TorqueWithAGap",
         {"replay", model, "$/torque_gap.csv", "--out", "$/out"},
         "elbow_flexion.torque"},
        {"TorqueOnALockedCoordinate",
         {"replay", model, "$/torque_locked.csv", "--out", "$/out"},
         "pro_sup"},
        {"TorqueOnNothing",
         {"replay", model, "$/torque_of_nothing.csv", "--out", "$/out"},
         "knee.torque"},
        {"ForceOnAnAngle",
         {"replay", model, "$/force_on_an_angle.csv", "--out", "$/out"},
         "elbow_flexion.force"},
        {"OneRow", {"replay", model, "$/one_row.csv", "--out", "$/out"}, "$/one_row.csv"},
        {"TimeGoesBack", {"replay", model, "$/back.csv", "--out", "$/out"}, "$/back.csv:4"},
        {"EmptyTrial", {"replay", model, "$/empty.csv", "--out", "$/out"}, "$/empty.csv"},
        {"WordForANumber", {"replay", model, "$/word.csv", "--out", "$/out"}, "$/word.csv:3"},
        {"UnknownIntegrator", {"replay", model, "$/good.csv", "--integrator", "euler"}, "euler"},
        {"StepZero", {"replay", model, "$/good.csv", "--step", "0", "--out", "$/out"}, "--step"},
        {"StepNaN", {"replay", model, "$/good.csv", "--step", "nan", "--out", "$/out"}, "--step"},
        {"StepBeyondTheTrial",
         {"replay", model, slow, "--step", "10", "--out", "$/out"},
         slow + ": lasts 4.5 s, --step 10 s must not be longer"},
        {"UnknownCoordinate",
         {"replay", model, "$/good.csv", "--coordinate", "knee", "--out", "$/out"},
         "knee"},
        {"UnknownInitial",
         {"replay", model, "$/good.csv", "--initial", "knee=10deg", "--out", "$/out"},
         "knee"},
        {"InitialOfALockedOne",
         {"replay", model, "$/good.csv", "--initial", "shoulder_elv=10deg", "--out", "$/out"},
         "shoulder_elv"},
        {"BadAngle",
         {"replay", model, "$/good.csv", "--initial", "elbow_flexion=34degrees", "--out", "$/out"},
         "34degrees"},
        {"InitialTwice",
         {"replay", model, "$/good.csv", "--initial", "elbow_flexion=1", "--initial",
          "elbow_flexion=2", "--out", "$/out"},
         "elbow_flexion"},
        {"LockTheFreeOne",
         {"replay", model, "$/good.csv", "--lock", "elbow_flexion=1", "--out", "$/out"},
         "elbow_flexion"},
        {"UnknownLock",
         {"replay", model, "$/good.csv", "--lock", "knee=1", "--out", "$/out"},
         "knee"},
        {"UnknownWrap",
         {"replay", model, "$/good.csv", "--wrap-as-cylinder", "ball", "--out", "$/out"},
         "ball"},
        {"OutIsAFile", {"replay", model, "$/good.csv", "--out", "$/good.csv"}, "is not a folder"}}),
    nameOf);

INSTANTIATE_TEST_SUITE_P(
    Robot, EveryMistake,
    testing::ValuesIn(std::vector<Mistake>{
        {"NoExperiment", {"robot"}, "robot"},
        {"UnknownExperiment", {"robot", "triple-pendulum", "--out", "$/out"}, "triple-pendulum"},
        {"OutIsAFile", {"robot", "suspended-mass", "--out", "$/good.csv"}, "is not a folder"}}),
    nameOf);

#ifdef FISHERHILL_HAS_VIEW
INSTANTIATE_TEST_SUITE_P(
    Render, EveryMistake,
    testing::ValuesIn(std::vector<Mistake>{
        {"NoOut", {"render", model, "$/motion.csv"}, "--out is required"},
        {"NoStates", {"render", model, "$/no.sto", "--out", "$/out"}, "$/no.sto"},
        {"TimeIsNoNumber",
         {"render", model, "$/motion.csv", "--time", "nan", "--out", "$/out"},
         "--time: 'nan' is not a finite number"},
        {"EmptyStates", {"render", model, "$/empty.csv", "--out", "$/out"}, "$/empty.csv"},
        {"ForeignColumn", {"render", model, "$/extra.csv", "--out", "$/out"}, "'GLUTmax'"},
        {"NoCoordinate", {"render", model, "$/good.csv", "--out", "$/out"}, "no column gives"},
        {"BadModel", {"render", "$/text.osim", "$/motion.csv", "--out", "$/out"}, "$/text.osim"},
        {"BadSize",
         {"render", model, "$/motion.csv", "--out", "$/out", "--size", "1280"},
         "WIDTHxHEIGHT"},
        {"OddFilm",
         {"render", model, "$/motion.csv", "--out", "$/out", "--film", "--size", "101x100"},
         "even"},
        {"TimeOutside",
         {"render", model, "$/motion.csv", "--out", "$/out", "--time", "9"},
         "--time 9 s"},
        {"UnknownCamera",
         {"render", model, "$/motion.csv", "--out", "$/out", "--camera", "left"},
         "left"},
        {"GhostModelWithoutGhost",
         {"render", model, "$/motion.csv", "--out", "$/out", "--ghost-model", model},
         "--ghost"},
        {"GhostOfAnotherModel",
         {"render", model, "$/motion.csv", "--out", "$/out", "--ghost", "$/extra.csv"},
         "'GLUTmax'"},
        {"NoGeometryFolder",
         {"render", model, "$/motion.csv", "--out", "$/out", "--geometry", "$/none"},
         "$/none"},
        {"OutIsAFile", {"render", model, "$/motion.csv", "--out", "$/good.csv"}, "not a folder"}}),
    nameOf);
#else
INSTANTIATE_TEST_SUITE_P(
    RenderWithoutVtk, EveryMistake,
    testing::ValuesIn(std::vector<Mistake>{
        {"IsNotBuilt",
         {"render", model, "$/motion.csv", "--out", "$/out"},
         "built if VTK is installed and FISHERHILL_VIEW=ON"},
        {"NoStates", {"render", model, "$/no.sto", "--out", "$/out"}, "$/no.sto"}}),
    nameOf);
#endif

TEST(CtrlC, EndsALongReplayWithStatus130AndNothingHalfWritten) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  // --foreground: one signal, not another one for the whole group, which would end it at once
  const ProgramResult result =
      support::runProgram({"timeout", "--foreground", "--preserve-status", "--signal=INT", "1",
                           FISHERHILL_PROGRAM, "replay", model, "emg_data/curl_slow.sto",
                           "--integrator", "rk4", "--step", "1e-7", "--out", out},
                          FISHERHILL_SOURCE_DIR);
  EXPECT_EQ(result.status, 130) << result.err;
  EXPECT_EQ(result.err, "fisherhill replay: interrupted; nothing was written\n");
  EXPECT_THAT(scratch.listing(), testing::IsEmpty());
}

// Commands that can pass over a column say how, others do not.
TEST(Mistakes, AnUnknownColumnComesWithTheOptionThatIgnoresIt) {
  const ScratchFolder scratch;
  writeFiles(scratch);
  const std::string file = (scratch / "misspelt.csv").string();
  const std::string option = "(--ignore-extra ignores them)";
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"replay", model, file},
        {"calibrate", model, file, "--parameters", "hand.mass"},
        {"discover", model, file}}) {
    const ProgramResult result = support::runFisherHill(words);
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, HasSubstr(option)) << words[0];
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1);
  }
  const ProgramResult check = support::runFisherHill({"check", model, file});
  EXPECT_THAT(check.out + check.err, testing::Not(HasSubstr("--ignore-extra")));
}

// As a start outside the range is told.
TEST(Mistakes, ALockInDegreesThatAreMeantAsRadiansIsTold) {
  const auto replay = [](const std::string& lock) {
    return support::runFisherHill({"replay", model, slow, "--lock", lock});
  };
  const ProgramResult radians = replay("elv_angle=90");
  EXPECT_EQ(radians.status, 0);
  EXPECT_THAT(radians.err,
              HasSubstr("elv_angle is locked at 5157 deg, outside its range, -90 to 130"));
  const ProgramResult discover =
      support::runFisherHill({"discover", model, slow, "--lock", "elv_angle=90"});
  EXPECT_THAT(discover.err, HasSubstr("elv_angle is locked at 5157 deg"));
  const ProgramResult arms =
      support::runFisherHill({"moment-arms", model, "--points", "5", "--lock", "elv_angle=90"});
  EXPECT_THAT(arms.err, HasSubstr("elv_angle is locked at 5157 deg"));
  EXPECT_EQ(replay("elv_angle=90deg").err, "");
  EXPECT_EQ(replay("elv_angle=1.5").err, "");
}

TEST(Mistakes, NamesThatWereMeantAreTold) {
  const ProgramResult command = support::runFisherHill({"repaly", model, slow});
  EXPECT_EQ(command.status, 2);
  EXPECT_THAT(command.err, HasSubstr("repaly, did you mean 'replay'?"));
  const ScratchFolder scratch;
  writeFiles(scratch);
  const ProgramResult column =
      support::runFisherHill({"replay", model, (scratch / "misspelt.csv").string()});
  EXPECT_EQ(column.status, 2);
  EXPECT_THAT(column.err, HasSubstr("did you mean 'BIClong'?"));
  const ProgramResult nothing = support::runFisherHill({"xylophone"});
  EXPECT_EQ(nothing.status, 2);
  EXPECT_THAT(nothing.err, testing::Not(HasSubstr("did you mean")));
}

// What was printed must have arrived.
TEST(Mistakes, AFullDiskBehindStandardOutputIsNoSuccess) {
  const std::string program = FISHERHILL_PROGRAM;
  for (const std::string& words : {std::string("--help"), "check " + model + " --json",
                                   "replay " + model + " " + slow + " --json"}) {
    const ProgramResult result = support::runProgram(
        {"sh", "-c", "exec " + program + " " + words + " > /dev/full"}, FISHERHILL_SOURCE_DIR);
    EXPECT_EQ(result.status, 2) << words;
    EXPECT_THAT(result.err, HasSubstr("standard output cannot be written")) << words;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
}

}  // namespace
}  // namespace mistakes
