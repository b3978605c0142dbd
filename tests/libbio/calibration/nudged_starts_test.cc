#include "calibration/nudged_starts.h"

#include <gtest/gtest.h>

#include "bio/observation/observed_motion.h"
#include "support/numbers.h"
#include "support/synthetic_elbow.h"

namespace bio {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using fixtures::SyntheticElbow;
using support::degree;

const char* const parameter = "TRI.radius";
constexpr double truth = 0.0175;

const SyntheticElbow& elbow() {
  static const SyntheticElbow one;
  return one;
}

/// The angle and the fibre length of BRA of a model whose radius differs.
Trial withFibre() {
  Trial trial = elbow().trial("curl_slow", 2, {{parameter, truth}}, 30, 2);
  Model model = elbow().model;
  for (WrapObject& wrap : model.wrapObjects)
    if (wrap.name == "TRI") wrap.radius = truth;
  const MusculoskeletalSystem system(model, SyntheticElbow::options());
  const TrialReplay replay = replayTrial(system, trial, {}, beginningOf(trial, model, system, {}));
  const VectorXd times = trial.measured[0].times;
  const Observable what{Observable::Kind::fibreLength, "BRA", 0};
  trial.measured.push_back(
      {what, times, ObservedMotion(system, {{what, times}}).values(replay.motion)});
  return trial;
}

/// θ where models end that are nudged to the data from a radius of 14 mm; NaN where none is nudged.
double nudgedFrom(const Trial& trial) {
  CalibrationOptions options;
  options.trials.parameters = {parameter};
  options.trials.ownStart = false;
  options.noise = 0.2 * degree;
  const TrialSet set(elbow().model, SyntheticElbow::options(), {trial}, options.trials);
  ChannelNoise channels(set, options);
  channels.weigh(channels.shown());
  const auto nudged = nudgedStarts(set, channels, set.parameters(), {VectorXd::Constant(1, 0.014)},
                                   channels.shown().front().sd, {});
  return nudged.empty() ? std::numeric_limits<double>::quiet_NaN() : nudged.front()[0];
}

TEST(NudgedStarts, LeadWhateverIsMeasuredBesideACoordinate) {
  const Trial both = withFibre();
  EXPECT_NEAR(nudgedFrom(both), truth, 2e-4);
  Trial angle = both;
  angle.measured.pop_back();
  EXPECT_NEAR(nudgedFrom(angle), truth, 2e-4);
  Trial fibre = both;  // no coordinate is near anything
  fibre.measured.erase(fibre.measured.begin());
  EXPECT_TRUE(std::isnan(nudgedFrom(fibre)));
}

TEST(NudgedStarts, TheStepIsTestedOnTheChannelThatChangesMost) {
  const Trial both = withFibre();
  TrialSetOptions options;
  options.parameters = {parameter};
  options.ownStart = false;
  const TrialSet set(elbow().model, SyntheticElbow::options(), {both}, options);
  ASSERT_EQ(set.channels().size(), 2U);
  const Eigen::MatrixXd a = set.measured();
  Eigen::MatrixXd b = a;
  b(0, 3) += 0.01;              // rad
  b(0, b.cols() - 1) += 0.002;  // m
  const auto so = set.largestDifferences(a, b, {0.01, 0.001});
  ASSERT_EQ(so.size(), 1U);
  EXPECT_EQ(so[0].channel, 1U);
  EXPECT_NEAR(so[0].difference, 0.002, 1e-15);
  EXPECT_EQ(so[0].sd, 0.001);
  EXPECT_EQ(set.largestDifferences(a, b, {0.001, 0.001})[0].channel, 0U);
}

}  // namespace
}  // namespace bio
