#include "bio/observation/parameter_information.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;
using ::testing::Contains;
using ::testing::HasSubstr;

Eigen::MatrixXd gammaOf(const ShippedElbow& elbow, const std::vector<std::size_t>& selection) {
  std::vector<double> times;
  for (int k = 0; k <= 225; ++k) times.push_back(0.02 * k);
  SimulationOptions options;
  options.duration = 4.5;
  const TrialPredictor experiment(elbow.catalogue, ShippedElbow::options(), elbow.excitation,
                                  "elbow_flexion", times, selection, options);
  return experiment.withSensitivities(elbow.catalogue.values(selection)).gamma;
}

TEST(ParameterInformation, OneParameterHasTheBoundOfItsSumOfSquares) {
  const ShippedElbow elbow;
  const auto radius = elbow.catalogue.select({"TRI.radius"});
  const Eigen::MatrixXd gamma = gammaOf(elbow, radius);
  const double noise = 0.01;
  const ParameterInformation known = informationAbout(elbow.catalogue, radius, {gamma}, noise);
  const double information = gamma.squaredNorm() / (noise * noise);
  const double sd = elbow.catalogue.parameters()[radius[0]].sd;
  EXPECT_NEAR(known.boundAlone[0] * std::sqrt(information), 1, 1e-12);
  EXPECT_NEAR(known.boundJoint[0] * std::sqrt(information + 1 / (sd * sd)), 1, 1e-12);
  EXPECT_NEAR(known.normalisedSensitivity[0],
              sd * std::sqrt(gamma.squaredNorm() / static_cast<double>(gamma.rows())), 1e-15);
  EXPECT_TRUE(known.identifiable[0]);
}

TEST(ParameterInformation, TwoTrialsAddUp) {
  const ShippedElbow elbow;
  const auto selection = elbow.catalogue.select({"TRI.radius", "hand.mass"});
  const Eigen::MatrixXd gamma = gammaOf(elbow, selection);
  const auto one = informationAbout(elbow.catalogue, selection, {gamma}, 0.02);
  const auto two = informationAbout(elbow.catalogue, selection, {gamma, gamma}, 0.02);
  EXPECT_LT((two.fisher - 2 * one.fisher).norm(), 1e-12 * two.fisher.norm());
  EXPECT_NEAR(two.boundAlone[0] * std::sqrt(2.0), one.boundAlone[0], 1e-12);
}

// F0 scales the tendon too, but in a stiff tendon force and active force are nearly one.
TEST(ParameterInformation, WhatLooksAlikeIsSaidInWords) {
  const ShippedElbow elbow;
  const auto selection =
      elbow.catalogue.select({"BRA.max_isometric_force", "BRA.active_force_scale", "emg.BRA.gain"});
  const ParameterInformation known =
      informationAbout(elbow.catalogue, selection, {gammaOf(elbow, selection)}, 0.02);
  const auto pairs = alikePairs(known.fisher, 0.99);
  ASSERT_FALSE(pairs.empty());
  EXPECT_LT(pairs[0].correlation, -0.99);
  EXPECT_THAT(known.sentences, Contains(HasSubstr("are nearly indistinguishable: only ")));
  EXPECT_LT(known.determinedCombinations, 3);
}

TEST(ParameterInformation, WhatMovesNothingIsSaidInWords) {
  const ShippedElbow elbow;
  const auto selection = elbow.catalogue.select({"TRI.rotation.z", "BIC_BRD.radius", "hand.mass"});
  const ParameterInformation known =
      informationAbout(elbow.catalogue, selection, {gammaOf(elbow, selection)}, 0.02);
  EXPECT_THAT(known.sentences,
              Contains("TRI.rotation.z, BIC_BRD.radius have no effect on what is measured"));
  EXPECT_FALSE(known.identifiable[0]);
  EXPECT_TRUE(std::isinf(known.boundAlone[1]));
  EXPECT_NEAR(known.boundJoint[1], elbow.catalogue.parameters()[selection[1]].sd, 1e-15);
}

TEST(ParameterInformation, RefusesWhatDoesNotFit) {
  const ShippedElbow elbow;
  const auto one = elbow.catalogue.select({"hand.mass"});
  const Eigen::MatrixXd gamma = Eigen::MatrixXd::Ones(3, 1);
  EXPECT_THROW(informationAbout(elbow.catalogue, one, {gamma}, 0), std::invalid_argument);
  EXPECT_THROW(informationAbout(elbow.catalogue, one, {gamma}, std::nan("")),
               std::invalid_argument);
  EXPECT_THROW(informationAbout(elbow.catalogue, one, {Eigen::MatrixXd::Ones(3, 2)}, 1),
               std::invalid_argument);
  EXPECT_THROW(informationAbout(elbow.catalogue, one, {gamma * std::nan("")}, 1),
               std::domain_error);
  EXPECT_THROW(informationAbout(elbow.catalogue, {}, {gamma}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace bio
