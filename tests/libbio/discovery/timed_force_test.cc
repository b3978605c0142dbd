#include "bio/discovery/timed_force.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bio/discovery/repaired.h"
#include "support/numbers.h"
#include "support/shipped_elbow.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using fixtures::ShippedElbow;
using support::degree;

TEST(TimedForce, BeginsAndEndsSmoothly) {
  EXPECT_EQ(timedShare(1, 2, false).value, 0);
  EXPECT_EQ(timedShare(3, 2, false).value, 1);
  EXPECT_DOUBLE_EQ(timedShare(2, 2, false).value, 0.5);
  EXPECT_EQ(timedShare(3, 2, true).value, 0);
  for (const bool ends : {false, true}) {
    const double h = 1e-6;
    const double difference =
        (timedShare(2.03, 2 + h, ends).value - timedShare(2.03, 2 - h, ends).value) / (2 * h);
    EXPECT_NEAR(timedShare(2.03, 2, ends).inTime, difference, 1e-6);
  }
}

struct TimedCase {
  ShippedElbow elbow{"elbow8", "curl_fast"};
  MusculoskeletalProblem data{elbow.model, ShippedElbow::options(), "elbow_flexion", {elbow.trial}};
  VectorXd values = VectorXd(static_cast<Index>(data.quantities().size()));

  TimedCase() {
    for (Index i = 0; i < values.size(); ++i)
      values[i] = data.quantities()[static_cast<std::size_t>(i)].nominal;
  }
  const info::discover::Candidate& find(const std::string& id) const {
    for (const auto& candidate : data.candidates())
      if (candidate.id == id) return candidate;
    throw std::invalid_argument(id);
  }
  void put(const std::string& id, double size, double time) {
    const auto& quantities = find(id).quantities;
    values[static_cast<Index>(quantities[0])] = size;
    values[static_cast<Index>(quantities[1])] = time;
  }
};

TEST(TimedForce, MayChangeAnywhereInTheTrials) {
  const TimedCase c;
  const auto& effect = c.find("torque_from");
  const auto& time = c.data.quantities()[effect.quantities[1]];
  const double first = c.elbow.trial.times[0], last = first + c.elbow.trial.duration();
  EXPECT_NEAR(time.lower, first + 0.2, 1e-12);
  EXPECT_NEAR(time.upper, last - 0.2, 1e-12);
  EXPECT_GE(effect.starts.size(), static_cast<std::size_t>((last - first - 0.4) / 0.6));
  for (const VectorXd& start : effect.starts) {
    EXPECT_GT(start[1], time.lower);
    EXPECT_LT(start[1], time.upper);
  }
}

// Nothing moves before the force begins, and something after it.
TEST(TimedForce, MovesNothingBeforeItBegins) {
  TimedCase c;
  const VectorXd before = c.data.outputs(0, c.values, {});
  c.put("mass_from", 0.5, 1.5);
  const VectorXd after = c.data.outputs(0, c.values, {});
  for (std::size_t k = 0; k < c.data.times(0).size(); ++k) {
    if (c.data.times(0)[k] < 1.35) {
      EXPECT_EQ(after[static_cast<Index>(k)], before[static_cast<Index>(k)]);
    }
  }
  EXPECT_GT((after - before).cwiseAbs().maxCoeff(), 5 * degree);
}

// A mass carried all the time is the mass of the hand: what it does along the measured course is
// what it does to a model that follows that.
TEST(TimedForce, AMassDoesWhatItsWeightDoesAtRest) {
  const TimedCase c;
  const std::vector<double> times = {0, 0.5, 1, 1.5, 2}, nodes = {0.5, 1, 1.5};
  const double q = 1.1;
  const VectorXd weight =
      weightOfHeldMass(c.data.encompassing(), times, VectorXd::Constant(5, q), nodes);
  const std::string& hand = c.data.encompassing().movedBodies().back();
  const double moment =
      c.data.encompassing().base().gravity.dot(c.data.encompassing().velocityOf(hand, q));
  EXPECT_LT(moment, -1);
  for (const double one : weight) EXPECT_NEAR(one, moment, 1e-6);
}

TEST(TimedForce, StandsInTheDrivenTrialThatReplaysAsItWasScored) {
  TimedCase c;
  c.put("torque_from", 0.4, 1.7);
  info::discover::Verdict verdict;
  verdict.values = c.values;
  verdict.sds = 0.5 * degree;
  const Repaired repaired = repairedModel(c.data, verdict, {}, {}, {"a test", {}});
  ASSERT_EQ(repaired.trials.size(), 1u);
  ASSERT_TRUE(repaired.trials[0].driven.has_value());
  const auto& columns = repaired.trials[0].driven->columns;
  EXPECT_NE(std::find(columns.begin(), columns.end(), "elbow_flexion.torque"), columns.end());
  EXPECT_NEAR(repaired.trials[0].after, repaired.trials[0].fitted, 0.01 * degree);
}

}  // namespace
}  // namespace bio::discover
