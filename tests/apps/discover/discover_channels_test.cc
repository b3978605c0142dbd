#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <sstream>

#include "support/run_program.h"
#include "support/scratch_folder.h"

// What the verdict says of several outputs, of a moment, and of several coordinates.
namespace {

using nlohmann::json;
using support::contentOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

const std::string ankle = std::string(FISHERHILL_SOURCE_DIR) + "/models/ankle_ta.osim";

/// A column of a .sto file whose name ends so.
std::vector<double> columnOf(const std::string& file, const std::string& ending) {
  std::vector<double> values;
  std::ptrdiff_t place = -1;
  for (const std::string& line : support::linesOf(contentOf(file))) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, '\t');) cells.push_back(cell);
    if (place >= 0) values.push_back(std::stod(cells.at(static_cast<std::size_t>(place))));
    const auto at = std::find_if(cells.begin(), cells.end(),
                                 [&](const std::string& cell) { return cell.ends_with(ending); });
    if (place < 0 && at != cells.end()) place = at - cells.begin();
  }
  return values;
}

/// A model with viscous damping added [N·m·s/rad].
std::string damped(const ScratchFolder& scratch, const std::string& model,
                   const std::string& coordinate, double viscosity) {
  std::string text = contentOf(model);
  const auto at = text.find("<objects>", text.find("<ForceSet")) + std::strlen("<objects>");
  text.insert(at, fmt::format("<SpringGeneralizedForce name=\"truth\"><appliesForce>true"
                              "</appliesForce><coordinate>{}</coordinate><stiffness>0</stiffness>"
                              "<rest_length>0</rest_length><viscosity>{}</viscosity>"
                              "</SpringGeneralizedForce>",
                              coordinate, viscosity));
  return scratch.file("truth.osim", text);
}

double excitationAt(double t) {
  return 0.05 + 0.5 * std::pow(std::sin(1.4 * std::numbers::pi * t), 2);
}

/// A contraction while a dynamometer turns the ankle to and fro; the moment is 0 or given, with
/// noise of 0.2 N·m.
void writeDynamometer(const std::string& file, const std::vector<double>& moment) {
  std::ofstream out(file);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.2);
  out << "time,TA,ankle_angle_deg,ankle_angle.moment\n";
  for (std::size_t k = 0; k <= 150; ++k) {
    const double t = 0.01 * static_cast<double>(k);
    out << fmt::format("{:.2f},{:.6f},{:.6f},{:.6f}\n", t, excitationAt(t),
                       -10 + 20 * std::sin(1.4 * std::numbers::pi * t),
                       moment.empty() ? 0 : moment.at(k) + noise(random));
  }
}

TEST(DiscoverChannels, AMomentOnADynamometerShowsWhatTheModelLacks) {
  const ScratchFolder scratch;
  const std::string trial = (scratch / "trial.csv").string(), out = (scratch / "out").string();
  writeDynamometer(trial, {});
  // the model has viscosity, so that of the truth is no candidate; friction is
  std::string text = contentOf(damped(scratch, ankle, "ankle_angle", 0));
  const std::string truth = scratch.file(
      "truth.osim",
      text.replace(text.find("<SpringGeneralizedForce name=\"truth\">"),
                   text.find("</SpringGeneralizedForce>") + 25 -
                       text.find("<SpringGeneralizedForce name=\"truth\">"),
                   "<ExpressionBasedCoordinateForce name=\"truth\"><appliesForce>true"
                   "</appliesForce><coordinate>ankle_angle</coordinate><expression>"
                   "-2*tanh(qdot/0.05)</expression></ExpressionBasedCoordinateForce>"));
  ProgramResult result = runFisherHill(
      {"replay", truth, trial, "--prescribe", "ankle_angle", "--step", "0.0025", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  std::vector<double> moment;
  const std::vector<double> reaction = columnOf(out + "/forces.sto", "ankle_angle.reaction");
  for (std::size_t k = 0; k < reaction.size(); k += (reaction.size() - 1) / 150)
    moment.push_back(-reaction[k]);
  writeDynamometer(trial, moment);
  result = runFisherHill({"discover", ankle, trial, "--prescribe", "ankle_angle", "--noise",
                          "ankle_angle.moment=0.2", "--max-effects", "1", "--out", out, "--force"});
  ASSERT_EQ(result.status, 0) << result.err;
  const json verdict = json::parse(contentOf(out + "/verdict.json"));
  EXPECT_EQ(verdict["verdict"], "named") << verdict["sentence"];
  ASSERT_EQ(verdict["effects"].size(), 1u);
  EXPECT_EQ(verdict["effects"][0]["id"], "coulomb");
  EXPECT_NEAR(verdict["effects"][0]["parameters"]["coulomb.torque"]["value"].get<double>(), 2,
              4 * verdict["effects"][0]["parameters"]["coulomb.torque"]["sd"].get<double>());
  EXPECT_EQ(verdict["outputs"], json::parse(R"([{"name": "ankle_angle.moment", "unit": "N·m",
                                                 "noise_sd": 0.2}])"));
  EXPECT_LT(verdict["gap"]["train"]["rmse_after_Nm"].get<double>(), 0.25);
  EXPECT_EQ(verdict["gap"]["train"]["noise_floor_Nm"], 0.2);
  EXPECT_EQ(verdict["trials"][0]["starts"], json::array());  // nothing is free to start
  EXPECT_FALSE(verdict["trials"][0].contains("start"));
  const json summary = json::parse(contentOf(out + "/summary.json"));
  EXPECT_EQ(summary["outputs"], verdict["outputs"]);
  EXPECT_FALSE(summary.contains("noise_deg"));
  const std::string report = contentOf(out + "/report.html");
  EXPECT_THAT(report, HasSubstr("ankle_angle.moment [N·m]"));
  EXPECT_THAT(report, HasSubstr("--prescribe ankle_angle"));

  // its angle is prescribed, so that the noise of angles is of nothing
  result =
      runFisherHill({"discover", ankle, trial, "--prescribe", "ankle_angle", "--noise-deg", "1"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("the noise of ankle_angle.moment is not given"));
}

/// The elbow's damping is missing; the shoulder swings freely with it.
TEST(DiscoverChannels, TheDampingOfOneJointOfTwoIsNamedForThatJoint) {
  const ScratchFolder scratch;
  const std::string elbow = std::string(FISHERHILL_SOURCE_DIR) + "/models/elbow8.osim";
  const std::string trial = (scratch / "trial.csv").string(), out = (scratch / "out").string();
  const auto write = [&](const std::vector<double>& angle, const std::vector<double>& shoulder) {
    std::ofstream file(trial);
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 0.3);
    file << "time,BIClong,BICshort,BRA,TRIlong"
         << (angle.empty() ? "" : ",elbow_flexion_deg,shoulder_elv_deg") << "\n";
    for (std::size_t k = 0; k <= 90; ++k) {
      const double t = 0.01 * static_cast<double>(k),
                   u = 0.02 + 0.25 * std::pow(std::sin(4 * t), 2);
      file << fmt::format("{:.2f},{:.5f},{:.5f},{:.5f},0.02", t, u, u, u);
      for (const auto* values : {&angle, &shoulder}) {
        if (values->empty()) continue;
        file << fmt::format(",{:.4f}", values->at(k) * 180 / std::numbers::pi + noise(random));
      }
      file << "\n";
    }
  };
  write({}, {});
  const std::vector<std::string> both = {"--coordinate", "elbow_flexion", "--coordinate",
                                         "shoulder_elv"};
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.end(), both.begin(), both.end());
    words.insert(words.end(), {"--out", out, "--force"});
    return runFisherHill(words);
  };
  ProgramResult result =
      run({"replay", damped(scratch, elbow, "elbow_flexion", 0.5), trial, "--initial",
           "elbow_flexion=30deg", "--initial", "shoulder_elv=10deg"});
  ASSERT_EQ(result.status, 0) << result.err;
  write(columnOf(out + "/states.sto", "elbow_flexion/value"),
        columnOf(out + "/states.sto", "shoulder_elv/value"));
  result = run({"discover", elbow, trial, "--noise-deg", "0.3", "--max-effects", "1"});
  ASSERT_EQ(result.status, 0) << result.err;
  const json verdict = json::parse(contentOf(out + "/verdict.json"));
  EXPECT_EQ(verdict["verdict"], "named") << verdict["sentence"];
  ASSERT_EQ(verdict["effects"].size(), 1u);
  const json& effect = verdict["effects"][0];
  EXPECT_EQ(effect["id"], "elbow_flexion.visc");
  const json& viscosity = effect["parameters"]["elbow_flexion.visc.viscosity"];
  EXPECT_NEAR(viscosity["value"].get<double>(), 0.5, 3 * viscosity["sd"].get<double>());
  ASSERT_EQ(effect["moments"].size(), 2u);
  EXPECT_GT(effect["moments"][0]["rms"].get<double>(), 0.1);
  EXPECT_NEAR(effect["moments"][1]["rms"].get<double>(), 0, 1e-6);
  EXPECT_EQ(effect["moments"][0]["motion_rms_deg"], effect["motion_rms_deg"]);
  EXPECT_GT(effect["moments"][1]["motion_rms_deg"].get<double>(), 0.1);

  // errors are in standard deviations of the noise, and output by output in its unit
  const json& gap = verdict["gap"]["train"];
  EXPECT_NEAR(gap["noise_floor_sd"].get<double>(), 1, 1e-12);
  EXPECT_NEAR(gap["rmse_after_sd"].get<double>(), 1, 0.2);
  ASSERT_EQ(verdict["outputs"].size(), 2u);
  double squares = 0;
  for (const json& output : verdict["outputs"]) {
    EXPECT_EQ(output["unit"], "deg");
    EXPECT_NEAR(output["noise_sd"].get<double>(), 0.3, 1e-12);
    squares += std::pow(output["rmse_after"].get<double>() / 0.3, 2) / 2;
  }
  EXPECT_NEAR(std::sqrt(squares), verdict["trials"][0]["rmse_after_sd"].get<double>(), 0.01);
  ASSERT_EQ(verdict["trials"][0]["starts"].size(), 2u);
  EXPECT_EQ(verdict["trials"][0]["starts"][1]["coordinate"], "shoulder_elv");
  EXPECT_NEAR(verdict["trials"][0]["starts"][1]["value"].get<double>(), std::numbers::pi / 18,
              0.02);
  for (const json& muscle : verdict["localisation"]["muscles"])
    EXPECT_TRUE(muscle.contains("axis"));
  const std::string report = contentOf(out + "/report.html");
  for (const char* words :
       {"Score over time, shoulder_elv", "Score over angle and speed, shoulder_elv",
        "Missing force, shoulder_elv", "RMS error (measured − simulated) by output"})
    EXPECT_THAT(report, HasSubstr(words));
  // every output of the first trial before anything else
  for (const char* label : {"elbow_flexion [deg]", "shoulder_elv [deg]"})
    EXPECT_LT(report.find(label), report.find("The motion in three dimensions")) << label;

  // the written model replays so, output by output
  result = run({"replay", out + "/with_effect.osim", trial, "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const json replay = json::parse(result.out);
  for (const json& output : verdict["outputs"]) {
    EXPECT_NEAR(replay["rms_error"][output["name"].get<std::string>()]["value"].get<double>(),
                output["rmse_after"].get<double>(), 0.01);
  }

  // the noise of one output alone is not enough
  result = run({"discover", elbow, trial, "--noise", "shoulder_elv=0.3"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("the noise of elbow_flexion is not given (--noise "
                                    "elbow_flexion=SD)"));
}

}  // namespace
