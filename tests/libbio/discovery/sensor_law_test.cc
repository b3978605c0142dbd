#include "bio/discovery/sensor_law.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bio::discover {
namespace {

struct Course {
  std::vector<double> times;
  Eigen::MatrixXd q{2, 401}, qDot{2, 401};
  Course() {
    for (int k = 0; k <= 400; ++k) {
      const double t = 0.5 + 0.01 * k;
      times.push_back(t);
      q.col(k) << std::sin(3 * t), 0.2 * t;
      qDot.col(k) << 3 * std::cos(3 * t), 0.2;
    }
  }
};

// τ q̇_L = q − q_L with q = sin 3t: amplitude 1/√(1 + 9τ²), phase −atan 3τ once the start is
// forgotten; a ramp is late by τ.
TEST(SensorLaw, ALagIsThatOfAFirstOrderSystem) {
  const Course course;
  const double lag = 0.08;
  const Lagged late = lagged(course.times, course.q, course.qDot, lag);
  EXPECT_DOUBLE_EQ(late.value(0, 0), course.q(0, 0));
  for (Eigen::Index k = 200; k <= 400; ++k) {
    const double t = course.times[static_cast<std::size_t>(k)];
    const double size = 1 / std::sqrt(1 + 9 * lag * lag), phase = 3 * t - std::atan(3 * lag);
    EXPECT_NEAR(late.value(0, k), size * std::sin(phase), 1e-4);  // straight between rows
    EXPECT_NEAR(late.speed(0, k), 3 * size * std::cos(phase), 2e-3);
    EXPECT_NEAR(late.value(1, k), 0.2 * (t - lag), 1e-9);
  }
}

TEST(SensorLaw, WithoutALagTheCourseIsAsItWas) {
  const Course course;
  const Lagged same = lagged(course.times, course.q, course.qDot, 0);
  EXPECT_EQ(same.value, course.q);
  EXPECT_EQ(same.speed, course.qDot);
  EXPECT_EQ(same.inLag, -course.qDot);
}

TEST(SensorLaw, FollowsTheLagAsDifferencesSay) {
  const Course course;
  const double lag = 0.05, h = 1e-5;
  const Lagged at = lagged(course.times, course.q, course.qDot, lag);
  const Lagged above = lagged(course.times, course.q, course.qDot, lag + h);
  const Lagged below = lagged(course.times, course.q, course.qDot, lag - h);
  EXPECT_LT((at.inLag - (above.value - below.value) / (2 * h)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((at.inLagSpeed - (above.speed - below.speed) / (2 * h)).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(SensorLaw, ACorrectedTrialIsWhatATrueSensorShows) {
  Trial trial;
  trial.times = Eigen::VectorXd::LinSpaced(201, 1, 3);
  const SensorLaw sensor{0.02, 0.1, 0.03, 0.05, 0.04, 0.01};
  const auto q = [](double t) { return 1 + 0.4 * std::sin(2 * t); };
  // y(t) = 1.1 q_L(1 + 1.05 (t − 1) − 0.03) + 0.02 + 0.01 (t − 1), q_L in the steady state
  const auto behind = [&](double t) {
    return 1 + 0.4 / std::sqrt(1 + 4 * 0.04 * 0.04) * std::sin(2 * t - std::atan(2 * 0.04));
  };
  MeasuredChannel motion{ofCoordinate("elbow"), trial.times, trial.times};
  for (Eigen::Index k = 0; k < motion.times.size(); ++k) {
    const double t = motion.times[k];
    motion.values[k] = 1.1 * behind(1 + 1.05 * (t - 1) - 0.03) + 0.02 + 0.01 * (t - 1);
  }
  trial.measured = {motion};
  const MeasuredChannel corrected =
      asTrueSensor(trial, ofCoordinate("elbow"), sensor).measured.front();
  ASSERT_GT(corrected.times.size(), 180);
  EXPECT_LT(corrected.times.size(), 201);  // those beyond the trial's end are lost
  for (Eigen::Index k = 5; k + 5 < corrected.times.size(); ++k)
    EXPECT_NEAR(corrected.values[k], q(corrected.times[k]), 2e-3);
  EXPECT_EQ(asTrueSensor(trial, ofCoordinate("elbow"), {}).measured.front().values, motion.values);
}

}  // namespace
}  // namespace bio::discover
