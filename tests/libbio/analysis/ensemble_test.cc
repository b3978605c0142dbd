#include "bio/analysis/ensemble.h"

#include <gtest/gtest.h>

#include "bio/observation/trial_predictor.h"
#include "info/probability/random_stream.h"
#include "support/shipped_elbow.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using fixtures::forSeconds;
using fixtures::ShippedElbow;

const std::vector<double> course = {0, 0.25, 2.5};

SystemBatch ensembleOn(const ShippedElbow& elbow, const std::vector<std::size_t>& selection) {
  return {elbow.catalogue,  ShippedElbow::options(),
          elbow.excitation, {{ofCoordinate("elbow_flexion"), elbow.trial.measured.front()}},
          course,           selection,
          forSeconds(2.5)};
}

// The second way compiles every path anew and knows nothing of ensembles. In 2.5 s the elbow bends
// so far that the triceps touches its cylinder.
TEST(SystemBatch, RunsAreThoseOfArmsCompiledFromNothing) {
  const ShippedElbow elbow;
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"TRI.radius", "hand.mass", "BRA.tendon_slack_length"},
        {"BIClong.point5.x", "ulna.mass_center.y", "initial.elbow_flexion", "emg.delay"},
        {"all"}}) {
    const auto selection = elbow.catalogue.select(names);
    const SystemBatch ensemble = ensembleOn(elbow, selection);
    const TrialPredictor experiment(elbow.catalogue, ShippedElbow::options(), elbow.excitation,
                                    "elbow_flexion", course, selection, forSeconds(2.5));
    const Trajectory nominal = experiment.simulate(elbow.catalogue.values(selection));
    info::RandomStream random(3, 0);
    for (int draw = 0; draw < 4; ++draw) {
      Eigen::VectorXd theta = elbow.catalogue.values(selection);
      for (std::size_t i = 0; i < selection.size(); ++i) {
        const ModelParameter& p = elbow.catalogue.parameters()[selection[i]];
        theta[static_cast<Eigen::Index>(i)] += 0.2 * p.sd * random.normal();
        theta[static_cast<Eigen::Index>(i)] =
            std::clamp(theta[static_cast<Eigen::Index>(i)], p.lower, p.upper);
      }
      const EnsembleRun drawn = ensemble.run(theta);
      const Trajectory motion = experiment.simulate(theta);
      ASSERT_EQ(drawn.outcome, "ok");
      EXPECT_TRUE(std::isnan(drawn.failedAt));
      const ChannelRun& run = drawn.channels.at(0);
      EXPECT_NEAR(run.last, motion.q(0, motion.q.cols() - 1), 1e-9);
      EXPECT_NEAR(run.lowest, motion.q.minCoeff(), 1e-9);
      EXPECT_NEAR(run.highest, motion.q.maxCoeff(), 1e-9);
      EXPECT_LT((run.atCourse - experiment.outputs(theta)).cwiseAbs().maxCoeff(), 1e-9);
      const Eigen::ArrayXd change = (motion.q - nominal.q).row(0).transpose();
      EXPECT_NEAR(run.rmsFromNominal, std::sqrt(change.square().mean()), 1e-9);
      EXPECT_NEAR(run.rmsError,
                  compareWithMeasured(elbow.system, motion, elbow.trial.measured.front()).rms,
                  1e-9);
    }
  }
}

// Among others, alone, beside one that is impossible: the same to the last bit.
TEST(SystemBatch, ARunDoesNotDependOnTheOthers) {
  const ShippedElbow elbow;
  const auto selection =
      elbow.catalogue.select({"TRI.radius", "BRA.tendon_slack_length", "emg.delay"});
  const SystemBatch ensemble = ensembleOn(elbow, selection);
  const Eigen::VectorXd nominal = elbow.catalogue.values(selection);
  std::vector<Eigen::VectorXd> thetas(7, nominal);
  for (int i = 0; i < 7; ++i) thetas[static_cast<std::size_t>(i)][1] *= 1 + 0.003 * i;
  thetas[3][0] = -0.01;
  thetas[5][2] = 0.013;
  const std::vector<EnsembleRun> together = ensemble.run(thetas);
  ASSERT_EQ(together.size(), 7u);
  EXPECT_EQ(together[3].outcome, "impossible");
  for (std::size_t i = 0; i < 7; ++i) {
    if (i == 3) continue;
    const EnsembleRun alone = ensemble.run(thetas[i]);
    EXPECT_EQ(together[i].outcome, "ok");
    EXPECT_EQ(together[i].channels[0].last, alone.channels[0].last);
    EXPECT_EQ(together[i].channels[0].rmsError, alone.channels[0].rmsError);
    EXPECT_EQ(together[i].channels[0].atCourse, alone.channels[0].atCourse);
  }
  EXPECT_NE(together[0].channels[0].last, together[1].channels[0].last);
}

TEST(SystemBatch, TheNominalRunIsNoDistanceFromItself) {
  const ShippedElbow elbow;
  const SystemBatch ensemble = ensembleOn(elbow, elbow.catalogue.select({"TRI.radius"}));
  EXPECT_EQ(ensemble.nominal().channels[0].rmsFromNominal, 0);
  EXPECT_GT(ensemble.nominal().channels[0].rmsError, 0);
}

TEST(SystemBatch, WhatCannotBeSimulatedIsAnOutcome) {
  const ShippedElbow elbow;
  const SystemBatch ensemble = ensembleOn(elbow, elbow.catalogue.select({"TRI.radius"}));
  const EnsembleRun run = ensemble.run(Eigen::VectorXd::Constant(1, -0.01));
  EXPECT_EQ(run.outcome, "impossible");
  const ChannelRun& none = run.channels.at(0);
  EXPECT_TRUE(std::isnan(none.last));
  EXPECT_EQ(none.atCourse.size(), 3);
  EXPECT_FALSE(none.atCourse.array().isFinite().any());
  support::throwsSaying([&] { (void)ensemble.run(Eigen::VectorXd::Zero(2)); },
                        "2 values for 1 parameters");
}

TEST(SystemBatch, RefusesAChannelThatIsNotThereAndAModelThatDoesNotFinish) {
  const ShippedElbow elbow;
  const auto make = [&](const std::string& coordinate, const SimulationOptions& options) {
    return [&elbow, coordinate, options] {
      (void)SystemBatch(elbow.catalogue, ShippedElbow::options(), elbow.excitation,
                        {{ofCoordinate(coordinate), {}}}, course, {}, options);
    };
  };
  support::throwsSaying(make("pro_sup", forSeconds(1)),
                        "measured 'pro_sup': its coordinate must be free");
  SimulationOptions impatient = forSeconds(1);
  impatient.maxIterations = 1;
  impatient.maxHalvings = 0;
  support::throwsSaying(make("elbow_flexion", impatient), "does not reach the end of the trial");
}

}  // namespace
}  // namespace bio
