#include "info/probability/global_sensitivity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/throws_saying.h"

namespace info {
namespace {

using Eigen::VectorXd;
constexpr double pi = std::numbers::pi;

/// Ishigami and Homma's function, whose indices are known in closed form.
VectorXd ishigami(const VectorXd& unit) {
  const VectorXd x = 2 * pi * unit.array() - pi;
  return VectorXd::Constant(1, std::sin(x[0]) + 7 * std::pow(std::sin(x[1]), 2) +
                                   0.1 * std::pow(x[2], 4) * std::sin(x[0]));
}

TEST(GlobalSensitivity, SobolIndicesOfIshigamisFunction) {
  EnsembleOptions options;
  options.samples = 4096;
  const SobolResult r = sobol(ishigami, 3, options);
  const double a = 7, b = 0.1;
  const double V1 = 0.5 * std::pow(1 + b * std::pow(pi, 4) / 5, 2);
  const double V2 = a * a / 8;
  const double V13 = b * b * std::pow(pi, 8) * (1.0 / 18 - 1.0 / 50);
  const double V = V1 + V2 + V13;
  EXPECT_NEAR(r.variance, V, 0.03 * V);
  const Eigen::Vector3d first(V1 / V, V2 / V, 0), total((V1 + V13) / V, V2 / V, V13 / V);
  EXPECT_LT((r.first - first).cwiseAbs().maxCoeff(), 0.03) << r.first.transpose();
  EXPECT_LT((r.total - total).cwiseAbs().maxCoeff(), 0.03) << r.total.transpose();
  EXPECT_EQ(r.runs, 4096 * 5);
  EXPECT_GT(r.firstDeviation.minCoeff(), 0);
}

/// All runs of Saltelli's scheme on Ishigami's function.
std::vector<VectorXd> ishigamiRuns(int basePoints, std::uint64_t seed) {
  std::vector<VectorXd> outputs;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(basePoints) * 5; ++i) {
    outputs.push_back(ishigami(sobolPoint(i, 3, seed)));
  }
  return outputs;
}

TEST(GlobalSensitivity, OutputsComputedElsewhereGiveTheSameIndices) {
  EnsembleOptions options;
  options.samples = 200;
  options.seed = 7;
  const SobolResult inside = sobol(ishigami, 3, options);
  const SobolResult outside = sobolIndices(ishigamiRuns(200, 7), 3);
  EXPECT_EQ(inside.first, outside.first);
  EXPECT_EQ(inside.totalSd, outside.totalSd);
  // run 2 + i differs from run 0 in coordinate i alone, which is run 1's
  for (Eigen::Index i = 0; i < 3; ++i) {
    VectorXd mixed = sobolPoint(50, 3, 7);
    mixed[i] = sobolPoint(51, 3, 7)[i];
    EXPECT_EQ(sobolPoint(52 + static_cast<std::uint64_t>(i), 3, 7), mixed);
  }
}

TEST(GlobalSensitivity, BootstrapIntervalsHoldTheTrueIndicesOfIshigamisFunction) {
  const double V1 = 0.5 * std::pow(1 + 0.1 * std::pow(pi, 4) / 5, 2), V2 = 49.0 / 8;
  const double V13 = 0.01 * std::pow(pi, 8) * (1.0 / 18 - 1.0 / 50), V = V1 + V2 + V13;
  const Eigen::Vector3d first(V1 / V, V2 / V, 0), total((V1 + V13) / V, V2 / V, V13 / V);
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto runs = ishigamiRuns(256, seed);
    const SobolIntervals at = bootstrapSobol(runs, 3, 200, seed);
    for (Eigen::Index i = 0; i < 3; ++i) {
      held += at.first(i, 0) <= first[i] && first[i] <= at.first(i, 1);
      held += at.total(i, 0) <= total[i] && total[i] <= at.total(i, 1);
    }
    // 2·1.96 standard errors, and more where the variance itself is uncertain: 2.9 to 6.5 here
    const SobolResult r = sobolIndices(runs, 3);
    const Eigen::ArrayXd wide = (at.total.col(1) - at.total.col(0)).array() / r.totalSd.array();
    EXPECT_GT(wide.minCoeff(), 2) << wide.transpose();
    EXPECT_LT(wide.maxCoeff(), 9) << wide.transpose();
  }
  EXPECT_GE(held, 54);  // of 60: 95 % would be 57
}

TEST(GlobalSensitivity, OutputsThatAreNoWholeSchemeAreRefused) {
  auto runs = ishigamiRuns(4, 1);
  runs.pop_back();
  support::throwsSaying([&] { (void)sobolIndices(runs, 3); }, "19 outputs, must be 5 for each");
  support::throwsSaying([&] { (void)bootstrapSobol(ishigamiRuns(4, 1), 3, 19, 1); },
                        "replicates = 19");
  support::throwsSaying([&] { (void)sobolPoint(0, 33, 1); }, "33 parameters, must be 1 to 32");
}

TEST(GlobalSensitivity, SobolIndicesOfASumAreItsVariances) {
  const auto sum = [](const VectorXd& x) { return VectorXd::Constant(1, x[0] + 3 * x[1]); };
  const SobolResult r = sobol(sum, 2);
  EXPECT_NEAR(r.first[0], 0.1, 0.03);
  EXPECT_NEAR(r.total[1], 0.9, 0.06);
}

TEST(GlobalSensitivity, SeveralOutputsCountTogether) {
  const auto both = [](const VectorXd& x) { return VectorXd(Eigen::Vector2d(x[0], 2 * x[1])); };
  EXPECT_NEAR(sobol(both, 2).total[0], 0.2, 0.02);
}

TEST(GlobalSensitivity, MorrisFindsSlopesAndWhatIsCurved) {
  const auto model = [](const VectorXd& x) {
    return VectorXd::Constant(1, 2 * x[0] - 5 * x[1] + 4 * x[2] * x[2]);
  };
  const MorrisResult r = morris(model, 4);
  EXPECT_NEAR(r.meanAbsolute[0], 2, 1e-12);
  EXPECT_NEAR(r.sd[0], 0, 1e-12);
  EXPECT_NEAR(r.meanAbsolute[1], 5, 1e-12);
  // 4(2x + Δ) with x = 0 or 1/3
  EXPECT_NEAR(r.meanAbsolute[2], 4, 0.2);
  EXPECT_NEAR(r.sd[2], 4.0 / 3, 0.05);
  EXPECT_EQ(r.meanAbsolute[3], 0);
}

TEST(GlobalSensitivity, SameSeedSameBitsWhateverTheThreads) {
  EnsembleOptions one, four;
  one.samples = four.samples = 64;
  one.threads = 1;
  four.threads = 4;
  EXPECT_EQ(sobol(ishigami, 3, one).first, sobol(ishigami, 3, four).first);
  EXPECT_EQ(morris(ishigami, 3, one).sd, morris(ishigami, 3, four).sd);
  four.seed = 2;
  EXPECT_NE(sobol(ishigami, 3, one).first, sobol(ishigami, 3, four).first);
}

TEST(GlobalSensitivity, HaltonFillsEachAxisEvenly) {
  for (int d = 0; d < 12; ++d) {
    std::array<int, 8> counts{};
    for (std::uint64_t k = 0; k < 1024; ++k) {
      const double x = haltonPoint(k, 12, 3)[d];
      ASSERT_GE(x, 0);
      ASSERT_LT(x, 1);
      ++counts[static_cast<std::size_t>(8 * x)];
    }
    for (const int count : counts) EXPECT_NEAR(count, 128, 30) << "axis " << d;
  }
}

TEST(GlobalSensitivity, UndefinedPointsAreLeftOutAndCounted) {
  const auto holes = [](const VectorXd& x) {
    return VectorXd::Constant(1, x[0] > 0.9 ? std::nan("") : x[0] + x[1]);
  };
  const SobolResult r = sobol(holes, 2);
  EXPECT_GT(r.undefined, 0);
  EXPECT_TRUE(r.first.allFinite());
}

TEST(GlobalSensitivity, StopsWhenToldAndRefusesNonsense) {
  EnsembleOptions options;
  options.threads = 1;
  options.progress = [](int done, int) { return done < 10; };
  EXPECT_FALSE(sobol(ishigami, 3, options).complete);
  EXPECT_THROW(sobol(ishigami, 0), std::invalid_argument);
  options.samples = 1;
  EXPECT_THROW(morris(ishigami, 3, options), std::invalid_argument);
  EXPECT_THROW(haltonPoint(0, 65, 1), std::invalid_argument);
}

}  // namespace
}  // namespace info
