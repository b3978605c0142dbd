#include "bio/discovery/predicted_experiments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>

#include "bio/discovery/effects.h"
#include "bio/discovery/passive_motion.h"
#include "bio/discovery/planned_experiments.h"
#include "info/discovery/likelihood/joint_fit.h"
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
  trial.conditions.massInHand = 0.5;
  const EncompassingModel model(elbow.model, ShippedElbow::options(), "elbow_flexion");
  const auto planned = plannedExperiments(trial, model);
  ASSERT_GE(planned.size(), 4U);
  EXPECT_EQ(planned.front().trial.conditions.massInHand, 0.5);
  EXPECT_TRUE(planned.front().trial.applied.empty());
  std::set<std::string> sentences;
  int pushed = 0, loaded = 0;
  for (const PlannedExperiment& experiment : planned) {
    EXPECT_TRUE(sentences.insert(experiment.sentence).second) << experiment.sentence;
    EXPECT_EQ(experiment.trial.excitations, trial.excitations);
    EXPECT_GE(experiment.trial.conditions.massInHand, 0.5);  // what is there already stays
    loaded += experiment.trial.conditions.massInHand > 0.5;
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
  const auto both = plannedExperiments(trial, model);
  ASSERT_EQ(both.back().trial.applied.size(), 1U);
  EXPECT_NEAR((both.back().trial.applied[0].values - planned.back().trial.applied[0].values)
                  .cwiseAbs()
                  .maxCoeff(),
              0.7, 1e-12);
}

// A leg has no hand.
TEST(PlannedExperiments, PutAMassWhereTheLimbEnds) {
  const std::string folder = ShippedElbow::root() + "/models/";
  for (const auto& [file, coordinate, place] :
       {std::tuple{"elbow8.osim", "elbow_flexion", "in the hand"},
        std::tuple{"ankle_ta.osim", "ankle_angle", "on foot"}}) {
    const Model base = readOsim(folder + file);
    const EncompassingModel model =
        encompassingModel(base, SystemOptions{{{coordinate}, {}}, {}, {}}, coordinate);
    Trial trial;
    trial.file = "calm.sto";
    trial.times = VectorXd::LinSpaced(101, 0, 1);
    for (const Muscle& muscle : base.muscles) trial.muscles.push_back(muscle.name);
    trial.excitations = Eigen::MatrixXd::Constant(101, std::ssize(trial.muscles), 0.1);
    std::vector<PlannedExperiment> planned = plannedExperiments(trial, model);
    for (PlannedExperiment& one : passiveMotions(trial, model)) planned.push_back(std::move(one));
    int loaded = 0;
    for (const PlannedExperiment& one : planned) {
      const std::size_t kg = one.sentence.find(" kg ");
      EXPECT_EQ(kg != one.sentence.npos, one.trial.conditions.massInHand > 0) << one.sentence;
      if (kg == one.sentence.npos) continue;
      EXPECT_EQ(one.sentence.find(place, kg), kg + 4) << one.sentence;
      ++loaded;
    }
    EXPECT_GE(loaded, 4);  // three of a repeated trial, and those of passive motions
  }
}

TEST(PassiveMotions, FollowTheSweepThatTheyPlan) {
  const ShippedElbow elbow;
  Trial trial = elbow.trial;
  trial.conditions.massInHand = 0.5;
  trial.applied = {{"elbow_flexion", VectorXd::Constant(trial.times.size(), 0.7)}};
  const MusculoskeletalProblemOptions options;
  const MusculoskeletalProblem data(elbow.model, ShippedElbow::options(), "elbow_flexion", {trial},
                                    options);
  const auto planned = passiveMotions(trial, data.encompassing());
  ASSERT_EQ(planned.size(), 4U);
  std::set<std::pair<double, double>> known;
  for (const PlannedExperiment& one : planned) {
    known.insert({one.trial.conditions.massInHand, std::round(100 * one.trial.conditions.armTurn)});
    EXPECT_NE(one.sentence.find("known_mass_in_hand_kg="), std::string::npos) << one.sentence;
    EXPECT_EQ(one.sentence.find("known_arm_turn_deg=-45") != std::string::npos,
              one.trial.conditions.armTurn != 0);
    ASSERT_EQ(one.trial.applied.size(), 1U);
    EXPECT_LE(one.trial.excitations.maxCoeff(), 0.01);
    // the limb goes where it should: up to 84.5 or 110.5°, and back
    const MusculoskeletalProblem moved(elbow.model, ShippedElbow::options(), "elbow_flexion",
                                       {one.trial}, options);
    const VectorXd motion = moved.outputs(0, info::discover::nominalValues(moved), {});
    const VectorXd& wanted = one.trial.measured.front().values;
    const double degree = std::numbers::pi / 180;
    EXPECT_NEAR(wanted.minCoeff(), 13 * degree, 1e-8);
    EXPECT_NEAR(wanted.maxCoeff(), (one.trial.conditions.armTurn == 0 ? 84.5 : 110.5) * degree,
                1e-8);
    EXPECT_LT((motion - wanted).cwiseAbs().maxCoeff(), 0.05 * degree) << one.sentence;
  }
  EXPECT_EQ(known.size(), 4U);
}

// A shipped trial of an arm with an effect in it, and what is fitted to it.
struct Arms {
  Arms(const char* quantity, double value) {
    const MusculoskeletalProblem bare = of(trial);
    VectorXd values = info::discover::nominalValues(bare);
    values[static_cast<Eigen::Index>(bare.encompassing().find(quantity))] = value;
    trial.measured.front().values = bare.outputs(0, values, {});
  }
  MusculoskeletalProblem of(const Trial& one) const {
    return MusculoskeletalProblem(elbow.model, ShippedElbow::options(), "elbow_flexion", {one},
                                  options);
  }
  info::discover::Fit fitted(const MusculoskeletalProblem& data, const std::string& id) const {
    const info::discover::Likelihood likelihood(data, {0}, info::discover::nominalValues(data));
    const auto& candidates = data.candidates();
    const auto at = std::find_if(candidates.begin(), candidates.end(),
                                 [&](const auto& one) { return one.id == id; });
    const auto effect = static_cast<std::size_t>(at - candidates.begin());
    return likelihood.fit(info::discover::makeHypothesis(data, {effect}, {0}), {0.0087, 0, 0.08},
                          info::discover::nominalValues(data), {}, {15, 0.1});
  }
  std::vector<PredictedExperiment> told(const info::discover::Verdict& verdict) const {
    return predictExperiments(trial, of(trial), verdict);
  }

  ShippedElbow elbow;
  MusculoskeletalProblemOptions options;
  Trial trial = cut(elbow.trial, 3);
};

// The largest of those whose sentence has these words.
double best(const std::vector<PredictedExperiment>& predictedExperiments,
            const std::string& words) {
  double nats = -1;
  for (const PredictedExperiment& one : predictedExperiments) {
    if (one.sentence.find(words) != one.sentence.npos) nats = std::max(nats, one.least());
  }
  return nats;
}

// Gravity's moment grows with a known mass, that of a force on the hand does not.
TEST(Foresee, AKnownMassTellsTiltFromAForceOnTheHand) {
  const Arms arms("tilt.angle", 0.12);
  const MusculoskeletalProblem data = arms.of(arms.trial);
  info::discover::Verdict verdict;
  EXPECT_TRUE(arms.told(verdict).empty());
  verdict.rivals = {arms.fitted(data, "tilt"), arms.fitted(data, "handforce")};
  verdict.values = verdict.rivals.front().values;
  const auto predictedExperiments = arms.told(verdict);
  ASSERT_GE(predictedExperiments.size(), 3U);
  for (const PredictedExperiment& one : predictedExperiments) {
    ASSERT_EQ(one.nats.size(), 1U);
    EXPECT_GE(one.least(), 0);
    EXPECT_LE(one.least(), predictedExperiments.front().least());
  }
  EXPECT_GE(best(predictedExperiments, "unchanged"), 0);
  EXPECT_GE(best(predictedExperiments, "pushes"), 0);
  EXPECT_GT(
      best(predictedExperiments, "known_mass"),
      10 * std::max(best(predictedExperiments, "unchanged"), best(predictedExperiments, "pushes")));
}

// Both are smooth in the angle; where the arm is turned, the force comes from elsewhere.
TEST(Foresee, ATurnedArmTellsAForceOnTheHandFromAStiffness) {
  const Arms arms("handforce.force", 1);
  const MusculoskeletalProblem data = arms.of(arms.trial);
  info::discover::Verdict verdict;
  verdict.rivals = {arms.fitted(data, "handforce"), arms.fitted(data, "stiffness")};
  verdict.values = verdict.rivals.front().values;
  const auto predictedExperiments = arms.told(verdict);
  const double turned = best(predictedExperiments, "known_arm_turn_deg=-45");
  EXPECT_GT(turned, 5);
  for (const char* words : {"unchanged", "pushes", "repeat"}) {
    EXPECT_GE(best(predictedExperiments, words), 0) << words;
    EXPECT_GT(turned, 3 * best(predictedExperiments, words)) << words;
  }
}

}  // namespace
}  // namespace bio::discover
