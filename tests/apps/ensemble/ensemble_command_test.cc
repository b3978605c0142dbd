#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "apps/ensemble/ensemble_runs.h"

// Draws, their outputs and indices.
namespace {

using namespace ensemble_runs;
using support::runFisherHill;
using testing::HasSubstr;

TEST(EnsembleCommand, GivesARowForEveryDrawWithItsParametersAndOutputs) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runEnsemble(out, four);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out,
              HasSubstr("40 of 40 simulations with 4 drawn parameters reached the end"));
  const auto lines = linesOf(contentOf(out + "/draws.csv"));
  ASSERT_EQ(lines.size(), 41u);
  EXPECT_EQ(
      lines[0],
      "draw,outcome,failed_at_s,rms_error_deg,rms_from_nominal_deg,final_deg,min_deg,max_deg,"
      "TRI.radius [m],hand.mass [kg],BRA.optimal_fiber_length [m],BRA.tendon_slack_length [m]");
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < 40; ++i) {
    const auto row = cells(lines[i + 1]);
    EXPECT_EQ(row[0], std::to_string(i));
    EXPECT_EQ(row[1], "ok");
    EXPECT_EQ(row[2], "");
    EXPECT_LE(std::stod(row[6]), std::stod(row[5]));
    EXPECT_LE(std::stod(row[5]), std::stod(row[7]));
    const double radius = std::stod(row[8]);
    sum += radius;
    squares += (radius - 0.016) * (radius - 0.016);
  }
  // the catalogue's law of a radius: normal about the model's value with 15 % of it
  EXPECT_NEAR(sum / 40, 0.016, 4 * 0.0024 / std::sqrt(40));
  EXPECT_NEAR(std::sqrt(squares / 40), 0.0024, 0.001);
  const auto json = summaryIn(out);
  EXPECT_EQ(json["draws"], 40);
  EXPECT_EQ(json["outcomes"]["ok"], 40);
  EXPECT_GT(json["final_deg"]["sd"].get<double>(), 1);
  EXPECT_EQ(json["rms_from_nominal_deg"]["nominal"], 0);
  EXPECT_EQ(linesOf(contentOf(out + "/band.csv")).size(), 47u);
  EXPECT_THAT(contentOf(out + "/report.html"), HasSubstr("elbow_flexion over the ensemble"));
  EXPECT_EQ(scratch.listing(), (Words{"out", "out/band.csv", "out/draws.csv", "out/report.html",
                                      "out/reproduce.sh", "out/summary.json"}));
}

// The draw's own parameters, given to replay's model by another command, give its outputs.
TEST(EnsembleCommand, ADrawIsWhatASweepOfItsValueGives) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  ASSERT_EQ(runEnsemble(out, {"--draws", "2", "--parameters", "TRI.radius"}).status, 0);
  const auto row = cells(linesOf(contentOf(out + "/draws.csv"))[2]);
  const std::string other = (scratch / "sweep").string();
  ASSERT_EQ(runFisherHill({"sensitivity", model, slow, "--parameter", "TRI.radius", "--values",
                           row[8], "--out", other})
                .status,
            0);
  const auto run = summaryIn(other)["sweep"]["runs"][0];
  EXPECT_NEAR(run["rms_change_deg"].get<double>(), std::stod(row[4]), 1e-7);
}

/// Columns of the first line, and of the last as numbers.
std::map<std::string, double> lastRow(const std::string& file) {
  const auto lines = linesOf(contentOf(file));
  const auto names = cells(lines.front()), values = cells(lines.back());
  std::map<std::string, double> row;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i < values.size() && !values[i].empty() && values[i] != "ok") {
      row[names[i]] = std::stod(values[i]);
    }
  }
  return row;
}

TEST(EnsembleCommand, ObservesSeveralJointsAndChannelsByName) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result =
      runEnsemble(out, {"--draws", "8", "--parameters", "hand.mass", "--coordinate",
                        "elbow_flexion", "--coordinate", "shoulder_elv", "--observe",
                        "elbow_flexion=0.5deg,shoulder_elv,elbow_flexion.speed", "--observe",
                        "BRA.activation", "--sobol", "--output", "max", "--band-points", "5"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("Median of the final shoulder_elv: "));
  const auto draw = lastRow(out + "/draws.csv"), band = lastRow(out + "/band.csv");
  const auto json = summaryIn(out);
  const std::map<std::string, std::string> units = {{"elbow_flexion", "deg"},
                                                    {"shoulder_elv", "deg"},
                                                    {"elbow_flexion.speed", "deg/s"},
                                                    {"BRA.activation", ""}};
  EXPECT_EQ(json["channels"].size(), units.size());
  const std::string report = contentOf(out + "/report.html");
  for (const auto& [name, unit] : units) {
    const std::string end = unit.empty() ? "" : " [" + unit + "]";
    EXPECT_EQ(json["channels"][name]["unit"], unit);
    for (const char* output : {"rms_from_nominal", "final", "min", "max"}) {
      EXPECT_TRUE(draw.contains(name + "." + output + end)) << name << output;
    }
    EXPECT_LE(draw.at(name + ".min" + end), draw.at(name + ".final" + end));
    EXPECT_LE(band.at(name + ".p5" + end), band.at(name + ".p95" + end));
    EXPECT_NEAR(band.at(name + ".p50" + end), json["channels"][name]["final"]["p50"], 1e-3);
    EXPECT_EQ(json["channels"][name]["sobol"]["output"], "max");
    EXPECT_THAT(report, HasSubstr(name + " over the ensemble"));
    EXPECT_THAT(report, HasSubstr("Outputs of " + name));
    EXPECT_THAT(contentOf(out + "/sobol.csv"), HasSubstr("\n" + name + ".max,hand.mass,"));
  }
  EXPECT_TRUE(draw.contains("elbow_flexion.rms_error [deg]"));
  EXPECT_FALSE(draw.contains("shoulder_elv.rms_error [deg]"));  // it was not measured
  EXPECT_EQ(json["final_deg"], json["channels"]["elbow_flexion"]["final"]);
  EXPECT_EQ(json["sobol"], json["channels"]["elbow_flexion"]["sobol"]);
}

// The moment of the model's own motion is what keeps the elbow on its course in a replay.
TEST(EnsembleCommand, APrescribedElbowsMomentIsThatOfReplay) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string(), replay = (scratch / "replay").string();
  const Words held = {"--prescribe", "elbow_flexion", "--prescribe-cutoff", "6"};
  const ProgramResult result =
      runEnsemble(out, with(held, {"--draws", "6", "--parameters", "hand.mass", "--observe",
                                   "elbow_flexion.moment", "--band-points", "451"}));
  ASSERT_EQ(result.status, 0) << result.err;
  ASSERT_EQ(runFisherHill(with({"replay", model, slow, "--out", replay}, held)).status, 0);
  std::vector<double> moments;
  std::size_t column = 0;
  for (std::string line : linesOf(contentOf(replay + "/forces.sto"))) {
    std::replace(line.begin(), line.end(), '\t', ',');
    const auto row = cells(line);
    if (column > 0) moments.push_back(-std::stod(row.at(column)));
    const auto name = std::find(row.begin(), row.end(), "elbow_flexion.reaction");
    if (name != row.end()) column = static_cast<std::size_t>(name - row.begin());
  }
  const auto lines = linesOf(contentOf(out + "/band.csv"));
  ASSERT_EQ(moments.size(), 451u);
  ASSERT_EQ(lines.size(), 452u);
  EXPECT_EQ(cells(lines[0])[1], "elbow_flexion.moment.nominal [N·m]");
  for (std::size_t k = 0; k < 451; ++k) {
    EXPECT_NEAR(std::stod(cells(lines[k + 1])[1]), moments[k], 1e-6);
  }
  const auto json = summaryIn(out);
  EXPECT_FALSE(json.contains("final_deg"));
  const auto moment = json["channels"]["elbow_flexion.moment"];
  EXPECT_EQ(moment["unit"], "N·m");
  EXPECT_NEAR(moment["max"]["nominal"], *std::max_element(moments.begin(), moments.end()), 1e-6);
  EXPECT_GT(moment["max"]["sd"].get<double>(), 0.01);  // a heavier hand weighs more
}

TEST(EnsembleCommand, SameSeedSameBytesWhateverTheThreadsAndOtherSeedOthers) {
  const ScratchFolder scratch;
  const auto results = [&](const std::string& folder, const Words& more) {
    const std::string out = (scratch / folder).string();
    EXPECT_EQ(runEnsemble(out, with(four, more)).status, 0);
    return resultsIn(out);
  };
  const std::string one = results("one", {"--threads", "1"});
  EXPECT_EQ(one, results("two", {"--threads", "2"}));
  EXPECT_NE(one, results("other", {"--seed", "2"}));
}

TEST(EnsembleCommand, SobolsIndicesSayWhichParameterMovesTheEnd) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const ProgramResult result = runEnsemble(
      out, {"--draws", "32", "--sobol", "--parameters", "TRI.radius,hand.mass,BRA.pennation_angle",
            "--output", "max", "--distribution", "uniform", "--step", "0.02"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto sobol = summaryIn(out)["sobol"];
  EXPECT_EQ(sobol["output"], "max");
  EXPECT_EQ(summaryIn(out)["draws"], 32 * 5);
  double sum = 0;
  for (const auto& index : sobol["indices"]) {
    const double total = index["total"].get<double>();
    EXPECT_LE(index["total_interval"][0].get<double>(), total);
    EXPECT_GE(index["total_interval"][1].get<double>(), total);
    sum += total;
  }
  EXPECT_GT(sum, 0.9);  // at least the whole variance
  EXPECT_LT(sobol["indices"][2]["total"].get<double>(), 0.01);
  const auto lines = linesOf(contentOf(out + "/sobol.csv"));
  EXPECT_EQ(lines[0], "output,parameter,first,first_low,first_high,total,total_low,total_high");
  EXPECT_EQ(lines.size(), 4u);
}

}  // namespace
