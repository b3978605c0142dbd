#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

// An elbow with an orthosis: a motor and a rubber band, whose numbers a trial tells.
namespace {

using support::contentOf;
using support::linesOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

std::string orthosis(const ScratchFolder& scratch, const std::string& name, double motor,
                     double band) {
  std::string text = contentOf(std::string(FISHERHILL_SOURCE_DIR) + "/" + support::model);
  const std::string at = "<ForceSet name=\"forceset\">\n\t\t\t<objects>";
  const std::string forces = fmt::format(
      "<CoordinateActuator name=\"motor\"><coordinate>elbow_flexion</coordinate>"
      "<optimal_force>{}</optimal_force></CoordinateActuator>"
      "<PointToPointSpring name=\"band\"><socket_body1>/bodyset/humerus</socket_body1>"
      "<socket_body2>/bodyset/ulna</socket_body2><point1>0.03 -0.1 0</point1>"
      "<point2>0.02 -0.15 0</point2><stiffness>{}</stiffness><rest_length>0.1</rest_length>"
      "</PointToPointSpring>",
      motor, band);
  const std::size_t place = text.find(at);
  EXPECT_NE(place, std::string::npos);
  text.insert(place + at.size(), forces);
  return scratch.file(name, text);
}

std::string row(int k) {
  const double t = 0.01 * k;
  return fmt::format("{},{:.6f},{:.6f},{:.6f}", t, 0.05 + 0.03 * std::sin(3 * t), 0.04,
                     std::sin(5 * t));
}

/// What the model does, as a recording of it.
std::string recordedMotion(const ScratchFolder& scratch, const std::string& model) {
  std::string driven = "time,BIClong,BRA,motor\n",
              measured = "time,BIClong,BRA,motor,elbow_flexion\n";
  for (int k = 0; k <= 150; ++k) driven += row(k) + "\n";
  const std::string out = (scratch / "true").string();
  const ProgramResult result = runFisherHill({"replay", model, scratch.file("driven.csv", driven),
                                              "--initial", "elbow_flexion=60deg", "--out", out});
  EXPECT_EQ(result.status, 0) << result.err;
  int k = 0;
  std::ptrdiff_t place = -1;
  for (const std::string& line : linesOf(contentOf(out + "/states.sto"))) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, '\t');) cells.push_back(cell);
    if (place >= 0) measured += row(k++) + "," + cells.at(static_cast<std::size_t>(place)) + "\n";
    const auto at = std::find(cells.begin(), cells.end(), "/jointset/elbow/elbow_flexion/value");
    if (at != cells.end()) place = at - cells.begin();
  }
  EXPECT_EQ(k, 151);
  return scratch.file("recorded.csv", measured);
}

TEST(CalibrateForces, FindsTheStrengthOfAMotorAndTheStiffnessOfABand) {
  const ScratchFolder scratch;
  const std::string trial = recordedMotion(scratch, orthosis(scratch, "true.osim", 2, 60));
  const std::string guess = orthosis(scratch, "guess.osim", 1.4, 45);
  const std::string out = (scratch / "out").string();
  const ProgramResult result =
      runFisherHill({"calibrate", guess, trial, "--parameters",
                     "motor.optimal_force,band.stiffness", "--step", "0.01", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(contentOf(out + "/summary.json"));
  EXPECT_NEAR(json["estimates"]["motor.optimal_force"]["value"].get<double>(), 2, 0.01);
  EXPECT_NEAR(json["estimates"]["band.stiffness"]["value"].get<double>(), 60, 0.3);
  EXPECT_EQ(json["estimates"]["motor.optimal_force"]["unit"], "N m");
  const ProgramResult replay = runFisherHill({"replay", out + "/calibrated.osim", trial, "--json"});
  ASSERT_EQ(replay.status, 0) << replay.err;
  EXPECT_LT(nlohmann::json::parse(replay.out)["rms_error_deg"].get<double>(), 0.01);
  EXPECT_THAT(contentOf(out + "/calibrated.osim"), testing::Not(HasSubstr("<stiffness>45<")));

  // with an estimate of the excitation the trial is written anew, with the motor's control
  const std::string driven = (scratch / "driven").string();
  const ProgramResult shaped = runFisherHill({"calibrate", guess, trial, "--parameters",
                                              "motor.optimal_force,band.stiffness,emg.gain",
                                              "--step", "0.01", "--out", driven});
  ASSERT_EQ(shaped.status, 0) << shaped.err;
  const auto again =
      runFisherHill({"replay", driven + "/calibrated.osim", driven + "/driven_1.sto", "--json"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_LT(nlohmann::json::parse(again.out)["rms_error_deg"].get<double>(), 0.02);
}

TEST(CalibrateForces, EnsemblesAndSensitivitiesKnowThem) {
  const ScratchFolder scratch;
  const std::string model = orthosis(scratch, "true.osim", 2, 60);
  const std::string trial = recordedMotion(scratch, model);
  const ProgramResult list =
      runFisherHill({"sensitivity", model, trial, "--list-parameters", "--json"});
  ASSERT_EQ(list.status, 0) << list.err;
  for (const char* name : {"motor.optimal_force", "band.stiffness", "band.rest_length"}) {
    EXPECT_THAT(list.out, HasSubstr(name));
  }
  const std::string out = (scratch / "out").string();
  const ProgramResult ensemble =
      runFisherHill({"ensemble", model, trial, "--draws", "20", "--parameters",
                     "motor.optimal_force", "--out", out});
  ASSERT_EQ(ensemble.status, 0) << ensemble.err;
  const ProgramResult sensitivity = runFisherHill({"sensitivity", model, trial, "--parameters",
                                                   "motor.optimal_force,band.stiffness", "--json"});
  ASSERT_EQ(sensitivity.status, 0) << sensitivity.err;
}

}  // namespace
