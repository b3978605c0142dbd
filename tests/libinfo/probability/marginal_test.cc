#include "info/probability/marginal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "info/probability/random_stream.h"
#include "support/throws_saying.h"

namespace info {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

double normalShare(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

TEST(Marginal, NormalQuantileIsTheInverseOfTheShareBelow) {
  for (double p = 1e-300; p < 1; p = p < 0.01 ? p * 7 : p + 0.013) {
    EXPECT_NEAR(normalShare(standardNormalQuantile(p)) / p, 1, 1e-12 * (1 - std::log(p))) << p;
  }
  EXPECT_NEAR(standardNormalQuantile(0.5), 0, 1e-15);
  // tables of the normal law
  EXPECT_NEAR(standardNormalQuantile(0.975), 1.959963984540054, 1e-14);
  EXPECT_NEAR(standardNormalQuantile(0.001), -3.090232306167813, 1e-14);
  EXPECT_EQ(standardNormalQuantile(0), -inf);
  EXPECT_EQ(standardNormalQuantile(1), inf);
}

TEST(Marginal, DrawsOfAWideLawHaveItsMeanAndDeviation) {
  for (const auto shape : {Marginal::Shape::normal, Marginal::Shape::even}) {
    const Marginal law{shape, 3, 0.5, -inf, inf};
    RandomStream random(1, 0);
    double sum = 0, squares = 0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double x = law.quantile(random.uniform());
      sum += x - 3;
      squares += (x - 3) * (x - 3);
    }
    EXPECT_NEAR(sum / n, 0, 4 * 0.5 / std::sqrt(n));
    EXPECT_NEAR(std::sqrt(squares / n), 0.5, 0.01);
  }
}

// E x = mean + deviation·(φ(a) − φ(b))/(Φ(b) − Φ(a))
TEST(Marginal, ACutLawKeepsToItsBoundsAndHasTheMeanOfTheCutLaw) {
  const Marginal law{Marginal::Shape::normal, 1, 0.4, 0.9, 2};
  const auto density = [](double x) {
    return std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi);
  };
  const double a = (0.9 - 1) / 0.4, b = (2 - 1) / 0.4;
  const double mean = 1 + 0.4 * (density(a) - density(b)) / (normalShare(b) - normalShare(a));
  double sum = 0;
  constexpr int n = 10000;
  for (int i = 0; i < n; ++i) {
    const double x = law.quantile((i + 0.5) / n);
    ASSERT_GE(x, 0.9);
    ASSERT_LE(x, 2);
    sum += x;
  }
  EXPECT_NEAR(sum / n, mean, 1e-6);
  EXPECT_NEAR(law.quantile(0), 0.9, 1e-14);
  EXPECT_NEAR(law.quantile(1), 2, 1e-14);
}

TEST(Marginal, AnEvenLawIsCutWithoutASpikeAtTheBound) {
  const Marginal law{Marginal::Shape::even, 1, 1, 0.5, 10};
  EXPECT_EQ(law.quantile(0), 0.5);
  EXPECT_NEAR(law.quantile(1), 1 + std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(law.quantile(0.5), (0.5 + 1 + std::sqrt(3.0)) / 2, 1e-15);
}

TEST(Marginal, BrokenRulesAreNamed) {
  const double nan = std::nan("");
  const auto share = [](Marginal law, double u) { return [=] { (void)law.quantile(u); }; };
  const auto even = Marginal::Shape::even;
  support::throwsSaying(share({even, 0, 0, -1, 1}, 0.5), "deviation = 0 must be > 0");
  support::throwsSaying(share({even, 2, 1, -1, 1}, 0.5), "mean = 2 must lie within");
  support::throwsSaying(share({even, nan, 1, -1, 1}, 0.5), "mean = nan");
  support::throwsSaying(share({even, 0, 1, -1, 1}, nan), "share nan");
  support::throwsSaying([] { (void)standardNormalQuantile(-0.1); }, "share -0.1 must be 0 to 1");
}

}  // namespace
}  // namespace info
