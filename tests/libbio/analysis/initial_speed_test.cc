#include "analysis/initial_speed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using bio::initialSpeedShown;

constexpr double noise = 0.0087;  // half a degree

/// q = q0 + v·t + a·t²/2 + j·t³/6 at 100 Hz, with noise.
struct Recording {
  Recording(double v, double a, double j, unsigned seed, int samples = 200) : measured(samples) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> scatter(0, noise);
    for (int k = 0; k < samples; ++k) {
      const double t = 0.01 * k;
      times.push_back(3 + t);
      measured[k] = 0.5 + v * t + a * t * t / 2 + j * t * t * t / 6 + scatter(generator);
    }
  }
  std::vector<double> times;
  Eigen::VectorXd measured;
};

TEST(InitialSpeed, IsFoundOfATrialThatStartsInMotion) {
  double sum = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Recording one(-1.2, 4, 20, seed);
    const double shown = initialSpeedShown(one.times, one.measured);
    EXPECT_NEAR(shown, -1.2, 0.45);  // its standard error is 0.1
    sum += shown;
  }
  EXPECT_NEAR(sum / 50, -1.2, 0.12);  // j·T²/20 = 0.06 is the parabola's own error
}

TEST(InitialSpeed, IsNoneOfATrialThatStartsAtRest) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Recording still(0, 0, 0, seed), started(0, 8, 0, seed);
    EXPECT_EQ(initialSpeedShown(still.times, still.measured), 0) << seed;
    EXPECT_EQ(initialSpeedShown(started.times, started.measured), 0) << seed;
  }
}

TEST(InitialSpeed, IsNotReadOffAFewSamples) {
  Recording one(5, 0, 0, 1, 200);
  std::vector<double> times;
  Eigen::VectorXd few(50);
  for (int k = 0; k < 50; ++k) {
    times.push_back(0.05 * k);
    few[k] = 5 * 0.05 * k;
  }
  EXPECT_EQ(initialSpeedShown(times, few), 0);  // six within a quarter of a second
  EXPECT_NE(initialSpeedShown(one.times, one.measured), 0);
}

}  // namespace
