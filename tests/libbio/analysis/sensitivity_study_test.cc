#include "bio/analysis/sensitivity_study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;
using ::testing::HasSubstr;

/// The shipped trial with a question about two parameters.
struct Study : ShippedElbow {
  std::vector<StudiedTrial> trials;
  SensitivityQuestion question{options(), "elbow_flexion", 0.01, {}, {}};

  Study() {
    SimulationOptions simulation;
    simulation.step = 0.01;
    trials.push_back(
        studiedTrial(trial, model, system, {startCoordinates(trial, system, {}), {}}, simulation));
    question.selection = trials[0].catalogue.select({"TRI.radius", "hand.mass"});
  }
};

template <class Call>
std::string messageOf(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing is thrown";
}

// One noise for the coordinate, or the same as that of a channel: the same measurement.
TEST(SensitivityStudy, TheCoordinateIsAChannelLikeAnyOther) {
  Study study;
  const LocalSensitivity alone = localSensitivity(study.trials, study.question);
  study.question.observed = observedChannels({{"elbow_flexion", 0.01}}, study.model, study.system);
  const LocalSensitivity named = localSensitivity(study.trials, study.question);
  EXPECT_TRUE(alone.trials[0].gamma == named.trials[0].gamma);
  const Eigen::MatrixXd difference = alone.information.fisher - named.information.fisher;
  EXPECT_LT(difference.norm(), 1e-12 * alone.information.fisher.norm());
  // in standard deviations of the noise there
  EXPECT_NEAR(named.information.normalisedSensitivity[0] * 0.01,
              alone.information.normalisedSensitivity[0], 1e-14);
}

TEST(SensitivityStudy, InformationOfChannelsAddsUp) {
  Study study;
  const auto fisherOf = [&](const std::vector<std::pair<std::string, double>>& channels) {
    study.question.observed = observedChannels(channels, study.model, study.system);
    return localSensitivity(study.trials, study.question).information.fisher;
  };
  const Eigen::MatrixXd both = fisherOf({{"elbow_flexion.speed", 0.1}, {"BRA.tendon_force", 5}});
  const Eigen::MatrixXd speed = fisherOf({{"elbow_flexion.speed", 0.1}});
  const Eigen::MatrixXd force = fisherOf({{"BRA.tendon_force", 5}});
  EXPECT_LT((both - speed - force).norm(), 1e-12 * both.norm());
  EXPECT_LT((4 * fisherOf({{"BRA.tendon_force", 10}}) - force).norm(), 1e-12 * force.norm());
}

TEST(SensitivityStudy, WhatAFurtherChannelAddsIsThereWhenItIsObserved) {
  Study study;
  const LocalSensitivity now = localSensitivity(study.trials, study.question);
  const std::vector<ChannelGain> gains =
      furtherGains(study.trials, study.system, study.question, now.information);
  const std::size_t channels = furtherChannels(study.system, study.question).size();
  ASSERT_EQ(gains.size(), channels);
  EXPECT_EQ(channels,
            usualChannels(study.system).size() - 1);  // the coordinate is measured already
  for (const ChannelGain& gain : {gains.front(), gains[5]}) {
    EXPECT_NE(nameOf(gain.channel.what), "elbow_flexion");
    SensitivityQuestion then = study.question;
    then.observed = {{{Observable::Kind::coordinate, "elbow_flexion", 0}, 0.01}, gain.channel};
    const LocalSensitivity found = localSensitivity(study.trials, then);
    const Eigen::Index k = gain.parameter == "TRI.radius" ? 0 : 1;
    EXPECT_NEAR(found.information.boundJoint[k] / gain.after, 1, 1e-9);
    EXPECT_NEAR(now.information.boundJoint[k] / gain.before, 1, 1e-12);
  }
  EXPECT_FALSE(gainsTakeLong(285, 25));
  EXPECT_TRUE(gainsTakeLong(2000, 1));
}

TEST(SensitivityStudy, ASweepFollowsTheSensitivity) {
  const Study study;
  const std::size_t index = study.question.selection[1];  // hand.mass
  const double value = study.trials[0].catalogue.parameters()[index].value;
  const double h = 1e-3 * value;
  int calls = 0;
  const Sweep found = parameterSweep(study.trials[0], study.question.system, index,
                                     {value - h, value, value + h}, [&](double) { ++calls; });
  EXPECT_EQ(calls, 3);
  ASSERT_EQ(found.runs.size(), 3u);
  EXPECT_EQ(found.runs[1].largest, 0);
  EXPECT_GT(found.runs[2].largest, found.runs[2].rms);
  // the trial is measured at every step
  const Eigen::VectorXd gamma =
      localSensitivity(study.trials, study.question).trials[0].gamma.col(1);
  const Eigen::VectorXd slope =
      (found.runs[2].motion.q.row(0) - found.runs[0].motion.q.row(0)).transpose() / (2 * h);
  ASSERT_EQ(gamma.size(), slope.size());
  EXPECT_LT((gamma - slope).norm(), 1e-4 * gamma.norm());
  EXPECT_NEAR(found.runs[2].largest / (gamma.cwiseAbs().maxCoeff() * h), 1, 1e-2);
}

TEST(SensitivityStudy, AProfileIsLeastAtTheModelAndRisesToBothSides) {
  const Study study;
  const ProfileFinding found = likelihoodProfile(study.trials, study.question, 0);
  EXPECT_EQ(found.parameter.name, "TRI.radius");
  const auto& points = found.profile.points;
  ASSERT_EQ(points.size(), 13u);
  EXPECT_LT(points[6].cost, 1e-12);
  EXPECT_TRUE(found.boundedBelow());
  EXPECT_TRUE(found.boundedAbove());
  // three bounds off: 9/2 nats if all were linear
  EXPECT_NEAR(points.front().cost, 4.5, 0.5);
  EXPECT_NEAR(points.back().cost, 4.5, 0.5);
  int asked = 0;
  (void)likelihoodProfile(study.trials, study.question, 0, [&] { return ++asked < 3; });
  EXPECT_GE(asked, 3);
}

TEST(SensitivityStudy, GlobalSensitivityIsInTheUnitAskedFor) {
  const Study study;
  GlobalQuestion global;
  global.ensemble.samples = 2;
  const GlobalFinding plain = globalSensitivity(study.trials, study.question, global);
  global.unit = 10;
  global.sobol = false;
  const GlobalFinding scaled = globalSensitivity(study.trials, study.question, global);
  ASSERT_TRUE(plain.morris && plain.sobol && scaled.morris);
  EXPECT_FALSE(scaled.sobol);
  EXPECT_NEAR(scaled.morris->meanAbsolute[0] / plain.morris->meanAbsolute[0], 10, 1e-9);
  EXPECT_EQ(plain.undefined(), 0);
  EXPECT_EQ(plain.morris->runs, 6);
}

TEST(SensitivityStudy, SaysWhatIsWrong) {
  Study study;
  EXPECT_THAT(messageOf([&] {
                observedChannels({{"BRA.length", 1}}, study.model, study.system);
              }),
              HasSubstr("observe: 'BRA.length' is nothing that can be measured"));
  EXPECT_THAT(messageOf([&] {
                observedChannels({{"elbow_flexion", NAN}}, study.model, study.system);
              }),
              HasSubstr("observe: noise of 'elbow_flexion' = nan, must be > 0"));
  EXPECT_THAT(messageOf([&] { (void)localSensitivity({}, study.question); }),
              HasSubstr("must have at least one"));
  EXPECT_THAT(messageOf([&] { (void)likelihoodProfile({}, study.question, 0); }),
              HasSubstr("must have at least one"));
  const ParameterCatalogue& catalogue = study.trials[0].catalogue;
  EXPECT_THAT(
      messageOf([&] { indexInSelection(study.question.selection, catalogue, "ulna.mass"); }),
      HasSubstr("profile: ulna.mass is not one of the parameters"));
  EXPECT_EQ(indexInSelection(study.question.selection, catalogue, "hand.mass"), 1);
  EXPECT_THAT(messageOf([&] {
                (void)parameterSweep(study.trials[0], study.question.system,
                                     study.question.selection[0], {0.2});
              }),
              HasSubstr("values: TRI.radius = 0.2 m, must be 0.0048 to 0.0205 m: TRIlong"));
  study.question.selection = catalogue.select({"all"});
  EXPECT_THAT(messageOf([&] { (void)globalSensitivity(study.trials, study.question, {}); }),
              HasSubstr("must be at most 32"));
}

}  // namespace
}  // namespace bio
