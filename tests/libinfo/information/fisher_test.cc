#include "info/information/fisher.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/closed_forms.h"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using info::OutputCovariance;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

const OutputCovariance kUnit(MatrixXd::Identity(1, 1));

// n equidistant samples of a line, noise σ: var(slope) = σ²/Σ(t − t̄)², the textbook's.
TEST(Fisher, BoundsTheSlopeOfALineAsRegressionDoes) {
  const VectorXd t = VectorXd::LinSpaced(11, 0, 10);
  const auto line = support::straightLine(t).withSensitivities(VectorXd::Zero(2));
  const OutputCovariance covariance(MatrixXd::Constant(1, 1, 0.25));
  const MatrixXd bound = info::cramerRaoBound(info::fisherInformation(line.gamma, covariance));
  EXPECT_NEAR(bound(1, 1), 0.25 / 110, 1e-15);
  EXPECT_NEAR(bound(0, 0), 0.25 * (1.0 / 11 + 25.0 / 110), 1e-14);
  EXPECT_NEAR(bound(0, 1), -0.25 * 5 / 110, 1e-14);
}

TEST(Fisher, AddsUpOverIndependentSamplesAndSkipsMissingOnes) {
  const MatrixXd gamma = MatrixXd::Random(6, 2);
  const OutputCovariance sigma(MatrixXd((Eigen::Matrix2d() << 3, 1, 1, 2).finished()));
  const MatrixXd all = info::fisherInformation(gamma, sigma);
  MatrixXd sum = MatrixXd::Zero(2, 2);
  for (int k = 0; k < 3; ++k)
    sum += info::fisherInformation(MatrixXd(gamma.middleRows(2 * k, 2)), sigma);
  EXPECT_LT((all - sum).norm(), 1e-14 * all.norm());
  info::ObservationMask observed = info::ObservationMask::Constant(2, 3, true);
  observed.col(1).setConstant(false);
  const MatrixXd part = info::fisherInformation(gamma, sigma, observed);
  EXPECT_LT((part - sum + info::fisherInformation(MatrixXd(gamma.middleRows(2, 2)), sigma)).norm(),
            1e-14 * all.norm());
}

// The bound must not depend on units: rescaled parameters give the rescaled bound, however far.
TEST(Fisher, BoundFollowsAChangeOfUnits) {
  const VectorXd scale = (VectorXd(2) << 1e-9, 1e6).finished();
  const MatrixXd information = (Eigen::Matrix2d() << 5, 2, 2, 3).finished();
  const MatrixXd bound =
      info::cramerRaoBound(scale.asDiagonal() * information * scale.asDiagonal());
  const MatrixXd back = scale.asDiagonal() * bound * scale.asDiagonal();
  EXPECT_LT((back - information.inverse()).norm(), 1e-13);
}

TEST(Fisher, NamesTheParameterWithoutInformation) {
  const MatrixXd information = (Eigen::Matrix2d() << 5, 0, 0, 0).finished();
  EXPECT_THAT(
      [&] {
        info::cramerRaoBound(information, {"mass", "damping"});
      },
      ThrowsMessage<std::domain_error>(AllOf(HasSubstr("zero information"), HasSubstr("damping"))));
  const MatrixXd coupled = (Eigen::Matrix3d() << 1, 2, 0, 2, 4, 0, 0, 0, 1).finished();
  EXPECT_THAT(
      [&] {
        info::cramerRaoBound(coupled, {"m1", "m2", "c"});
      },
      ThrowsMessage<std::domain_error>(HasSubstr("parameters m1, m2:")));
}

// Only rounding is tolerated, whatever the units.
TEST(Fisher, RefusesABoundOfHalfAMatrix) {
  Eigen::Matrix2d information{{5, 2}, {2, 3}};
  const Eigen::DiagonalMatrix<double, 2> units(1e-9, 1e6);
  const MatrixXd bound = information.inverse();
  information(0, 1) *= 1 + 1e-9;
  EXPECT_LT((info::cramerRaoBound(information) - bound).norm(), 1e-8);
  EXPECT_NO_THROW(info::cramerRaoBound(units * information * units));
  for (const double factor : {0.0, -1.0, 1 + 1e-4}) {
    information(0, 1) = 2 * factor;
    EXPECT_THAT([&] { info::cramerRaoBound(units * information * units); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("must be symmetric")));
  }
  information(0, 1) = 1;
  EXPECT_THAT(
      [&] {
        info::cramerRaoBound(information, {"mass", "damping"});
      },
      ThrowsMessage<std::invalid_argument>(
          HasSubstr("but entry (mass, damping) is 1 and (damping, mass) is 2")));
}

TEST(Fisher, RefusesWhatItCannotMean) {
  EXPECT_THROW(info::stack({MatrixXd::Ones(1, 2), MatrixXd::Ones(2, 2)}), std::invalid_argument);
  const MatrixXd nan = MatrixXd::Constant(1, 1, std::nan(""));
  EXPECT_THROW(info::fisherInformation(nan, kUnit), std::domain_error);
  EXPECT_THROW(info::cramerRaoBound(nan), std::domain_error);
  EXPECT_THROW(info::cramerRaoBound(MatrixXd::Ones(1, 2)), std::invalid_argument);
}

}  // namespace
