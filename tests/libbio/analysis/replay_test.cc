#include "bio/analysis/replay.h"

#include <gmock/gmock.h>

#include "support/cut_trial.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::cut;
using fixtures::ShippedElbow;
using From = TrialBeginning::From;

struct Fitted {
  Fitted() {
    trial.sha256 = std::string(64, 'a');
    model.fitted = {0.004, {{"curl_slow.sto", trial.sha256, "elbow_flexion", 0.6, -0.3}}};
  }
  ShippedElbow elbow;
  Model model = elbow.model;
  Trial trial = cut(elbow.trial, 0.3);
};

TEST(TrialBeginning, IsWhatWasGivenElseTheModelsElseWhatWasMeasured) {
  Fitted f;
  const double first = f.trial.measured[0].values[0];
  const auto begin = [&](const std::map<std::string, double>& given = {}) {
    return beginningOf(f.trial, f.model, f.elbow.system, given);
  };
  EXPECT_EQ(begin().from, From::model);
  EXPECT_EQ(begin().point.q[0], 0.6);
  EXPECT_EQ(begin().point.qDot[0], -0.3);
  EXPECT_EQ(begin({{"elbow_flexion", 1}}).from, From::given);
  EXPECT_EQ(begin({{"elbow_flexion", 1}}).point.q[0], 1);
  EXPECT_EQ(begin({{"elbow_flexion", 1}}).point.qDot[0], 0);
  f.trial.sha256.back() = 'b';  // another trial
  EXPECT_EQ(begin().from, From::measured);
  EXPECT_EQ(begin().point.q[0], first);
  EXPECT_EQ(begin().point.qDot[0], 0);
  f.trial.sha256.clear();
  f.model.fitted.starts[0].sha256.clear();
  EXPECT_EQ(begin().from, From::measured);
  f.trial.measured.clear();
  EXPECT_EQ(begin().from, From::defaults);
  EXPECT_STREQ(name(From::model), "model");
}

TEST(TrialBeginning, TheStepIsTheOneGivenElseTheModelsOfTheVariationalIntegrators) {
  const Fitted f;
  EXPECT_EQ(stepOf(f.model, Integrator::variational, {}), 0.004);
  EXPECT_EQ(stepOf(f.model, Integrator::variationalLeft, {}), 0.004);
  EXPECT_EQ(stepOf(f.model, Integrator::variational, 0.02), 0.02);
  EXPECT_EQ(stepOf(f.model, Integrator::rungeKutta4, {}), 2e-4);
  EXPECT_EQ(stepOf(f.elbow.model, Integrator::variational, {}), 0.01);
}

TEST(TrialReplay, StartsWithTheSpeedOfItsBeginning) {
  const Fitted f;
  SimulationOptions options;
  options.step = 0.001;
  const TrialReplay replay = replayTrial(f.elbow.system, f.trial, options,
                                         beginningOf(f.trial, f.model, f.elbow.system, {}));
  EXPECT_EQ(replay.motion.q(0, 0), 0.6);
  EXPECT_EQ(replay.motion.qDot(0, 0), -0.3);
  EXPECT_NEAR((replay.motion.q(0, 1) - 0.6) / 0.001, -0.3, 0.02);
  ASSERT_EQ(replay.errors.size(), 1U);
  EXPECT_EQ(replay.errors[0].first, "elbow_flexion");
  EXPECT_EQ(replay.errors[0].second.count, f.trial.measured[0].times.size());
}

}  // namespace
}  // namespace bio
