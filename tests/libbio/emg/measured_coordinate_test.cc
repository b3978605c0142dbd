#include "bio/emg/measured_coordinate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "support/numbers.h"

namespace {

using support::nan;
using testing::HasSubstr;
using testing::ThrowsMessage;

bio::Channel channel(const Eigen::VectorXd& values, double rate = 50, double start = 0) {
  return {"goniometer", "counts", rate, start, values};
}

bio::MeasuredOptions options() {
  bio::MeasuredOptions out;
  out.channel = "goniometer";
  out.degreesPerUnit = 0.045;
  out.sign = -1;
  out.zero = -2000;
  out.clipBelow = -4000;
  return out;
}

TEST(MeasuredCoordinate, ScalesTurnsAndShiftsAndLeavesOutWhatWasClipped) {
  const auto m =
      bio::measuredCoordinate(channel(Eigen::Vector4d(-2000, -3000, -4000, -3999)), options());
  EXPECT_NEAR(m.angle_deg[0], 0, 1e-12);
  EXPECT_NEAR(m.angle_deg[1], 45, 1e-12);
  EXPECT_TRUE(std::isnan(m.angle_deg[2]));
  EXPECT_NEAR(m.angle_deg[3], 1999 * 0.045, 1e-12);
  EXPECT_DOUBLE_EQ(m.notMeasured, 0.25);
  auto above = options();
  above.clipAbove = -2500;
  EXPECT_DOUBLE_EQ(
      bio::measuredCoordinate(channel(Eigen::Vector2d(-2500, -2501)), above).notMeasured, 0.5);
}

TEST(MeasuredCoordinate, SmoothsWithoutDelayAndKeepsItsGaps) {
  const Eigen::VectorXd slow = Eigen::VectorXd::NullaryExpr(500, [](Eigen::Index i) {
    return 10 * std::sin(2 * std::numbers::pi * 0.5 * static_cast<double>(i) / 50);
  });
  Eigen::VectorXd noisy = slow;
  for (Eigen::Index i = 0; i < 500; ++i) noisy[i] += (i % 2 == 0 ? 1 : -1);
  noisy.segment(240, 5).setConstant(nan);
  bio::MeasuredOptions o;
  o.lowPass = 6;
  const auto m = bio::measuredCoordinate(channel(noisy), o);
  for (Eigen::Index i = 50; i < 450; ++i) {
    if (i >= 240 && i < 245) {
      EXPECT_TRUE(std::isnan(m.angle_deg[i])) << i;
    } else if (i < 220 || i > 265) {
      EXPECT_NEAR(m.angle_deg[i], slow[i], 0.02) << i;
    }
  }
}

// 50 Hz on 200 Hz rows: every fourth row is a sample, the others are empty.
TEST(AngleAtRows, GivesAMeasurementOnceWhenItIsSlowerThanTheRows) {
  const auto m =
      bio::measuredCoordinate(channel(Eigen::Vector4d(1, 2, 3, 4)), bio::MeasuredOptions{});
  const Eigen::VectorXd rows = bio::angleAtRows(m, Eigen::VectorXd::LinSpaced(17, 0, 0.08));
  for (Eigen::Index i = 0; i < 17; ++i) {
    if (i % 4 == 0 && i < 16) {
      EXPECT_NEAR(rows[i], 1 + static_cast<double>(i) / 4, 1e-9);
    } else {
      EXPECT_TRUE(std::isnan(rows[i])) << i;
    }
  }
}

// A ramp of 100 per second, sampled at 70 Hz from 3 ms on: rows hold the ramp's own value at their
// time.
TEST(AngleAtRows, IsLinearBetweenSamplesThatFallBetweenRowsAndUsesEachOnce) {
  const Eigen::VectorXd ramp = Eigen::VectorXd::NullaryExpr(
      71, [](Eigen::Index i) { return 100 * (0.003 + static_cast<double>(i) / 70); });
  const auto m = bio::measuredCoordinate(channel(ramp, 70, 0.003), bio::MeasuredOptions{});
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(201, 0, 1);
  const Eigen::VectorXd rows = bio::angleAtRows(m, times);
  int measured = 0;
  for (Eigen::Index i = 0; i < 201; ++i) {
    if (std::isnan(rows[i])) continue;
    ++measured;
    EXPECT_NEAR(rows[i], 100 * times[i], 1e-9);
  }
  EXPECT_GE(measured, 68);
  EXPECT_LE(measured, 70);
}

TEST(AngleAtRows, FillsEveryRowFromAFasterSignalButNeverAcrossAGap) {
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(1001, 0, 100);
  x.segment(503, 10).setConstant(nan);
  const auto m = bio::measuredCoordinate(channel(x, 1000), bio::MeasuredOptions{});
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(201, 0, 1);
  const Eigen::VectorXd rows = bio::angleAtRows(m, times);
  for (Eigen::Index i = 0; i < 201; ++i) {
    if (i == 101 || i == 102) {
      EXPECT_TRUE(std::isnan(rows[i]));
    } else {
      EXPECT_NEAR(rows[i], 100 * times[i], 1e-9) << i;
    }
  }
}

TEST(MeasuredCoordinate, NamesTheOptionThatBreaksItsRule) {
  const auto fails = [](const bio::MeasuredOptions& o, const std::string& text) {
    EXPECT_THAT([&] { bio::measuredCoordinate(channel(Eigen::Vector2d(-2100, -2200)), o); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(text)));
  };
  auto o = options();
  o.degreesPerUnit = -0.045;
  fails(o, "-0.045 degrees per counts");
  o = options();
  o.degreesPerUnit = nan;
  fails(o, "nan degrees per counts");
  o = options();
  o.sign = 0;
  fails(o, "sign 0");
  o = options();
  o.zero = nan;
  fails(o, "zero nan");
  o = options();
  o.clipAbove = -5000;
  fails(o, "above -5000");
  o = options();
  o.clipBelow = -1000;
  fails(o, "no value between");
}

}  // namespace
