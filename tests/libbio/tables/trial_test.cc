#include "bio/tables/trial.h"

#include <gmock/gmock.h>

#include <numbers>

#include "bio/tables/file_error.h"
#include "bio/tables/trial_table.h"
#include "bio/tables/unknown_column.h"
#include "support/numbers.h"
#include "support/scratch_folder.h"

namespace bio {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

using support::degree;

// Two muscles, one disabled, an elbow and a sliding coordinate: all that a trial asks of a model.
Model twoMuscles() {
  Model model;
  for (const char* name : {"BRA", "TRIlong", "off"}) {
    Muscle muscle;
    muscle.name = name;
    model.muscles.push_back(muscle);
  }
  model.muscles.back().enabled = false;
  Joint joint;
  joint.coordinates.push_back({.name = "elbow_flexion"});
  joint.coordinates.push_back({.name = "drawer", .isRotation = false});
  model.joints.push_back(joint);
  return model;
}

class TrialFile : public testing::Test {
 protected:
  Trial read(const std::string& text, const TrialOptions& options = {},
             const std::string& name = "trial.csv") const {
    return readTrial(folder_.file(name, text), twoMuscles(), options);
  }
  std::string messageOf(const std::string& text) const {
    try {
      read(text);
    } catch (const FileError& error) {
      return std::string(error.what()).substr(folder_.path().string().size() + 1);
    }
    return "read without complaint";
  }
  support::ScratchFolder folder_;
};

TEST_F(TrialFile, TakesExcitationsInTheOrderOfTheModel) {
  const Trial trial = read("time,TRIlong,BRA\n0,0.2,0.5\n1,0.4,1\n");
  EXPECT_THAT(trial.muscles, ElementsAre("BRA", "TRIlong"));
  EXPECT_EQ(trial.excitations(1, 0), 1);
  EXPECT_EQ(trial.excitations(0, 1), 0.2);
  EXPECT_THAT(trial.warnings, SizeIs(0));
  EXPECT_THAT(trial.measured, SizeIs(0));
}

TEST_F(TrialFile, TheEmgOfAMuscleThatIsSwitchedOffComesLast) {
  const Trial trial = read("time,off,TRIlong,BRA\n0,0.3,0.2,0.5\n1,0.7,0.4,1\n");
  EXPECT_THAT(trial.muscles, ElementsAre("BRA", "TRIlong", "off"));
  EXPECT_EQ(trial.excitations(1, 2), 0.7);
  EXPECT_EQ(messageOf("time,off,TRIlong,BRA\n0,1.3,0.2,0.5\n1,0.7,0.4,1\n"),
            "trial.csv: column 'off' at time = 0 s: excitation = 1.3, must be 0 to 1");
}

TEST_F(TrialFile, AKnownMassIsReadOrRefused) {
  const auto text = [](const std::string& value) {
    return "t\nknown_mass_in_hand_kg=" + value +
           "\nendheader\ntime\tBRA\tTRIlong\n0\t0\t0\n1\t0\t0\n";
  };
  const TrialOptions heeds{.experimentalConditions = true};
  EXPECT_EQ(read(text("1.25"), heeds, "t.sto").conditions.massInHand, 1.25);
  EXPECT_FALSE(read(text("0"), {}, "t.sto").conditions.any());
  const Trial turned = read(text("0.5\nknown_arm_turn_deg=-45"), heeds, "t.sto");
  EXPECT_EQ(turned.conditions.massInHand, 0.5);
  EXPECT_DOUBLE_EQ(turned.conditions.armTurn, -std::numbers::pi / 4);
  EXPECT_TRUE(ExperimentalConditions({.armTurn = 0.1}).any());
  EXPECT_EQ(inWords(turned.conditions),
            "with a known mass of 0.5 kg and the limb turned by -45 deg");
  EXPECT_EQ(inWords({0, 0.1}), "with the limb turned by 5.72957795131 deg");
  EXPECT_EQ(inWords({}), "");
  EXPECT_THAT(headerOf(turned.conditions), ElementsAre(std::pair("known_arm_turn_deg", "-45"),
                                                       std::pair("known_mass_in_hand_kg", "0.5")));
  EXPECT_THAT(headerOf({}), SizeIs(0));
  EXPECT_EQ(experimentalConditionsIn(headerOf(turned.conditions)).armTurn,
            turned.conditions.armTurn);
  // whoever would simulate the arm without it must not read the trial at all
  for (const auto& [value, options, message] :
       {std::tuple{"1.25", TrialOptions{}, "recorded with a known mass of 1.25 kg"},
        {"0\nknown_arm_turn_deg=30", TrialOptions{}, "recorded with the limb turned by 30 deg"},
        {"0\nknown_arm_turn_deg=181", heeds,
         "known_arm_turn_deg = '181', must be a number from -180 to 180"},
        {"-1", heeds, "known_mass_in_hand_kg = '-1', must be a number from 0 to 100"},
        {"1 kg", heeds, "'1 kg', must be a number"},
        {"nan", heeds, "'nan', must be a number"},
        {"", heeds, "'', must be a number"}}) {
    try {
      read(text(value), options, "t.sto");
      ADD_FAILURE() << value << " was read";
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message));
    }
  }
}

TEST_F(TrialFile, TheHeaderNamesMusclesWithoutAnElectrode) {
  const auto text = [](const std::string& line) {
    return "t\nlatent_excitation=" + line + "\nendheader\ntime\tBRA\tTRIlong\n0\t0\t0\n1\t0\t0\n";
  };
  EXPECT_THAT(read(text("BRA 1 0.25; TRIlong 0.5 1"), {}, "t.sto").latent,
              ElementsAre(LatentDeclaration{"BRA", 1, 0.25}, LatentDeclaration{"TRIlong", 0.5, 1}));
  EXPECT_THAT(read("time,TRIlong,BRA\n0,0.2,0.5\n1,0.4,1\n").latent, SizeIs(0));
  for (const auto& [line, message] :
       {std::pair{"BRA 1", "header: latent_excitation = 'BRA 1', must be MUSCLE SD KNOTS_S"},
        {"BRa 1 1", "header: latent_excitation: the model has no muscle 'BRa'"},
        {"BRA -1 1", "sd = -1, must be > 0"},
        {"BRA 1 1; BRA 1 1", "'BRA' is given twice"}}) {
    try {
      read(text(line), {}, "t.sto");
      ADD_FAILURE() << line << " was read";
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message));
    }
  }
}

TEST_F(TrialFile, PennationIsAnAngle) {
  const Trial trial =
      read("time,BRA,TRIlong,BRA.pennation_deg,TRIlong.pennation\n0,0,0,18,\n1,0,0,,0.25\n");
  ASSERT_THAT(trial.measured, SizeIs(2));
  EXPECT_EQ(trial.measured[0].what, (Observable{Observable::Kind::pennation, "BRA", 0}));
  EXPECT_NEAR(trial.measured[0].values[0], 18 * degree, 1e-15);
  EXPECT_EQ(trial.measured[1].values[0], 0.25);
  EXPECT_EQ(trial.measured[1].times[0], 1);
  const Trial inDegrees = read(
      "t\ninDegrees=yes\nendheader\ntime\tBRA\tTRIlong\tBRA.pennation\n0\t0\t0\t18\n1\t0\t0\t19\n",
      {}, "t.sto");
  EXPECT_NEAR(inDegrees.measured[0].values[1], 19 * degree, 1e-15);
  EXPECT_THAT(messageOf("time,BRA,TRIlong,BRA.fiber_length_deg\n0,0,0,18\n1,0,0,18\n"),
              HasSubstr("column 'BRA.fiber_length_deg' is neither"));
}

TEST_F(TrialFile, ExcitationIsLinearBetweenRowsAndConstantOutside) {
  const Trial trial = read("time,TRIlong,BRA\n0,0.2,0.5\n2,0.4,1\n3,0.4,0\n");
  EXPECT_DOUBLE_EQ(excitationAt(trial, 0, 0.5), 0.625);
  EXPECT_EQ(excitationAt(trial, 0, 2), 1);
  EXPECT_DOUBLE_EQ(excitationAt(trial, 0, 2.75), 0.25);
  EXPECT_EQ(excitationAt(trial, 0, -1), 0.5);
  EXPECT_EQ(excitationAt(trial, 0, 9), 0);
}

TEST_F(TrialFile, MeasuredAnglesAreRadiansUnlessToldOtherwise) {
  const Trial radians = read("time,BRA,TRIlong,elbow_flexion\n0,0,0,0.5\n1,0,0,0.6\n");
  EXPECT_EQ(radians.measured.at(0).values(1), 0.6);
  const Trial suffix = read("time,BRA,TRIlong,elbow_flexion_deg\n0,0,0,30\n1,0,0,40\n");
  EXPECT_EQ(suffix.measured.at(0).what.object, "elbow_flexion");
  EXPECT_DOUBLE_EQ(suffix.measured.at(0).values(1), 40 * degree);
  const Trial header = read(
      "t\ninDegrees=yes\nendheader\ntime\tBRA\tTRIlong\telbow_flexion\tdrawer\n"
      "0\t0\t0\t30\t0.1\n1\t0\t0\t40\t0.2\n",
      {}, "trial.sto");
  EXPECT_DOUBLE_EQ(header.measured.at(0).values(0), 30 * degree);
  EXPECT_EQ(header.measured.at(1).values(0), 0.1);  // metres stay metres
}

TEST_F(TrialFile, SparseMeasurementsKeepTheirOwnTimes) {
  const Trial trial =
      read("time,BRA,TRIlong,elbow_flexion\n0,0,0,0.5\n0.1,0,0,\n0.2,0,0,NaN\n0.3,0,0,0.8\n");
  EXPECT_THAT(trial.times, SizeIs(4));
  EXPECT_EQ(trial.measured.at(0).times, Eigen::Vector2d(0, 0.3));
  EXPECT_EQ(trial.measured.at(0).values, Eigen::Vector2d(0.5, 0.8));
}

TEST_F(TrialFile, AMuscleWithoutAColumnGetsTheBaselineAndAWarning) {
  const Trial trial = read("time,BRA\n0,0.5\n1,0.5\n");
  EXPECT_EQ(trial.excitations(1, 1), 0.01);
  EXPECT_THAT(trial.warnings,
              ElementsAre(HasSubstr("muscle 'TRIlong' has no column, its excitation is 0.01")));
  EXPECT_EQ(read("time,BRA\n0,0.5\n1,0.5\n", {.baseline = 0.2}).excitations(0, 1), 0.2);
}

TEST_F(TrialFile, ManyMusclesWithoutAColumnAreNamedInOneLine) {
  Model model = twoMuscles();
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
    Muscle muscle;
    muscle.name = name;
    model.muscles.push_back(muscle);
  }
  EXPECT_THAT(readTrial(folder_.file("t.csv", "time,BRA\n0,0.5\n1,0.5\n"), model, {}).warnings,
              ElementsAre(HasSubstr("7 of 8 muscles have no column, their excitation is 0.01: "
                                    "TRIlong, a, b, c, d and 2 more")));
}

TEST_F(TrialFile, ExtraColumnsAreIgnoredOnlyWhenAskedFor) {
  const std::string text = "time,BRA,TRIlong,knee\n0,0.5,0,1\n1,0.5,0,2\n";
  EXPECT_EQ(
      messageOf(text),
      "trial.csv: column 'knee' is neither a muscle nor a coordinate of the model, nor a torque on "
      "one, nor anything else that can be measured, and such columns are not ignored");
  try {
    read(text);
    FAIL() << "taken";
  } catch (const UnknownColumn& error) {
    EXPECT_EQ(error.column(), "knee");
  }
  EXPECT_THAT(read(text, {.ignoreExtra = true}).warnings,
              ElementsAre(HasSubstr("column 'knee' is ignored")));
}

TEST_F(TrialFile, UnderstandsThePathsOfOpenSim4) {
  const Trial trial = read(
      "time,/forceset/BRA,TRIlong,/jointset/elbow/elbow_flexion/value\n0,0.5,0,0.1\n1,0.5,0,0.2\n");
  EXPECT_EQ(trial.excitations(0, 0), 0.5);
  EXPECT_EQ(trial.measured.at(0).what.object, "elbow_flexion");
}

TEST_F(TrialFile, NeedsNoExcitationOfAModelWithoutMuscles) {
  Model model = twoMuscles();
  model.muscles.clear();
  const Trial trial = readTrial(folder_.file("t.csv", "time,drawer\n0,0.1\n1,0.2\n"), model, {});
  EXPECT_EQ(trial.excitations.cols(), 0);
  EXPECT_EQ(trial.excitations.rows(), 2);
  ASSERT_THAT(trial.measured, SizeIs(1));
}

TEST_F(TrialFile, SaysInOneLineWhatIsWrong) {
  EXPECT_EQ(messageOf("time,BRA,TRIlong\n0,0.5,0\n1,1.5,0\n"),
            "trial.csv: column 'BRA' at time = 1 s: excitation = 1.5, must be 0 to 1");
  EXPECT_EQ(messageOf("time,BRA,TRIlong\n0,-0.1,0\n1,1,0\n"),
            "trial.csv: column 'BRA' at time = 0 s: excitation = -0.1, must be 0 to 1");
  EXPECT_EQ(messageOf("time,BRA,TRIlong\n0,,0\n1,1,0\n"),
            "trial.csv: column 'BRA' at time = 0 s: excitation is missing, must be given");
  EXPECT_EQ(messageOf("time,BRA,TRIlong\n0,0,0\n"), "trial.csv: holds 1 row, must hold at least 2");
  EXPECT_EQ(messageOf("time,elbow_flexion\n0,0\n1,0\n"),
            "trial.csv: drives no muscle of the model, must have a column for one");
  EXPECT_EQ(messageOf("time,BRA,elbow_flexion\n0,0,\n1,0,\n"),
            "trial.csv: column 'elbow_flexion' has no value, must have one or be left out");
  EXPECT_EQ(messageOf("time,BRA,elbow_flexion,elbow_flexion_deg\n0,0,0,0\n1,0,0,0\n"),
            "trial.csv: columns 'elbow_flexion' and 'elbow_flexion_deg' both give 'elbow_flexion', "
            "must be one");
  EXPECT_THROW(read("time,BRA\n0,0\n1,0\n", {.baseline = 2}), std::domain_error);
}

TEST(TrialFromTable, IsTheTrialOfAFileWithTheSameColumns) {
  const support::ScratchFolder folder;
  const Table table{"",
                    false,
                    {},
                    {"time", "BRA", "elbow_flexion_deg"},
                    (Eigen::MatrixXd(2, 3) << 0, 0.5, 90, 0.1, 0.25, NAN).finished()};
  const Trial trial = trialFrom(table, "columns", twoMuscles());
  const Trial same = readTrial(
      folder.file("a.csv", "time,BRA,elbow_flexion_deg\n0,0.5,90\n0.1,0.25,\n"), twoMuscles());
  EXPECT_EQ(trial.file, "columns");
  EXPECT_EQ(trial.times, same.times);
  EXPECT_EQ(trial.muscles, same.muscles);
  EXPECT_EQ(trial.excitations, same.excitations);
  ASSERT_THAT(trial.measured, SizeIs(1));
  EXPECT_EQ(trial.measured[0].times, same.measured[0].times);
  EXPECT_EQ(trial.measured[0].values, same.measured[0].values);
}

TEST(TrialFromTable, RefusesTimesThatDoNotRise) {
  for (const double second : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
    const Table table{
        "", false, {}, {"time", "BRA"}, (Eigen::MatrixXd(2, 2) << 0, 0.5, second, 0.25).finished()};
    try {
      trialFrom(table, "columns", twoMuscles());
      ADD_FAILURE() << second;
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), testing::AllOf(testing::StartsWith("columns: time = "),
                                               HasSubstr("s in row 1, must be finite and rise")));
    }
  }
}

}  // namespace
}  // namespace bio
