#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

#include "apps/ensemble/ensemble_runs.h"

// Parameters that are drawn together.
namespace {

using namespace ensemble_runs;
using support::runFisherHill;
using testing::HasSubstr;

/// Two parameters and how they hang together, ρ = −0.75.
const char* const twoTogether =
    "parameter,TRI.radius,hand.mass\nTRI.radius,1e-06,-1.5e-05\nhand.mass,-1.5e-05,4e-04\n";

TEST(EnsembleCommand, DrawsTogetherWhatACovarianceHoldsTogether) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const std::string file = scratch.file("c.csv", twoTogether);
  const Words work = {
      "--draws", "400",  "--covariance", file,
      "--step",  "0.05", "--parameters", "BRA.pennation_angle,hand.mass,TRI.radius"};
  ASSERT_EQ(runEnsemble(out, with(work, {"--threads", "2"})).status, 0);
  const auto lines = linesOf(contentOf(out + "/draws.csv"));
  ASSERT_EQ(lines.size(), 401u);
  EXPECT_TRUE(lines[0].ends_with("BRA.pennation_angle [rad],hand.mass [kg],TRI.radius [m]"));
  std::array<std::vector<double>, 3> draws;
  for (std::size_t k = 1; k <= 400; ++k) {
    const auto row = cells(lines[k]);
    for (std::size_t i = 0; i < 3; ++i) draws[i].push_back(std::stod(row[8 + i]));
  }
  const auto covariance = [&](std::size_t i, std::size_t j) {
    const auto mean = [](const std::vector<double>& x) {
      return std::accumulate(x.begin(), x.end(), 0.0) / 400;
    };
    const double a = mean(draws[i]), b = mean(draws[j]);
    double sum = 0;
    for (std::size_t k = 0; k < 400; ++k) sum += (draws[i][k] - a) * (draws[j][k] - b);
    return sum / 399;
  };
  const double pennation = covariance(0, 0);
  const double wanted[3][3] = {{pennation, 0, 0}, {0, 4e-4, -1.5e-5}, {0, -1.5e-5, 1e-6}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double error =
          std::sqrt((wanted[i][i] * wanted[j][j] + wanted[i][j] * wanted[i][j]) / 400);
      EXPECT_NEAR(covariance(i, j), wanted[i][j], 4 * error) << i << ' ' << j;
    }
  }
  const std::string one = (scratch / "one").string();
  ASSERT_EQ(runEnsemble(one, with(work, {"--threads", "1"})).status, 0);
  EXPECT_EQ(resultsIn(one), resultsIn(out));
}

TEST(EnsembleCommand, ACovarianceAloneSaysWhatIsDrawn) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const std::string file = scratch.file("c.csv", twoTogether);
  ASSERT_EQ(runEnsemble(out, {"--draws", "3", "--covariance", file}).status, 0);
  EXPECT_TRUE(linesOf(contentOf(out + "/draws.csv"))[0].ends_with("TRI.radius [m],hand.mass [kg]"));
  EXPECT_EQ(summaryIn(out)["inputs"][2]["path"], file);
}

TEST(EnsembleCommand, RefusesACovarianceThatIsNoneInOneLine) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  const std::string good = scratch.file("good.csv", twoTogether);
  const std::string tied = scratch.file("tied.csv", "TRI.radius,hand.mass\n1e-6,3e-5\n3e-5,4e-4\n");
  const std::string other = scratch.file("other.csv", "TRI.radius,nothing\n1,0\n0,1\n");
  const std::string spelt =
      scratch.file("spelt.csv", "BRA.pennation,BRA.pennation_angle\n1,0\n0,1\n");
  for (const auto& [more, words] : std::vector<std::pair<Words, std::string>>{
           {{"--covariance", tied}, "tied.csv: not positive definite: the smallest eigenvalue"},
           {{"--covariance", other}, "other.csv: "},
           {{"--covariance", spelt}, "spelt.csv: BRA.pennation_angle is listed under another name"},
           {{"--covariance", good, "--parameters", "hand.mass"},
            "good.csv: TRI.radius is not one of the --parameters"},
           {{"--covariance", good, "--prior", "hand.mass=0.5:0.1"},
            "--prior: hand.mass already has its distribution from --covariance"},
           {{"--covariance", good, "--sobol"}, "--covariance cannot be combined with --sobol"},
           {{"--covariance", good, "--distribution", "uniform"},
            "--covariance cannot be combined with --distribution uniform"}}) {
    const ProgramResult result = runEnsemble(out, more);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(linesOf(result.err).size(), 1u) << result.err;
    EXPECT_THAT(result.err, HasSubstr(words));
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
