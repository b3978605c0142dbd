// Sizes of motions, and what they make of the catalogue of a model without muscles.

#include "bio/discovery/motion_size.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "bio/discovery/effects.h"
#include "bio/discovery/musculoskeletal_problem.h"
#include "libbio/discovery/free_swing.h"

namespace bio::discover {
namespace {

using Eigen::VectorXd;

/// A·sin(2πft) with noise, of `samples` per second over 4 s.
Trial wave(double amplitude, double frequency, double samples, double noise) {
  Trial trial;
  trial.times = VectorXd::LinSpaced(static_cast<Eigen::Index>(4 * samples) + 1, 0, 4);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const VectorXd values = trial.times.unaryExpr([&](double t) {
    return amplitude * std::sin(2 * std::acos(-1) * frequency * t) + noise * normal(random);
  });
  trial.measured.push_back({ofCoordinate("swing"), trial.times, values});
  return trial;
}

double speedOfWave(double frequency, double samples, double noise) {
  return motionSizes({wave(0.4, frequency, samples, noise)}, {"swing"}).at("swing").speed;
}

TEST(MotionSize, IsThatOfAWave) {
  const double rms = std::sqrt(0.5), turn = 2 * std::acos(-1);
  const MotionSize size = motionSizes({wave(0.4, 1, 500, 0)}, {"swing"}).at("swing");
  EXPECT_NEAR(size.spread, 0.4 * rms, 0.001);
  EXPECT_NEAR(size.speed, 0.4 * turn * rms, 0.02 * size.speed);
  EXPECT_NEAR(speedOfWave(0.5, 500, 0), size.speed / 2, 0.01 * size.speed);
  // coarser samples, and noise of a twentieth of the spread, which differences would multiply
  EXPECT_NEAR(speedOfWave(1, 50, 0), size.speed, 0.03 * size.speed);
  EXPECT_NEAR(speedOfWave(1, 500, 0.05 * size.spread), size.speed, 0.05 * size.speed);
}

TEST(MotionSize, IsRootMeanSquareOverTrials) {
  const double both =
      motionSizes({wave(0.3, 1, 200, 0), wave(0.4, 1, 200, 0)}, {"swing"}).at("swing").spread;
  EXPECT_NEAR(both, std::sqrt((0.09 + 0.16) / 4), 0.001);
}

TEST(MotionSize, IsNoneOfWhatRestsOrIsNotMeasured) {
  EXPECT_TRUE(motionSizes({wave(0, 1, 200, 0)}, {"swing"}).empty());
  EXPECT_TRUE(motionSizes({wave(0.4, 1, 200, 0)}, {"other"}).empty());
  EXPECT_TRUE(motionSizes({}, {"swing"}).empty());
}

/// The catalogue for a pendulum, or for one that slides, that was seen to move.
EncompassingModel catalogueFor(const MotionSize& seen) {
  CatalogueChoice choice;
  choice.motions["swing"] = seen;
  return encompassingModel(freePendulum(1), SystemOptions{{{"swing"}, {}}, {}, {}}, "swing",
                           choice);
}

double priorSd(const EncompassingModel& model, const std::string& quantity) {
  return model.quantities()[model.find(quantity)].sd;
}

TEST(MotionSize, ScalesWhatResistsAPendulum) {
  const EncompassingModel slow = catalogueFor({0.5, 0.3}), fast = catalogueFor({5, 0.3});
  EXPECT_NEAR(priorSd(fast, "visc.viscosity"), priorSd(slow, "visc.viscosity") / 10, 1e-12);
  EXPECT_NEAR(priorSd(fast, "drag.coefficient"), priorSd(slow, "drag.coefficient") / 100, 1e-12);
  EXPECT_NEAR(priorSd(fast, "coulomb.torque"), priorSd(slow, "coulomb.torque"), 1e-12);
  const auto friction = [](const EncompassingModel& model) {
    const Eigen::VectorXd values = model.nominal();
    for (const auto& force :
         model.settingAt(values, {model.find("stribeck.torque")}).model.expressionForces)
      if (force.name == "swing_stribeck") return force.expression;
    return std::string();
  };
  EXPECT_EQ(friction(slow), "-c*(1+exp(-(qdot/v)^2))*tanh(qdot/0.00625)");
  EXPECT_EQ(friction(fast), "-c*(1+exp(-(qdot/v)^2))*tanh(qdot/0.0625)");
  EXPECT_NEAR(priorSd(fast, "coulomb.speed"), 10 * priorSd(slow, "coulomb.speed"), 1e-12);
}

TEST(MotionSize, IsPassedOnByAProblem) {
  const MusculoskeletalProblem data(freePendulum(1), SystemOptions{{{"swing"}, {}}, {}, {}},
                                    "swing", {wave(0.4, 1, 200, 0)});
  const MotionSize& seen = data.options().motions.at("swing");
  EXPECT_GT(seen.speed, 0);
  EXPECT_EQ(data.encompassing().coordinates().front().seen.speed, seen.speed);
  EXPECT_EQ(data.encompassing().coordinates().front().seen.spread, seen.spread);
}

}  // namespace
}  // namespace bio::discover
