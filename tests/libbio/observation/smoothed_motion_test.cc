#include "bio/observation/smoothed_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "info/probability/random_stream.h"

namespace bio {
namespace {

std::vector<double> every(double step, int count) {
  std::vector<double> times;
  for (int k = 0; k < count; ++k) times.push_back(1 + step * k);
  return times;
}

template <class F>
Eigen::VectorXd values(const std::vector<double>& times, const F& f) {
  Eigen::VectorXd y(static_cast<Eigen::Index>(times.size()));
  for (Eigen::Index k = 0; k < y.size(); ++k) y[k] = f(times[static_cast<std::size_t>(k)]);
  return y;
}

TEST(SmoothedMotion, LeavesAParabolaAsItIsAcrossAGap) {
  std::vector<double> times = every(0.01, 200);
  times.erase(times.begin() + 60, times.begin() + 90);
  const auto parabola = [](double t) { return 0.3 - 2 * t + 1.5 * t * t; };
  const SmoothedMotion course = smoothed(times, values(times, parabola));
  ASSERT_EQ(course.times.size(), 200u);
  for (std::size_t k = 0; k < course.times.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    EXPECT_NEAR(course.values[i], parabola(course.times[k]), 1e-8);
    if (k > 0 && k + 1 < course.times.size()) {
      EXPECT_NEAR(course.speeds[i], -2 + 3 * course.times[k], 1e-6);
    }
  }
}

TEST(SmoothedMotion, HalvesASineOfTheCutoffFrequency) {
  const double cutoff = 5;
  const std::vector<double> times = every(0.01, 1001);
  const auto sine = [&](double t) { return std::sin(2 * std::numbers::pi * cutoff * t); };
  const SmoothedMotion course = smoothed(times, values(times, sine), cutoff);
  for (std::size_t k = 300; k < 700; ++k)
    EXPECT_NEAR(course.values[static_cast<Eigen::Index>(k)], 0.5 * sine(times[k]), 1e-3);
}

TEST(SmoothedMotion, TakesMostOfWhiteNoiseAway) {
  info::RandomStream random(7, 1);
  const std::vector<double> times = every(0.01, 2000);
  const Eigen::VectorXd noise = values(times, [&](double) { return random.normal(); });
  const SmoothedMotion course = smoothed(times, noise);
  const double left = course.values.segment(200, 1600).norm() / std::sqrt(1600.0);
  // 4 of 50 Hz pass: √0.08 = 0.28, a little less for the filter's slope
  EXPECT_GT(left, 0.2);
  EXPECT_LT(left, 0.35);
}

TEST(SmoothedMotion, RefusesWhatMakesNoSense) {
  const std::vector<double> times = every(0.01, 5);
  const Eigen::VectorXd y = Eigen::VectorXd::Zero(5);
  EXPECT_NO_THROW(smoothed(times, y));
  EXPECT_THROW(smoothed(every(0.01, 3), y.head(3)), std::invalid_argument);
  EXPECT_THROW(smoothed(times, y.head(4)), std::invalid_argument);
  EXPECT_THROW(smoothed({0, 1, 1, 2, 3}, y), std::invalid_argument);
  EXPECT_THROW(smoothed(times, y * std::numeric_limits<double>::quiet_NaN()),
               std::invalid_argument);
  EXPECT_THROW(smoothed(times, y, 60), std::invalid_argument);
  EXPECT_THROW(smoothed(times, y, -1), std::invalid_argument);
}

}  // namespace
}  // namespace bio
