#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

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
  EXPECT_EQ(scratch.listing(),
            (Words{"out", "out/band.csv", "out/draws.csv", "out/report.html", "out/summary.json"}));
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
