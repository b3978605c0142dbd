#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

// What a command must not pass over in silence: models and trials that look usable and are not.
namespace {

using nlohmann::json;
using support::model;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using support::slow;
using testing::HasSubstr;
using testing::Not;

std::string sourceText(const std::string& file) {
  return support::contentOf(std::string(FISHERHILL_SOURCE_DIR "/") + file);
}

/// The text with every `from` replaced, at least one.
std::string with(std::string text, const std::string& from, const std::string& to) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size(), ++count) {
    text.replace(at, from.size(), to);
  }
  EXPECT_GT(count, 0u) << from;
  return text;
}

/// A trial of the elbow: one excitation and a measured column, 30 rows.
std::string trialWith(const std::string& column, double first, double perRow,
                      const std::string& header = "", double interval = 0.01) {
  std::string text = header.empty() ? "" : "trial\nversion=1\n" + header + "\nendheader\n";
  const char separator = header.empty() ? ',' : '\t';
  text += std::string("time") + separator + "BRA" + separator + column + "\n";
  for (int k = 0; k < 30; ++k) {
    text += std::to_string(k * interval) + separator + "0.1" + separator +
            std::to_string(first + k * perRow) + "\n";
  }
  return text;
}

struct Told : testing::Test {
  ScratchFolder scratch;

  ProgramResult replay(const std::string& modelFile, const std::string& trial,
                       std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"replay", modelFile, trial, "--json"});
    return runFisherHill(more);
  }
};

// --- measured, but not free

TEST_F(Told, AMeasuredCoordinateThatIsHeldElsewhereIsRefusedWithAdvice) {
  const std::string trial = scratch.file("up.csv", trialWith("shoulder_elv_deg", 80, 0.5));
  for (const char* command :
       {"replay", "compare", "sensitivity", "calibrate", "ensemble", "design", "discover"}) {
    std::vector<std::string> words = {command, model, trial};
    if (command != std::string("replay") && command != std::string("compare")) {
      words.insert(words.end(), {"--parameters", "hand.mass"});
    }
    if (command == std::string("discover")) words.resize(3);
    const ProgramResult result = runFisherHill(words);
    EXPECT_EQ(result.status, 2) << command;
    EXPECT_THAT(result.err,
                HasSubstr(trial + ": 'shoulder_elv' is measured, 80 to 94.5 deg, but is not free "
                                  "and would be held at 0: --lock shoulder_elv=87.25deg holds it "
                                  "at its mean, --coordinate shoulder_elv frees it"))
        << command;
  }
  const ProgramResult locked = replay(model, trial, {"--lock", "shoulder_elv=87.25deg"});
  EXPECT_EQ(locked.status, 0) << locked.err;
  EXPECT_THAT(locked.err, HasSubstr("is measured, 80 to 94.5 deg, and held at 87.25 as requested"));
  const ProgramResult resting =
      replay(model, scratch.file("rest.csv", trialWith("shoulder_elv_deg", 0.05, 0)));
  EXPECT_EQ(resting.status, 0) << resting.err;
  EXPECT_THAT(resting.err, Not(HasSubstr("shoulder_elv")));
}

// --- a motion that leaves what the model is made for

TEST_F(Told, AMotionThatLeavesItsRangeHasAStatusOfItsOwn) {
  const std::string trial =
      scratch.file("strong.csv", "time,BIClong,BRA,BRD\n0,0.01,0.01,0.01\n0.2,1,1,1\n3,1,1,1\n");
  const ProgramResult result = replay(model, trial, {"--initial", "elbow_flexion=90deg"});
  EXPECT_EQ(result.status, 0) << result.err;
  const json summary = json::parse(result.out);
  EXPECT_EQ(summary["status"], "left_range");
  EXPECT_GT(summary["left_range_at_s"].get<double>(), 0);
  EXPECT_THAT(result.err, HasSubstr("elbow_flexion leaves its range, 0 to 130 deg, by more than a "
                                    "tenth of it at "));
  EXPECT_EQ(replay(model, trial, {"--initial", "elbow_flexion=90deg", "--strict"}).status, 1);
  const ProgramResult words =
      runFisherHill({"replay", model, trial, "--initial", "elbow_flexion=90deg"});
  EXPECT_THAT(words.out, testing::StartsWith("The motion leaves the valid range of the model: "));
  // one that stays within is "ok", strict or not
  const ProgramResult usual = replay(model, slow, {"--strict"});
  EXPECT_EQ(usual.status, 0);
  EXPECT_EQ(json::parse(usual.out)["status"], "ok");

  const ProgramResult sensitivity =
      runFisherHill({"sensitivity", model, trial, "--parameters", "hand.mass", "--initial",
                     "elbow_flexion=90deg"});
  EXPECT_THAT(sensitivity.err, HasSubstr("warning: elbow_flexion leaves its range"));
  const ProgramResult ensemble =
      runFisherHill({"ensemble", model, trial, "--parameters", "hand.mass", "--initial",
                     "elbow_flexion=90deg", "--draws", "4"});
  EXPECT_THAT(ensemble.err, HasSubstr("with the model's own parameters, elbow_flexion leaves"));
  EXPECT_THAT(ensemble.err, HasSubstr("in 4 of 4 simulations elbow_flexion leaves its range"));
}

// --- models that are not physical

TEST_F(Told, ModelsThatAreNotPhysicalAreRefusedByElement) {
  const std::string text = sourceText(model);
  const std::string heavy =
      scratch.file("heavy.osim", with(text, "<gravity>0 -9.80665 0<", "<gravity>0 -1e308 0<"));
  const ProgramResult gravity = replay(heavy, slow);
  EXPECT_EQ(gravity.status, 2);
  EXPECT_THAT(gravity.err, HasSubstr("gravity = (0, -1e+308, 0) m/s², must be at most 10000 m/s²"));

  std::string massless = text;
  for (const char* mass : {"1.1053", "0.23359", "0.0001", "0.5819"}) {
    massless = with(massless, std::string("<mass>") + mass + "<", "<mass>0<");
  }
  for (const char* inertia :
       {"0.00541309 0.00115318 0.00494361 0.00031686 -7.615e-05 0.00109169",
        "0.00043855 8.859e-05 0.00040258 3.014e-05 -4.24e-06 6.418e-05", "1e-05 1e-05 1e-05 0 0 0",
        "0.00011 6e-05 0.00015 9e-07 -2e-07 1.2e-05"}) {
    massless = with(massless, std::string("<inertia>") + inertia + "<", "<inertia>0 0 0 0 0 0<");
  }
  const std::string light = scratch.file("light.osim", massless);
  const ProgramResult nothing = replay(light, slow);
  EXPECT_EQ(nothing.status, 2);
  EXPECT_THAT(nothing.err, HasSubstr(light + ": coordinate 'elbow_flexion' moves no mass (inertia "
                                             "= 0 kg m²), must move some"));
  const ProgramResult checked = runFisherHill({"check", light});
  EXPECT_THAT(checked.out, HasSubstr("no coordinate that is not locked moves a mass"));

  const std::string inverse = scratch.file(
      "inverse.osim", with(text, "<inertia>0.00011 6e-05 0.00015 9e-07 -2e-07 1.2e-05<",
                           "<inertia>0.00011 6e-05 0.00015 0.001 -2e-07 1.2e-05<"));
  const ProgramResult negative = replay(inverse, slow);
  EXPECT_EQ(negative.status, 2);
  EXPECT_THAT(negative.err,
              HasSubstr(inverse + ": body 'hand': least principal moment of inertia = -0.0009"));
  const ProgramResult found = runFisherHill({"check", inverse});
  EXPECT_EQ(found.status, 1);
  EXPECT_THAT(found.out, HasSubstr("error: " + inverse + ": body 'hand': least principal"));
}

// --- names that no table of results could hold

TEST_F(Told, NamesThatCannotBeWrittenAreRefusedWhereTheyAreRead) {
  for (const char* name : {"BRA,2", "BRA&quot;", "BRA&#10;2", "BRA&#9;2", " BRA"}) {
    const std::string file = scratch.file("named.osim", with(sourceText(model), "name=\"BRA\"",
                                                             std::string("name=\"") + name + "\""));
    for (const ProgramResult& result :
         {runFisherHill({"check", file, "--json"}), runFisherHill({"replay", file, slow})}) {
      EXPECT_THAT(result.out + result.err, HasSubstr("its name must be without comma, quote, tab"))
          << name;
      EXPECT_THAT(result.out + result.err, testing::ContainsRegex("named.osim:[0-9]+: ")) << name;
    }
  }
}

// --- headers

TEST_F(Told, HeaderLinesThatMeanNothingAreTold) {
  const auto run = [&](const std::string& line) {
    return replay(model, scratch.file("t.sto", trialWith("elbow_flexion_deg", 30, 0.1, line)));
  };
  const ProgramResult known = run("known_mass_in_hand_kgs=1");
  EXPECT_EQ(known.status, 2);
  EXPECT_THAT(
      known.err,
      HasSubstr("header: 'known_mass_in_hand_kgs' is unknown, must be known_mass_in_hand_kg or "
                "known_arm_turn_deg, did you mean 'known_mass_in_hand_kg'?"));
  for (const std::string key : {"in_degrees", "inDegree", "degrees"}) {
    const ProgramResult result = run(key + "=yes");
    EXPECT_EQ(result.status, 0);
    EXPECT_THAT(result.err,
                HasSubstr("header: '" + key + "' is unknown, did you mean 'inDegrees'?"));
  }
  EXPECT_EQ(run("author=somebody").err.find("header"), std::string::npos);
}

// --- units

TEST_F(Told, DegreesUnderARadiansNameAreRefusedAndMillisecondsTold) {
  const std::string degrees = scratch.file("deg.csv", trialWith("elbow_flexion", 30, 0.5));
  for (const std::string command : {"replay", "compare"}) {
    const ProgramResult result = runFisherHill({command, model, degrees});
    EXPECT_EQ(result.status, 2) << command;
    EXPECT_THAT(result.err, HasSubstr(degrees + ": measured 'elbow_flexion': values = 30 to 44.5 "
                                                "rad, must be within ±2π or the model's range"));
  }
  const ProgramResult checked = runFisherHill({"check", model, degrees});
  EXPECT_EQ(checked.status, 1);
  EXPECT_THAT(checked.out, HasSubstr("degrees stand in a column 'elbow_flexion_deg'"));
  const std::string slowly =
      scratch.file("ms.csv", trialWith("elbow_flexion_deg", 60, 0.1, "", 10.0));
  const ProgramResult result = replay(model, slowly);
  EXPECT_THAT(result.err, HasSubstr("warning: " + slowly +
                                    ": time: rows are 10 s apart, usually "
                                    "below 0.1 s: milliseconds?"));
}

// --- measured series that say nothing

TEST_F(Told, DegenerateMeasurementsAreToldToBeThat) {
  const std::string still = scratch.file("still.csv", trialWith("elbow_flexion_deg", 60, 0));
  const ProgramResult discover = runFisherHill({"discover", model, still});
  EXPECT_EQ(discover.status, 2);
  EXPECT_THAT(discover.err, HasSubstr(still + ": measured 'elbow_flexion' has the same value in "
                                              "all 30 samples, must change"));
  const std::string few =
      scratch.file("few.csv", "time,BRA,elbow_flexion_deg\n0,0.1,30\n0.1,0.1,31\n0.2,0.1,33\n");
  const ProgramResult discoverFew = runFisherHill({"discover", model, few});
  EXPECT_EQ(discoverFew.status, 2);
  EXPECT_THAT(discoverFew.err, HasSubstr("has 3 measured values, must have at least 20"));
  const ProgramResult calibrate =
      runFisherHill({"calibrate", model, few, "--parameters", "hand.mass"});
  EXPECT_THAT(calibrate.err, HasSubstr("warning: " + few + ": measured 'elbow_flexion' has 3"));
}

// --- steps

TEST_F(Told, CalibrateNamesTheTrialWhoseStepsAreTooLong) {
  const std::vector<std::string> words = {"calibrate", model,         slow,  "--parameters",
                                          "hand.mass", "--noise-deg", "0.5", "--step"};
  const auto with = [&](const char* step) {
    std::vector<std::string> all = words;
    all.push_back(step);
    return runFisherHill(all).err;
  };
  EXPECT_THAT(with("0.1"), HasSubstr("warning: " + slow +
                                     ": halving the step of 0.1 s changes the "
                                     "simulated angles by up to "));
  EXPECT_THAT(with("0.01"), Not(HasSubstr("halving the step")));
}

// --- integers

TEST_F(Told, ASeedThatIsTooLargeIsRefused) {
  const ProgramResult result = runFisherHill({"check", model, "--seed", "18446744073709551616"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("18446744073709551616 must be a whole number from 0 to "
                                    "18446744073709551615"));
  EXPECT_EQ(runFisherHill({"check", model, "--seed", "18446744073709551615"}).status, 0);
  for (const char* option : {"--draws", "--threads", "--band-points"}) {
    EXPECT_EQ(runFisherHill({"ensemble", model, slow, option, "4294967297"}).status, 2) << option;
    EXPECT_EQ(runFisherHill({"ensemble", model, slow, option, "18446744073709551617"}).status, 2)
        << option;
  }
}

// --- what a file is of use for

TEST_F(Told, CheckSaysThatAModelWithoutSimulatedMusclesIsOfNoUseForSimulations) {
  const std::string file = scratch.file(
      "other.osim", with(sourceText(model), "Schutte1993Muscle_Deprecated", "MeyerFregly2016Muscle"));
  const ProgramResult result = runFisherHill({"check", file});
  EXPECT_THAT(result.out, Not(HasSubstr("Every file can be used")));
  EXPECT_THAT(result.out,
              HasSubstr("these models cannot be simulated: " + file +
                        " (none of its 8 muscles is of a class that can be simulated)"));
  EXPECT_THAT(runFisherHill({"check", model, slow}).out,
              Not(HasSubstr("these models cannot be simulated")));
}

}  // namespace
