#include "bio/tables/interpolated_series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace bio {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// A slow motion of 1 s at a rate, with noise.
VectorXd recorded(Index samples, double noise) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, noise);
  VectorXd y(samples);
  for (Index k = 0; k < samples; ++k) {
    const double t = static_cast<double>(k) / static_cast<double>(samples - 1);
    y[k] = 1 + 0.6 * std::sin(5 * t) + (noise > 0 ? normal(random) : 0);
  }
  return y;
}

/// n values for each interval of y.
VectorXd interpolated(const VectorXd& y, Index n) {
  VectorXd fine((y.size() - 1) * n + 1);
  for (Index k = 0; k < fine.size(); ++k) {
    const Index before = std::min(k / n, y.size() - 2);
    const double part = static_cast<double>(k - before * n) / static_cast<double>(n);
    fine[k] = (1 - part) * y[before] + part * y[before + 1];
  }
  return fine;
}

VectorXd rounded(const VectorXd& y, double resolution) {
  return y.unaryExpr([&](double v) { return resolution * std::round(v / resolution); });
}

int factorOf(const VectorXd& y) {
  return interpolationFactor(VectorXd::LinSpaced(y.size(), 2, 3), y);
}

TEST(InterpolatedSeries, HasTheFactorBetweenRecordedAndGivenSamples) {
  for (const Index n : {2, 3, 5, 10, 50}) {
    EXPECT_EQ(factorOf(interpolated(recorded(41, 1e-3), n)), n);
    EXPECT_EQ(factorOf(interpolated(recorded(41, 0), n)), n) << "smooth";
  }
}

TEST(InterpolatedSeries, IsSeenThroughTheDigitsOfAFile) {
  EXPECT_EQ(factorOf(rounded(interpolated(recorded(101, 2e-3), 10), 1e-6)), 10);
  // and when the sensor itself is coarse: half of its values repeat
  EXPECT_EQ(factorOf(interpolated(rounded(recorded(201, 1e-3), 0.01), 5)), 5);
}

TEST(InterpolatedSeries, StartsAnywhereAndAgainAfterAGap) {
  const VectorXd fine = interpolated(recorded(61, 1e-3), 5);
  const VectorXd times = VectorXd::LinSpaced(fine.size(), 0, 3);
  EXPECT_EQ(interpolationFactor(times.tail(298), fine.tail(298)), 5);
  VectorXd t(fine.size() - 7), y(fine.size() - 7);
  t << times.head(102), times.tail(192);
  y << fine.head(102), fine.tail(192);
  EXPECT_EQ(interpolationFactor(t, y), 5);
}

TEST(InterpolatedSeries, IsNotARecordedOneOrAResolutionOrALine) {
  EXPECT_EQ(factorOf(recorded(401, 1e-3)), 1);
  EXPECT_EQ(factorOf(recorded(401, 0)), 1);
  for (const double resolution : {1e-3, 5e-3, 0.02, 0.1}) {
    EXPECT_EQ(factorOf(rounded(recorded(1001, 0), resolution)), 1) << resolution;
    EXPECT_EQ(factorOf(rounded(recorded(1001, 2e-3), resolution)), 1) << resolution;
    for (const double end : {0.3, 0.5, 1.0, 1.5, 2.0}) {
      const VectorXd ramp = VectorXd::LinSpaced(1001, 0, 1000 * resolution * end);
      EXPECT_EQ(factorOf(rounded(ramp, resolution)), 1) << resolution << " " << end;
    }
  }
  EXPECT_EQ(factorOf(VectorXd::Constant(401, 0.7)), 1);
  EXPECT_EQ(factorOf(VectorXd::LinSpaced(401, 0.3, 1.9)), 1);
  for (int i = 0; i < 3000; ++i) {  // whatever its rounding looks like
    EXPECT_EQ(factorOf(VectorXd::LinSpaced(17, std::sin(i), std::cos(i))), 1) << i;
  }
  VectorXd corner = VectorXd::Constant(401, 0.5);  // rest, then a ramp
  corner.tail(200).setLinSpaced(0.5, 1.5);
  EXPECT_EQ(factorOf(corner), 1);
}

TEST(InterpolatedSeries, MustHoldEnoughRecordedSamples) {
  EXPECT_EQ(factorOf(interpolated(recorded(6, 1e-3), 10)), 1);
  EXPECT_EQ(factorOf(recorded(3, 1e-3)), 1);
  EXPECT_EQ(interpolationFactor(VectorXd::Zero(1), VectorXd::Zero(1)), 1);
}

}  // namespace
}  // namespace bio
