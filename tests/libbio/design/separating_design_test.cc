#include "bio/design/separating_design.h"

#include <gtest/gtest.h>

#include "bio/tables/trial_table.h"
#include "info/discovery/likelihood/joint_fit.h"
#include "support/cut_trial.h"
#include "support/numbers.h"
#include "support/shipped_elbow.h"
#include "support/throws_saying.h"

namespace bio::discover {
namespace {

using Eigen::VectorXd;
using fixtures::cut;
using fixtures::ShippedElbow;
using support::degree;

struct Asked {
  ShippedElbow elbow;
  MusculoskeletalProblemOptions options;
  SeparationQuestion question{.first = "visc", .second = "coulomb"};
  DesignLimits limits;

  Asked() {
    question.start = {{"elbow_flexion", elbow.catalogue.nominal().start.q[0]}};
    question.observed = {{ofCoordinate("elbow_flexion"), 0.009}};
    limits.coordinates = {{"elbow_flexion", 0, 130 * degree}};
  }
  SeparatingDesign design() const {
    return {
        elbow.model, ShippedElbow::options(), cut(elbow.trial, 2), options, question, limits, {},
        0.25};
  }
};

// What was foreseen is what fits make of it: the motion with one effect, without noise, and the
// other one fitted with all that the base model does not know.
TEST(SeparatingDesign, ForeseesWhatFitsThenFind) {
  Asked asked;
  asked.question.firstSize = 0.005;  // so small that all is nearly linear
  asked.question.secondSize = 0.0125;
  const SeparatingDesign design = asked.design();
  const SeparatingExperiment e = design.before();
  const auto costOf = [&](const VectorXd& motion, const std::string& other) {
    Trial trial = e.trial;
    trial.measured.front().values = motion;
    const MusculoskeletalProblem data(asked.elbow.model, ShippedElbow::options(), "elbow_flexion",
                                      {trial}, asked.options);
    std::size_t candidate = 0;
    while (data.candidates()[candidate].id != other) ++candidate;
    const VectorXd nominal = info::discover::nominalValues(data);
    const info::discover::Likelihood likelihood(data, {0}, nominal);
    return likelihood
        .fit(info::discover::makeHypothesis(data, {candidate}, {0}),
             {asked.question.observed[0].sd, 0, 0.08}, nominal, {}, {40, 1e-6})
        .cost;
  };
  EXPECT_GT(e.tells.least(), 0.001);
  EXPECT_NEAR(e.tells.firstOverSecond / costOf(e.first, "coulomb"), 1, 0.04);
  EXPECT_NEAR(e.tells.secondOverFirst / costOf(e.second, "visc"), 1, 0.04);
}

TEST(SeparatingDesign, FindsABetterExperimentWithinTheLimits) {
  Asked asked;
  asked.question.first = "delay";  // without a push nothing tells it from the sensor's clock
  asked.question.second = "clock";
  asked.question.firstSize = asked.question.secondSize = 0.02;
  DesignSearchSettings settings;
  settings.candidates = 12;
  settings.generations = 2;
  settings.threads = 1;
  const SeparatingDesign design = asked.design();
  const SeparatingResult result = design.search(settings);
  ASSERT_TRUE(result.improved);
  EXPECT_EQ(result.runs, 12 + 1 + 1 + 2 * 16);
  EXPECT_GT(result.after.tells.least(), 5 * result.before.tells.least());
  EXPECT_LT(result.after.tells.firstDeviation, result.before.tells.firstDeviation);
  const DesignInputs& inputs = design.inputs();
  const VectorXd torque = inputs.torqueOf(result.after.trial, "elbow_flexion");
  EXPECT_LE(torque.cwiseAbs().maxCoeff(), asked.limits.coordinates[0].torque * (1 + 1e-9));
  EXPECT_LE(inputs.largestTorqueRate(result.after.trial, "elbow_flexion"),
            asked.limits.torqueRate * (1 + 1e-6));
  for (const Eigen::MatrixXd* motion :
       {&result.after.base, &result.after.first, &result.after.second}) {
    EXPECT_GE(motion->minCoeff(), asked.limits.coordinates[0].lower);
    EXPECT_LE(motion->maxCoeff(), asked.limits.coordinates[0].upper);
  }
  settings.threads = 2;
  const SeparatingResult again = design.search(settings);
  EXPECT_EQ(result.after.inputs, again.after.inputs);
  EXPECT_EQ(result.after.tells.least(), again.after.tells.least());
}

TEST(SeparatingDesign, SizesAreOfEitherEffectByAnyOfItsNames) {
  const SeparationQuestion q =
      withSizes({.first = "visc", .second = "coulomb"}, {{"viscous_damping", 0.2}});
  EXPECT_EQ(q.firstSize, 0.2);
  EXPECT_EQ(q.secondSize, 0);
  EXPECT_EQ(withSizes(q, {{"coulomb", -1}}).secondSize, -1);
  support::throwsSaying(
      [&] {
        (void)withSizes(q, {{"drag", 1}});
      },
      "size: 'drag' is not one of the two effects");
  support::throwsSaying(
      [&] {
        (void)withSizes(q, {{"visc", 0}});
      },
      "size: visc = 0, must not be 0");
}

// The trial of the table plays the predicted motion.
TEST(SeparatingDesign, ItsTableIsTheTrial) {
  const Asked asked;
  const SeparatingDesign design = asked.design();
  const SeparatingExperiment e = design.before();
  const Table table = plannedTable(design.system(), e.trial);
  const Trial trial = trialFrom(table, "table", asked.elbow.model);
  EXPECT_EQ(trial.muscles, e.trial.muscles);
  EXPECT_TRUE(trial.excitations == e.trial.excitations);
  ASSERT_EQ(trial.measured.size(), 1u);
  EXPECT_EQ(trial.measured[0].what.object, "elbow_flexion");
  EXPECT_TRUE(trial.measured[0].values == e.base);
}

TEST(SeparatingDesign, SaysWhatIsWrongWithAQuestion) {
  Asked asked;
  const auto saying = [&](const char* words) {
    support::throwsSaying([&] { asked.design(); }, words);
  };
  asked.question.second = "visc";
  saying("the two effects must differ");
  asked.question.second = "ghost";
  saying("no effect is called 'ghost'");
  asked.question.second = "coulomb";
  asked.question.secondSize = -1;
  saying("size of coulomb");
  asked.question.secondSize = 0;
  asked.question.observed.push_back(asked.question.observed[0]);
  saying("'elbow_flexion' is observed twice");
  asked.question.observed = {{{Observable::Kind::speed, "elbow_flexion", 0}, 0.1}};
  saying("'elbow_flexion' is free to move and must be observed, too");
  asked.question.observed.clear();
  saying("nothing is observed");
  asked.question.observed = {{ofCoordinate("elbow_flexion"), 0.0}};
  saying("noise of 'elbow_flexion' = 0, must be > 0");
  asked.question.observed[0].sd = 0.009;
  asked.limits.coordinates[0].torque = 0;
  saying("no input to design");
}

}  // namespace
}  // namespace bio::discover
