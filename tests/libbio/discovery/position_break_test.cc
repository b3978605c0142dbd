#include "info/discovery/judgement/position_break.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "bio/discovery/musculoskeletal_problem.h"
#include "discovery/first_part.h"
#include "support/shipped_elbow.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using fixtures::ShippedElbow;

constexpr double degreesPerRadian = 180 / std::numbers::pi;
constexpr double noise = 0.3 / degreesPerRadian;

/// Curls of an elbow with a law of its own, by CVODE, with noise.
std::vector<Trial> curls(const std::string& law, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Trial> trials;
  for (const char* name : {"curl_slow", "curl_fast"}) {
    const ShippedElbow elbow("elbow8", name);
    Model model = elbow.model;
    if (!law.empty()) model.expressionForces.push_back({"law", "elbow_flexion", law, true, {}});
    const MusculoskeletalSystem system(model, ShippedElbow::options());
    Trial trial = elbow.trial;
    trial.file = name;
    MeasuredChannel& measured = trial.measured.front();
    SimulationOptions options;
    options.integrator = Integrator::cvode;
    const TrialReplay replay =
        replayTrial(system, trial, options, beginningOf(trial, model, system, {}));
    EXPECT_EQ(replay.motion.outcome, Outcome::completed) << replay.motion.why;
    measured.times =
        VectorXd::Map(replay.motion.time.data(), static_cast<Index>(replay.motion.time.size()));
    measured.values = replay.motion.q.row(0).transpose();
    for (double& angle : measured.values) angle += noise * normal(random);
    trials.push_back(std::move(trial));
  }
  return trials;
}

std::optional<info::discover::PositionBreak> breakOf(const std::vector<Trial>& trials) {
  const ShippedElbow elbow;
  const MusculoskeletalProblem data(elbow.model, ShippedElbow::options(), "elbow_flexion", trials);
  info::discover::Verdict verdict;
  verdict.sds = noise;
  return info::discover::positionBreak(data, {}, verdict);
}

TEST(PositionBreak, IsFoundWhereATorqueSetsInAtOnce) {
  // 0.8 N m less above 108 degrees
  const auto found = breakOf(curls("-0.4*(1+tanh((q-1.885)/0.01))", 3));
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->above);
  EXPECT_NEAR(found->position * degreesPerRadian, 108, 3);
  EXPECT_NEAR(found->beyond - found->before, -0.8, 0.3);
  EXPECT_GE(std::abs(found->z), 5);
}

TEST(PositionBreak, IsFoundBelowToo) {
  const auto found = breakOf(curls("0.4*(1-tanh((q-0.6)/0.01))", 4));
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->above);
  EXPECT_NEAR(found->position * degreesPerRadian, 34.4, 3);
  EXPECT_NEAR(found->beyond - found->before, 0.8, 0.3);
}

TEST(PositionBreak, IsNotThereWithoutOne) {
  EXPECT_FALSE(breakOf(curls("", 5)));
  EXPECT_FALSE(breakOf(curls("-0.3*qdot", 6)));
  EXPECT_FALSE(breakOf(curls("1.5*(q-1)", 7)));
}

TEST(FirstPart, EndsBeforeThePositionIsFirstPassed) {
  const ShippedElbow elbow;
  const Trial& whole = elbow.trial;
  const MeasuredChannel& motion = whole.measured.front();
  const double most = motion.values.maxCoeff();
  const auto all = firstPart(whole, "elbow_flexion", most, true);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->times.size(), whole.times.size());

  const double position = motion.values[0] + 0.8 * (most - motion.values[0]);
  const auto part = firstPart(whole, "elbow_flexion", position, true);
  ASSERT_TRUE(part);
  const VectorXd& values = part->measured.front().values;
  const Index n = values.size();
  ASSERT_LT(n, motion.values.size());
  EXPECT_LE(values.maxCoeff(), position);
  EXPECT_GT(motion.values[n], position);
  EXPECT_EQ(part->times.size(), part->excitations.rows());
  EXPECT_LE(part->measured.front().times[n - 1], part->times[part->times.size() - 1] + 1e-12);
  EXPECT_TRUE(part->sha256.empty());
  EXPECT_EQ(part->excitations, whole.excitations.topRows(part->times.size()));
}

TEST(FirstPart, IsNothingWhereLessThanASecondIsLeft) {
  const ShippedElbow elbow;
  const MeasuredChannel& motion = elbow.trial.measured.front();
  EXPECT_FALSE(firstPart(elbow.trial, "elbow_flexion", motion.values[0] - 0.01, true));
  EXPECT_FALSE(firstPart(elbow.trial, "elbow_flexion", motion.values[0] + 0.01, false));
}

}  // namespace
}  // namespace bio::discover
