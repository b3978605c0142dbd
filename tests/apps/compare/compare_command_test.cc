#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/reference.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

namespace {

using support::linesOf;
using support::model;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

/// A third of a second of biceps, with a measured angle.
std::string shortTrial(const ScratchFolder& scratch, bool measured = true) {
  std::ostringstream text;
  text << "time,BIClong,BRA" << (measured ? ",elbow_flexion_deg" : "") << "\n";
  for (int k = 0; k <= 30; ++k) {
    text << 0.01 * k << ',' << 0.05 + 0.003 * k << ",0.05";
    if (measured) text << ',' << 30 + 0.1 * k;
    text << '\n';
  }
  return scratch.file(measured ? "trial.csv" : "unmeasured.csv", text.str());
}

TEST(CompareCommand, SaysWhatTheMusclesClassAloneChanges) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill({"compare", model, shortTrial(scratch), "--muscles",
                                              "Schutte1993,Thelen2003,RigidTendon", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto lines = linesOf(support::contentOf(out + "/muscles.csv"));
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_THAT(lines[1], testing::StartsWith("as in the model,ok,0,0,"));
  EXPECT_THAT(lines[2], testing::StartsWith("Schutte1993,ok,0,0,"));  // what it was
  const auto json = nlohmann::json::parse(support::contentOf(out + "/summary.json"));
  const auto& classes = json["muscle_classes"];
  for (const std::size_t i : {2u, 3u}) {
    const double rms = classes[i]["measured_rms_deg"];
    EXPECT_GT(rms, 0.01) << i;
    EXPECT_LT(classes[i]["unexplained_rms_deg"], rms) << i;
    EXPECT_GT(classes[i]["lost"].size(), 0u);
  }
  EXPECT_EQ(linesOf(support::contentOf(out + "/muscle_bounds.csv")).size(), 1u + 3 * 8);
  const ProgramResult refused =
      runFisherHill({"compare", model, shortTrial(scratch), "--muscles", "Hill", "--json"});
  EXPECT_EQ(refused.status, 2);
}

TEST(CompareCommand, WritesTheTableTheSummaryAndTheReport) {
  const ScratchFolder scratch;
  const std::string trial = shortTrial(scratch);
  const std::string states = scratch.file(
      "states.csv", "time,/jointset/elbow/elbow_flexion/value\n0,0.52\n0.1,0.52\n0.2,0.53\n");
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill({"compare", model, trial, "--integrators",
                                              "rk4,vi,cvode", "--steps", "0.0002,0.002", "--step",
                                              "0.01", "--also", "OpenSim=" + states, "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;

  const auto lines = linesOf(support::contentOf(out + "/compare.csv"));
  ASSERT_EQ(lines.size(), 10u);
  EXPECT_EQ(lines[0],
            "integrator,step_s,status,failed_at_s,rms_deg,max_deg,wall_ms,newton_per_step,"
            "energy_error_J");
  EXPECT_THAT(lines[1], testing::StartsWith("rk4,0.0002,ok,,"));
  EXPECT_THAT(lines[2], testing::MatchesRegex("rk4,0.002,unstable,[0-9.e-]+,,,,0,"));
  EXPECT_THAT(lines[6], testing::StartsWith("vi,0.01,ok,,"));
  EXPECT_THAT(lines[9], testing::StartsWith("cvode,0.01,ok,,"));
  for (const std::string& line : lines) EXPECT_EQ(std::count(line.begin(), line.end(), ','), 8);

  const auto json = nlohmann::json::parse(support::contentOf(out + "/summary.json"));
  EXPECT_EQ(json["integrator"], "vi");
  EXPECT_EQ(json["step_s"], 0.01);
  EXPECT_NEAR(json["duration_s"].get<double>(), 0.3, 1e-12);
  std::istringstream row(lines[6]);
  std::vector<std::string> chosen;
  for (std::string cell; std::getline(row, cell, ',');) chosen.push_back(cell);
  EXPECT_NEAR(json["wall_s"].get<double>() / (1e-3 * std::stod(chosen.at(6))), 1, 1e-6);
  EXPECT_LT(json["wall_s"].get<double>(), result.seconds);
  EXPECT_LT(json["largest_stable_step_s"]["rk4"].get<double>(), 0.002);
  EXPECT_GE(json["largest_stable_step_s"]["vi"].get<double>(), 0.01);
  EXPECT_NEAR(json["observed_order"]["vi"].get<double>(), 2, 0.3);
  EXPECT_TRUE(json["observed_order"]["vi-left"].is_null());
  EXPECT_GT(json["also_OpenSim_rms_deg"].get<double>(), 0);
  EXPECT_EQ(json["inputs"].size(), 3u);
  EXPECT_EQ(json["reference_status"], "confirmed");
  EXPECT_LT(json["reference_second_rms_deg"].get<double>(), 0.05);

  const std::string report = support::contentOf(out + "/report.html");
  for (const char* title :
       {"Work and precision", "Error against step", "Where the runs ended",
        "Runge–Kutta at three steps", "The variational integrator at two steps",
        "Comparison with the measured motion", "Comparison with other programs"}) {
    EXPECT_THAT(report, HasSubstr(title));
  }
}

// The elbow as OpenSim 4.6 moved it, in the columns its own states files have.
TEST(CompareCommand, LaysOpenSimsStatesBesideOurs) {
  const std::filesystem::path openSims =
      bio::fixtures::reference("opensim/motion_Schutte1993_101.csv");
  const ScratchFolder scratch;
  std::istringstream rows(support::contentOf(openSims));
  std::string row, states;
  std::getline(rows, row);
  int count = 0;
  for (; std::getline(rows, row); ++count) {
    const std::size_t time = row.find(','), angle = row.find(',', time + 1),
                      speed = row.find(',', angle + 1);
    states += row.substr(0, time) + '\t' + row.substr(time + 1, angle - time - 1) + '\t' +
              row.substr(angle + 1, speed - angle - 1) + '\n';
  }
  const std::string file = scratch.file(
      "states.sto",
      "ModelStates\nversion=3\ninDegrees=no\nDataType=double\nOpenSimVersion=4.6\nnRows=" +
          std::to_string(count) +
          "\nnColumns=3\nendheader\ntime\t/jointset/elbow/elbow_flexion/value\t"
          "/jointset/elbow/elbow_flexion/speed\n" +
          states);
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runFisherHill(
      {"compare", model, bio::fixtures::reference("opensim/excitations_101.sto").string(),
       "--initial", "elbow_flexion=0.6", "--integrators", "vi", "--steps", "0.01", "--also",
       "OpenSim=" + file, "--also", "table=" + openSims.string(), "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(support::contentOf(out + "/summary.json"));
  EXPECT_LT(json["also_OpenSim_rms_deg"].get<double>(), 1e-3);
  EXPECT_EQ(json["also_OpenSim_rms_deg"], json["also_table_rms_deg"]);
  EXPECT_THAT(support::contentOf(out + "/report.html"),
              HasSubstr("Comparison with other programs"));
}

TEST(CompareCommand, DrawsItsFiguresAsPngFiles) {
  if (support::runProgram({"sh", "-c", "command -v rsvg-convert"}).status != 0)
    GTEST_SKIP() << "rsvg-convert is not installed (librsvg2-bin)";
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result =
      runFisherHill({"compare", model, shortTrial(scratch), "--integrators", "vi", "--steps",
                     "0.002,0.01", "--png", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto files = nlohmann::json::parse(support::contentOf(out + "/summary.json"))["files"];
  for (const char* name : {"work_and_precision.png", "error_against_step.png",
                           "the_variational_integrator_at_two_steps.png"}) {
    EXPECT_TRUE(support::contentOf(out + "/" + name).starts_with("\x89PNG")) << name;
    EXPECT_NE(std::find(files.begin(), files.end(), name), files.end()) << name;
  }
}

TEST(CompareCommand, LeavesOutFiguresThatHaveNothingToShow) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result =
      runFisherHill({"compare", model, shortTrial(scratch, false), "--integrators", "vi-left",
                     "--steps", "0.01", "--initial", "elbow_flexion=40deg", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string report = support::contentOf(out + "/report.html");
  EXPECT_THAT(report, HasSubstr("Every run reached the end of the trial."));
  for (const char* title : {"Runge–Kutta at three steps", "Comparison with the measured motion",
                            "Comparison with other programs"}) {
    EXPECT_THAT(report, testing::Not(HasSubstr(title)));
  }
  const auto json = nlohmann::json::parse(support::contentOf(out + "/summary.json"));
  EXPECT_EQ(json["integrator"], "vi-left");
  EXPECT_TRUE(json["largest_stable_step_s"]["rk4"].is_null());
}

TEST(CompareCommand, TellsWrongUseInOneLine) {
  const ScratchFolder scratch;
  const std::string trial = shortTrial(scratch);
  const std::string other = scratch.file("other.csv", "time,knee\n0,1\n1,2\n");
  const auto before = scratch.listing();
  const auto fails = [&](std::vector<std::string> arguments, const std::string& message) {
    arguments.insert(arguments.begin(), {"compare", model, trial});
    arguments.insert(arguments.end(), {"--out", (scratch / "out").string()});
    const ProgramResult result = runFisherHill(std::move(arguments));
    EXPECT_EQ(result.status, 2) << message;
    // the trial's warnings may stand before the error
    const std::string error = result.err.substr(result.err.rfind("fisherhill compare: "));
    EXPECT_THAT(error, HasSubstr(message));
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
    EXPECT_EQ(scratch.listing(), before);
  };
  fails({"--integrators", ""}, "--integrators");
  fails({"--integrators", "rk4,euler"}, "'euler', must be rk4, vi, vi-left, vi-adaptive or cvode");
  fails({"--integrators", "vi,vi"}, "twice");
  fails({"--steps", ""}, "--steps");
  fails({"--steps=-0.01"}, "--steps: -0.01 s, must be > 0");
  fails({"--steps", "nan"}, "--steps");
  fails({"--steps", "0.01,0.005"}, "--steps: 0.005 s after 0.01 s, must rise");
  fails({"--steps", "0.01,0.5"}, "must not exceed the duration");
  fails({"--also", "states.sto"}, "--also: 'states.sto' must be NAME=FILE");
  fails({"--also", "OpenSim=" + other}, other + ": no column of coordinate 'elbow_flexion'");
  fails({"--also", "OpenSim=/no/such.sto"}, "/no/such.sto");
  fails({"--step", "-1"}, "--step");
}

}  // namespace
