#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

// What people type wrongly, and files that are broken: one line that names it, status 2, nothing
// left behind, whatever the subcommand.
namespace {

using support::model;
using support::ProgramResult;
using support::ScratchFolder;
using support::slow;
using testing::HasSubstr;

struct Mistake {
  std::string name;
  std::vector<std::string> arguments;  ///< $ stands for the scratch folder
  std::string message;                 ///< a part of the one line; $ as above
};

/// The files a mistake can use.
void writeFiles(const ScratchFolder& scratch) {
  scratch.file("good.csv", "time,BIClong\n0,0.1\n0.1,0.2\n0.2,0.1\n");
  scratch.file("nan.csv", "time,BIClong\n0,0.1\n0.1,nan\n0.2,0.1\n");
  scratch.file("high.csv", "time,BIClong\n0,0.1\n0.1,1.2\n0.2,0.1\n");
  scratch.file("negative.csv", "time,BIClong\n0,0.1\n0.1,-0.2\n0.2,0.1\n");
  scratch.file("extra.csv", "time,BIClong,GLUTmax\n0,0.1,0\n0.1,0.1,0\n");
  scratch.file("misspelt.csv", "time,BIClogn\n0,0.1\n0.1,0.1\n");
  scratch.file("torque_gap.csv", "time,BRA,elbow_flexion.torque\n0,0.1,1\n0.1,0.1,\n");
  scratch.file("torque_locked.csv", "time,BRA,pro_sup.torque\n0,0.1,1\n0.1,0.1,1\n");
  scratch.file("torque_of_nothing.csv", "time,BRA,knee.torque\n0,0.1,1\n0.1,0.1,1\n");
  scratch.file("force_on_an_angle.csv", "time,BRA,elbow_flexion.force\n0,0.1,1\n0.1,0.1,1\n");
  scratch.file("one_row.csv", "time,BIClong\n0,0.1\n");
  scratch.file("back.csv", "time,BIClong\n0,0.1\n0.2,0.1\n0.1,0.1\n");
  scratch.file("empty.csv", "");
  scratch.file("word.csv", "time,BIClong\n0,0.1\n0.1,much\n");
  scratch.file("text.osim", "no model\n");
  scratch.file("with_effect.osim",
               support::contentOf(std::string(FISHERHILL_SOURCE_DIR "/") + model));
  scratch.file("empty.toml", "");
  scratch.file("motion.csv", "time,elbow_flexion_deg\n0,30\n0.1,40\n");
}

std::string replaced(std::string text, const std::string& with) {
  for (std::size_t at = 0; (at = text.find('$', at)) != text.npos; at += with.size()) {
    text.replace(at, 1, with);
  }
  return text;
}

class EveryMistake : public testing::TestWithParam<Mistake> {};

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

std::string nameOf(const testing::TestParamInfo<Mistake>& test) {
  return test.param.name;
}

/// `fisherhill calibrate` on a good trial, with what comes behind.
std::vector<std::string> calibrateWith(std::vector<std::string> more,
                                       const std::string& parameters = "hand.mass") {
  std::vector<std::string> all = {"calibrate", model,   slow,   "--parameters",
                                  parameters,  "--out", "$/out"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

INSTANTIATE_TEST_SUITE_P(
    Calibrate, EveryMistake,
    testing::ValuesIn(std::vector<Mistake>{
        {"NoTrial", {"calibrate", model, "--parameters", "hand.mass"}, "TRIAL"},
        {"NoParameters", {"calibrate", model, slow}, "--parameters"},
        {"EmptyParameters", calibrateWith({}, ""), "--parameters"},
        {"StepBeyondTheTrial", calibrateWith({"--step", "10"}),
         slow + ": lasts 4.5 s, --step 10 s must not be longer"},
        {"UnknownParameter", calibrateWith({}, "hand.mas"), "no parameter is called 'hand.mas'"},
        {"ParameterTwice", calibrateWith({}, "hand.mass,hand.mass"), "'hand.mass' is given twice"},
        {"GroupAndMember", calibrateWith({}, "emg.gain,emg.BRA.gain"), "set the same value"},
        {"NothingMeasured",
         {"calibrate", model, "$/good.csv", "--parameters", "hand.mass", "--out", "$/out"},
         "$/good.csv: no measured column of a free coordinate"},
        {"MissingTrial", {"calibrate", model, "$/no.sto", "--parameters", "hand.mass"}, "$/no.sto"},
        {"NotAModel",
         {"calibrate", "$/text.osim", slow, "--parameters", "hand.mass"},
         "$/text.osim"},
        {"HoldOutIsTrained", calibrateWith({"--hold-out", slow}),
         "is held out and also used for estimation"},
        {"TrialTwice", calibrateWith({slow}), "is the same trial as"},
        {"HoldOutUnmeasured", calibrateWith({"--hold-out", "$/good.csv"}), "$/good.csv"},
        {"HoldOutMissing", calibrateWith({"--hold-out", "$/no.sto"}), "$/no.sto"},
        {"PriorOfNothing", calibrateWith({"--prior", "TRI.radius=1:2"}), "TRI.radius"},
        {"PriorWithoutMean", calibrateWith({"--prior", "hand.mass=1"}), "NAME=NUMBER:NUMBER"},
        {"PriorTwice", calibrateWith({"--prior", "hand.mass=1:2,hand.mass=1:3"}), "twice"},
        {"PriorZero", calibrateWith({"--prior", "hand.mass=0.6:0"}), "hand.mass"},
        {"BoundsExclude", calibrateWith({"--bounds", "hand.mass=1:2"}), "hand.mass"},
        {"BoundsBelowZero", calibrateWith({"--bounds", "hand.mass=-5:5"}),
         "--bounds: lower bound of hand.mass = -5 kg, must be ≥ 0"},
        {"NoiseInfinite", calibrateWith({"--noise-deg", "inf"}),
         "--noise-deg: 'inf' is not a finite number"},
        {"BoundsPutAPointInside",
         calibrateWith({"--bounds", "TRI.radius=0.01:0.022"}, "TRI.radius"),
         "upper bound of TRI.radius = 0.022 m, must be below 0.0206"},
        {"BoundsAreWords", calibrateWith({"--bounds", "hand.mass=low:high"}), "--bounds"},
        {"NoiseZero", calibrateWith({"--noise-deg", "0"}), "--noise-deg"},
        {"NoiseNaN", calibrateWith({"--noise-deg", "nan"}), "noise"},
        {"UnknownLoss", calibrateWith({"--loss", "cauchy"}), "cauchy"},
        {"NoStarts", calibrateWith({"--starts", "0"}), "--starts"},
        {"FewReplicates", calibrateWith({"--bootstrap", "3"}), "--bootstrap"},
        {"ProfileOfNothing", calibrateWith({"--profile", "TRI.radius"}), "TRI.radius"},
        {"OtherIntegrator", calibrateWith({"--integrator", "rk4"}), "vi or vi-left"},
        {"StartOfSeveral", calibrateWith({"emg_data/curl_fast.sto"}, "initial.elbow_flexion"),
         "differs between trials"},
        {"OutIsAFile",
         {"calibrate", model, slow, "--parameters", "hand.mass", "--out", "$/good.csv"},
         "is not a folder"}}),
    nameOf);

/// `fisherhill ensemble` on the shipped trial, with what comes behind.
std::vector<std::string> ensembleWith(std::vector<std::string> more) {
  std::vector<std::string> all = {"ensemble", model, slow, "--out", "$/out"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

INSTANTIATE_TEST_SUITE_P(
    Ensemble, EveryMistake,
    testing::ValuesIn(std::vector<Mistake>{
        {"NoTrial", {"ensemble", model, "--out", "$/out"}, "TRIAL is required"},
        {"NoDraws", ensembleWith({"--draws", "0"}), "--draws"},
        {"UnknownParameter", ensembleWith({"--parameters", "TRI.radios"}),
         "no parameter is called 'TRI.radios'; nearest: TRI.radius"},
        {"UnknownDistribution", ensembleWith({"--distribution", "cauchy"}), "cauchy"},
        {"NoSpread", ensembleWith({"--spread", "0"}), "--spread"},
        {"PriorOfAnother",
         ensembleWith({"--parameters", "hand.mass", "--prior", "ulna.mass=1:0.1"}),
         "--prior: ulna.mass is not one of the --parameters"},
        {"PriorZero", ensembleWith({"--parameters", "hand.mass", "--prior", "hand.mass=0.5:0"}),
         "hand.mass [kg]: standard deviation = 0 must be > 0"},
        {"BoundsPutAPointInside",
         ensembleWith({"--parameters", "TRI.radius", "--bounds", "TRI.radius=0.01:0.022"}),
         "--bounds: TRI.radius = 0.022 m, must be below 0.0206"},
        {"BoundsExclude", ensembleWith({"--parameters", "hand.mass", "--bounds", "hand.mass=2:3"}),
         "must lie within 2 and 3"},
        {"SobolOfAll", ensembleWith({"--sobol"}), "--sobol: 285 parameters, at most 32"},
        {"SobolOfOnePoint", ensembleWith({"--sobol", "--draws", "1", "--parameters", "hand.mass"}),
         "--draws must be at least 2"},
        {"NothingMeasured",
         {"ensemble", model, "$/good.csv", "--sobol", "--output", "rms_error", "--parameters",
          "hand.mass", "--out", "$/out"},
         "$/good.csv has no measured elbow_flexion"},
        {"UnknownOutput", ensembleWith({"--output", "speed"}), "--output"},
        {"TrialAndSets", ensembleWith({"--discover", "$"}),
         "TRIAL cannot be combined with --discover"},
        {"NoSets",
         {"ensemble", model, "--discover", "$", "--out", "$/out"},
         "no subfolder has files train_*.sto"},
        {"SetsWithoutOut", {"ensemble", model, "--discover", "$"}, "--discover requires --out"},
        {"DrawsOfSets",
         {"ensemble", model, "--discover", "$", "--draws", "9", "--out", "$/out"},
         "--draws cannot be combined with --discover"},
        {"ScatterOfDraws", ensembleWith({"--input-scatter", "0.1"}),
         "--input-scatter requires --discover"},
        {"NoiseOfDraws", ensembleWith({"--noise-deg", "1"}), "--noise-deg requires --discover"},
        {"BadTrial", {"ensemble", model, "$/nan.csv", "--out", "$/out"}, "$/nan.csv"},
        {"NotAModel", {"ensemble", "$/text.osim", slow}, "$/text.osim"},
        {"OutIsAFile", {"ensemble", model, slow, "--out", "$/good.csv"}, "is not a folder"},
    }),
    nameOf);

INSTANTIATE_TEST_SUITE_P(
    Sensitivity, EveryMistake,
    testing::ValuesIn(std::vector<Mistake>{
        {"NoTrial", {"sensitivity", model, "--all"}, "TRIAL is required"},
        {"NothingToDo", {"sensitivity", model, "$/good.csv"}, "nothing to do: give --all"},
        {"TrialTwice", {"sensitivity", model, slow, slow, "--all"}, "is the same trial as"},
        {"MisspeltOption",
         {"sensitivity", model, slow, "--paremeters", "TRI.radius"},
         "--paremeters, did you mean '--parameters'?"},
        {"MisspeltMuscle",
         {"sensitivity", model, "$/misspelt.csv", "--all"},
         "column 'BIClogn' is neither"},
        {"UnknownParameter",
         {"sensitivity", model, "$/good.csv", "--parameters", "TRI.radios"},
         "no parameter is called 'TRI.radios'; nearest: TRI.radius"},
        {"OutsideItsBounds",
         {"sensitivity", model, "$/good.csv", "--parameter", "TRI.radius", "--values", "0.2"},
         "TRI.radius = 0.2 m, must be 0.0048 to 0.0205 m: TRIlong's path point"},
        {"NoValues",
         {"sensitivity", model, "$/good.csv", "--parameter", "TRI.radius"},
         "--parameter and --values require each other"},
        {"NegativeNoise",
         {"sensitivity", model, "$/good.csv", "--all", "--noise", "-1"},
         "--noise: -1 deg, must be > 0"},
        {"ProfileOfAnother",
         {"sensitivity", model, "$/good.csv", "--parameters", "TRI.radius", "--profile",
          "hand.mass", "--out", "$/out"},
         "hand.mass is not one of the --parameters"},
        {"GlobalOverAll",
         {"sensitivity", model, "$/good.csv", "--parameters", "*", "--global", "sobol"},
         "285 parameters, at most 32"},
        {"OtherIntegrator",
         {"sensitivity", model, "$/good.csv", "--all", "--integrator", "rk4"},
         "--integrator rk4"},
    }),
    nameOf);

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

std::vector<std::string> designWith(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"design", model, "emg_data/curl_slow.sto", "--parameters",
                                        "TRI.radius"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  arguments.insert(arguments.end(), {"--out", "$/out"});
  return arguments;
}

INSTANTIATE_TEST_SUITE_P(
    Design, EveryMistake,
    testing::ValuesIn(std::vector<Mistake>{
        {"NoParameters", {"design", model, "$/good.csv", "--out", "$/out"}, "--parameters"},
        {"UnknownParameter",
         {"design", model, "$/good.csv", "--parameters", "TRI.raduis", "--out", "$/out"},
         "TRI.raduis"},
        {"ParametersAndSeparate", designWith({"--separate", "visc,coulomb"}), "not both"},
        {"SizeOfNothing", designWith({"--size", "visc=1"}), "--size requires --separate"},
        {"SeparateOne",
         {"design", model, "$/good.csv", "--separate", "visc", "--out", "$/out"},
         "--separate: 1 effects"},
        {"SeparateUnknown",
         {"design", model, "$/good.csv", "--separate", "visc,ghost", "--out", "$/out"},
         "no effect is called 'ghost'"},
        {"SizeOfAnother",
         {"design", model, "$/good.csv", "--separate", "visc,coulomb", "--size", "drag=1", "--out",
          "$/out"},
         "--size: 'drag' is not one of --separate"},
        {"SizeZero",
         {"design", model, "$/good.csv", "--separate", "visc,coulomb", "--size", "visc=0", "--out",
          "$/out"},
         "--size: visc=0"},
        {"SeparateWithMonteCarlo",
         {"design", model, "$/good.csv", "--separate", "visc,coulomb", "--monte-carlo", "5",
          "--out", "$/out"},
         "cannot be combined with --separate"},
        {"UnknownNuisance", designWith({"--nuisance", "foot.mass"}), "foot.mass"},
        {"NoiseZero", designWith({"--noise", "0"}), "--noise"},
        {"NoiseNaN", designWith({"--noise", "nan"}), "--noise"},
        {"RateNegative", designWith({"--rate", "-1"}), "--rate"},
        {"TorqueNegative", designWith({"--torque", "-1"}), "--torque"},
        {"TorqueRateZero", designWith({"--torque-rate", "0"}), "--torque-rate"},
        {"NothingToChange", designWith({"--torque", "0"}), "--torque"},
        {"UnknownMuscle", designWith({"--excite", "GLUTmax"}), "GLUTmax"},
        {"MuscleTwice", designWith({"--excite", "BRA,BRA+BRD"}), "BRA"},
        {"ExcitationAboveOne", designWith({"--excitation-max", "1.5"}), "--excitation-max"},
        {"RangeBackwards", designWith({"--range", "90deg,10deg"}), "--range"},
        {"RangeOfWords", designWith({"--range", "low,high"}), "--range"},
        {"SpeedZero", designWith({"--speed", "0"}), "--speed"},
        {"SurpriseNegative", designWith({"--surprise", "-1"}), "--surprise"},
        {"KnotsZero", designWith({"--knots", "0"}), "--knots"},
        {"OtherIntegrator", designWith({"--integrator", "rk4"}), "--integrator"},
        {"UnknownCriterion", designWith({"--criterion", "G"}), "--criterion"},
        {"PriorOfAnother", designWith({"--prior", "hand.mass=0.1"}), "hand.mass"},
        {"PriorZero", designWith({"--prior", "TRI.radius=0"}), "--prior"},
        {"CandidatesNegative", designWith({"--candidates", "-1"}), "--candidates"}}),
    nameOf);

/// `fisherhill discover` on a good trial, with what comes behind.
std::vector<std::string> discover(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"discover", model, "emg_data/hidden_a/train_1.sto"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  arguments.insert(arguments.end(), {"--out", "$/out"});
  return arguments;
}

INSTANTIATE_TEST_SUITE_P(
    Discover, EveryMistake,
    testing::ValuesIn(std::vector<Mistake>{
        {"NoTrial", {"discover", model, "--out", "$/out"}, "TRIAL"},
        {"NothingMeasured",
         {"discover", model, "$/good.csv", "--out", "$/out"},
         "$/good.csv: no measured value of 'elbow_flexion'"},
        {"SameTrialTwice", discover({"emg_data/hidden_a/train_1.sto"}), "is the same trial as"},
        {"HoldOutIsFitted", discover({"--hold-out", "emg_data/hidden_a/train_1.sto"}),
         "is held out and also used for estimation"},
        {"UnknownEffect", discover({"--without", "ghost"}), "no effect is called 'ghost'"},
        {"TwoCoordinates", discover({"--coordinate", "elbow_flexion,pro_sup"}), "must be one"},
        {"OtherIntegrator", discover({"--integrator", "cvode"}), "vi or vi-left"},
        {"NoiseBelowZero", discover({"--noise-deg", "-1"}), "--noise-deg"},
        {"ScatterBelowZero", discover({"--input-scatter", "-0.1"}), "--input-scatter"},
        {"ScatterNaN", discover({"--input-scatter", "nan"}), "--input-scatter: nan"},
        {"FourEffects", discover({"--max-effects", "4"}), "--max-effects"},
        {"ResultIsTheModel",
         {"discover", "$/with_effect.osim", "emg_data/hidden_a/train_1.sto", "--out", "$",
          "--force"},
         "$/with_effect.osim: is an input and would be overwritten"}}),
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
