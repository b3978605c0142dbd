#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
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
    const auto at = std::find_if(cells.begin(), cells.end(), [&](const std::string& cell) {
      return cell.ends_with(ending);
    });
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
  ProgramResult result = runFisherHill({"replay", truth, trial, "--prescribe", "ankle_angle",
                                        "--step", "0.0025", "--out", out});
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
  EXPECT_NEAR(
      verdict["effects"][0]["parameters"]["coulomb.torque"]["value"].get<double>(), 2,
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
  result = runFisherHill({"discover", ankle, trial, "--prescribe", "ankle_angle", "--noise-deg",
                          "1"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("the noise of ankle_angle.moment is not given"));
}

}  // namespace
