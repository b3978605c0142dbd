#include "bio/discover/foresee.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "bio/discover/planned.h"
#include "info/discover/joint_fit.h"
#include "support/cut_trial.h"
#include "support/shipped_elbow.h"

namespace bio::discover {
namespace {

using Eigen::VectorXd;
using fixtures::cut;
using fixtures::ShippedElbow;

TEST(PlannedExperiments, RepeatATrialWithWhatTheExperimenterKnows) {
  const ShippedElbow elbow;
  Trial trial = elbow.trial;
  trial.known.massInHand = 0.5;
  const Coordinate coordinate{.name = "elbow_flexion"};
  const auto planned = plannedExperiments(trial, coordinate);
  ASSERT_GE(planned.size(), 4U);
  EXPECT_EQ(planned.front().trial.known.massInHand, 0.5);
  EXPECT_TRUE(planned.front().trial.applied.empty());
  std::set<std::string> sentences;
  int pushed = 0, loaded = 0;
  for (const PlannedExperiment& experiment : planned) {
    EXPECT_TRUE(sentences.insert(experiment.sentence).second) << experiment.sentence;
    EXPECT_EQ(experiment.trial.excitations, trial.excitations);
    EXPECT_GE(experiment.trial.known.massInHand, 0.5);  // what is there already stays
    loaded += experiment.trial.known.massInHand > 0.5;
    for (const AppliedForce& push : experiment.trial.applied) {
      ++pushed;
      EXPECT_EQ(push.coordinate, "elbow_flexion");
      // as much up as down in turn, and nothing for most of the time
      EXPECT_GT(push.values.maxCoeff(), 0.2);
      EXPECT_NEAR(push.values.maxCoeff(), -push.values.minCoeff(), 1e-9);
      EXPECT_GT((push.values.array() == 0).count(), push.values.size() / 2);
      EXPECT_EQ(push.values[0], 0);
    }
  }
  EXPECT_EQ(pushed, 3);
  EXPECT_EQ(loaded, 3);
  // what pushes already stays
  trial.applied = {{"elbow_flexion", VectorXd::Constant(trial.times.size(), 0.7)}};
  const auto both = plannedExperiments(trial, coordinate);
  ASSERT_EQ(both.back().trial.applied.size(), 1U);
  EXPECT_NEAR((both.back().trial.applied[0].values - planned.back().trial.applied[0].values)
                  .cwiseAbs()
                  .maxCoeff(),
              0.7, 1e-12);
}

// Gravity's moment grows with a known mass, that of a force on the hand does not.
TEST(Foresee, AKnownMassTellsTiltFromAForceOnTheHand) {
  const ShippedElbow elbow;
  const ElbowOptions options;
  const auto of = [&](const Trial& trial) {
    return ElbowDisagreement(elbow.model, ShippedElbow::options(), "elbow_flexion", {trial},
                             options);
  };
  // an arm that is tilted
  Trial trial = cut(elbow.trial, 3);
  {
    const ElbowDisagreement upright = of(trial);
    VectorXd values = info::discover::nominalValues(upright);
    values[static_cast<Eigen::Index>(upright.widest().find("tilt.angle"))] = 0.12;
    trial.measured.front().values = upright.outputs(0, values, {});
  }
  const ElbowDisagreement data = of(trial);
  const info::discover::Likelihood likelihood(data, {0}, info::discover::nominalValues(data));
  const auto fitted = [&](const std::string& id) {
    const auto& candidates = data.candidates();
    const auto at = std::find_if(candidates.begin(), candidates.end(),
                                 [&](const auto& one) { return one.id == id; });
    const auto effect = static_cast<std::size_t>(at - candidates.begin());
    return likelihood.fit(info::discover::makeHypothesis(data, {effect}, {0}), {0.0087, 0, 0.08},
                          info::discover::nominalValues(data), {}, {15, 0.1});
  };
  info::discover::Verdict verdict;
  const auto told = [&] {
    return foresee(elbow.model, ShippedElbow::options(), trial, options, data, verdict);
  };
  EXPECT_TRUE(told().empty());
  verdict.rivals = {fitted("tilt"), fitted("handforce")};
  verdict.values = verdict.rivals.front().values;
  const auto foreseen = told();
  ASSERT_GE(foreseen.size(), 3U);
  double asItWas = -1, mass = -1, pushes = -1;
  for (const ForeseenExperiment& one : foreseen) {
    ASSERT_EQ(one.nats.size(), 1U);
    EXPECT_GE(one.least(), 0);
    EXPECT_LE(one.least(), foreseen.front().least());
    if (one.sentence.ends_with("as it was")) asItWas = one.least();
    if (one.sentence.find("known mass") != one.sentence.npos) mass = std::max(mass, one.least());
    if (one.sentence.find("pushes") != one.sentence.npos) pushes = std::max(pushes, one.least());
  }
  EXPECT_GE(asItWas, 0);
  EXPECT_GE(pushes, 0);
  EXPECT_GT(mass, 10 * std::max(asItWas, pushes));
}

}  // namespace
}  // namespace bio::discover
