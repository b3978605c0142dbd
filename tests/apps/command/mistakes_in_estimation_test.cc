#include "apps/command/mistakes.h"

// Mistakes in what estimates, designs and discovers.
namespace mistakes {
namespace {

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
        {"UnknownChannel", ensembleWith({"--observe", "elbow_flexions"}),
         "--observe: 'elbow_flexions' is nothing that can be measured of this model"},
        {"ChannelTwice", ensembleWith({"--observe", "elbow_flexion,elbow_flexion=1deg"}),
         "--observe: 'elbow_flexion' is given twice"},
        {"ChannelOfSets",
         {"ensemble", model, "--discover", "$", "--observe", "elbow_flexion", "--out", "$/out"},
         "--observe cannot be combined with --discover"},
        {"NothingFree", ensembleWith({"--prescribe", "elbow_flexion"}),
         "no coordinate is free to be observed: --observe must name what is"},
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
         "hand.mass is not one of the parameters"},
        {"GlobalOverAll",
         {"sensitivity", model, "$/good.csv", "--parameters", "*", "--global", "sobol"},
         "285 parameters, at most 32"},
        {"OtherIntegrator",
         {"sensitivity", model, "$/good.csv", "--all", "--integrator", "rk4"},
         "--integrator rk4"},
    }),
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
         "--size: 'drag' is not one of the two effects"},
        {"SizeZero",
         {"design", model, "$/good.csv", "--separate", "visc,coulomb", "--size", "visc=0", "--out",
          "$/out"},
         "--size: visc = 0, must not be 0"},
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
        {"RangeBackwards", designWith({"--range", "90deg,10deg"}), "--range: 1.571 to 0.1745 rad"},
        {"RangeOfWords", designWith({"--range", "low,high"}), "--range"},
        {"SpeedZero", designWith({"--speed", "0"}), "--speed"},
        {"SurpriseNegative", designWith({"--surprise", "-1"}), "--surprise"},
        {"KnotsZero", designWith({"--knots", "0"}), "--knots"},
        {"OtherIntegrator", designWith({"--integrator", "rk4"}), "--integrator"},
        {"UnknownCriterion", designWith({"--criterion", "G"}), "--criterion"},
        {"PriorOfAnother", designWith({"--prior", "hand.mass=0.1"}), "hand.mass"},
        {"PriorZero", designWith({"--prior", "TRI.radius=0"}), "--prior: TRI.radius = 0"},
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
        {"NothingInQuestion", discover({"--prescribe", "elbow_flexion"}),
         "no trial measures the moment of one that is prescribed or locked (a column "
         "elbow_flexion.moment)"},
        {"NoiseWithoutAName", discover({"--noise", "0.5"}), "--noise: '0.5' must be NAME=VALUE"},
        {"NoiseOfNothing", discover({"--noise", "ghost=1"}),
         "--noise: 'ghost' is not measured and in question; what is: elbow_flexion"},
        {"NoiseZero", discover({"--noise", "elbow_flexion=0"}),
         "--noise: elbow_flexion = 0, must be > 0"},
        {"NoiseInWords", discover({"--noise", "elbow_flexion=low"}), "--noise: elbow_flexion: "},
        {"NoiseTwice", discover({"--noise", "elbow_flexion=1", "--noise", "elbow_flexion=2"}),
         "--noise: 'elbow_flexion' is given twice"},
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

}  // namespace
}  // namespace mistakes
