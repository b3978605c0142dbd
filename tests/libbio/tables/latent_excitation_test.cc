#include "bio/tables/latent_excitation.h"

#include <gmock/gmock.h>

#include <cmath>

#include "bio/emg/emg_mapping.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using support::throwsSaying;

const Eigen::VectorXd fine = Eigen::VectorXd::LinSpaced(41, 0, 2);

double logOdds(double x) {
  return std::log(x / (1 - x));
}

TEST(LatentExcitation, KnotsAreEquallySpacedNoFurtherThanAsked) {
  const LatentExcitation latent = latentExcitation({"BRA", 0.5, 0.3}, 1, 2);
  ASSERT_EQ(latent.knots.size(), 5u);
  EXPECT_DOUBLE_EQ(latent.knots[1] - latent.knots[0], 0.25);
  EXPECT_EQ(latent.knots.back(), 2);
  EXPECT_EQ(latent.sd, 0.5);
  EXPECT_TRUE(latent.values.isZero(0));
  EXPECT_EQ(latentExcitation({"BRA", 1, 5}, 1, 2).knots.size(), 2u);
}

// Where hats overlap they add up to 1, so that equal knots are a constant.
TEST(LatentExcitation, IsStraightInTheLogOddsBetweenKnotsAndStaysWithinBounds) {
  LatentExcitation latent{{0, 1, 2}, Eigen::Vector3d(1, -2, 8), 1};
  const Eigen::RowVectorXd course = Eigen::RowVectorXd::Constant(41, 0.2);
  const Eigen::RowVectorXd x = withLatent(fine, course, latent);
  EXPECT_NEAR(logOdds(x[0]), logOdds(0.2) + 1, 1e-12);
  EXPECT_NEAR(logOdds(x[10]), logOdds(0.2) - 0.5, 1e-12);
  EXPECT_NEAR(logOdds(x[35]), logOdds(0.2) + 5.5, 1e-12);
  EXPECT_TRUE((x.array() > 0 && x.array() < 1).all());
  latent.values.setConstant(0.7);
  const Eigen::RowVectorXd same = withLatent(fine, course, latent);
  EXPECT_NEAR(same.minCoeff(), same.maxCoeff(), 1e-15);
  // 0 leaves the course, cut to where its log-odds are finite
  latent.values.setZero();
  EXPECT_NEAR(withLatent(fine, course, latent)[7], 0.2, 1e-15);
  EXPECT_NEAR(withLatent(fine, 0 * course, latent)[7], 0.001, 1e-15);
}

TEST(LatentExcitation, SlopesMatchDifferencesThroughTheWholeMapping) {
  const std::vector<std::string> muscles = {"A", "B"};
  Eigen::MatrixXd u(41, 2);
  u.col(0).setLinSpaced(0.05, 0.4);
  u.col(1).setLinSpaced(0.6, 0.3);
  const ExcitationSignal trial({fine.begin(), fine.end()}, u);
  EmgMapping mapping{{{"A", 0.9}}, 0, -1};
  mapping.offset["A"] = 0.01;
  mapping.crosstalk = {{"A", "B", 0.1}};
  mapping.fatigue = 0.3;
  mapping.latent["A"] = {{0, 0.8, 2}, Eigen::Vector3d(0.4, -0.3, 0.1), 1};
  const auto rows = [&](std::size_t knot, double change) {
    EmgMapping changed = mapping;
    changed.latent["A"].values[static_cast<Eigen::Index>(knot)] += change;
    const ExcitationSignal driven = drivenExcitation(trial, muscles, changed);
    Eigen::MatrixXd all(2, 41);
    std::size_t hint = 0;
    for (Eigen::Index k = 0; k < 41; ++k) driven.at(fine[k], hint, all.col(k));
    return all;
  };
  const EmgDerivatives d = emgDerivatives(trial, muscles, mapping);
  for (std::size_t knot = 0; knot < 3; ++knot) {
    const Eigen::MatrixXd difference = (rows(knot, 1e-5) - rows(knot, -1e-5)) / 2e-5;
    const Eigen::RowVectorXd dx = latentSlope(fine, d.rows.row(0), mapping.latent["A"], knot);
    const Eigen::RowVectorXd own = d.tired(0, d.signal.row(0).cwiseProduct(dx));
    const Eigen::RowVectorXd other = d.tired(1, -0.1 * d.signal.row(1).cwiseProduct(dx));
    EXPECT_LT((own - difference.row(0)).cwiseAbs().maxCoeff(), 1e-9) << knot;
    EXPECT_LT((other - difference.row(1)).cwiseAbs().maxCoeff(), 1e-9) << knot;
    EXPECT_GT(own.cwiseAbs().maxCoeff(), 0.01);
  }
}

TEST(LatentExcitation, TheHeaderReadsBack) {
  const std::vector<LatentDeclaration> declared = {{"BRA", 1, 0.25}, {"TRIlat", 0.5, 1}};
  EXPECT_EQ(latentHeader(declared), "BRA 1 0.25; TRIlat 0.5 1");
  EXPECT_EQ(latentInHeader(latentHeader(declared)), declared);
  for (const char* wrong : {"BRA", "BRA 1", "BRA 1 0.25 3", "BRA x 1", ";"}) {
    throwsSaying([&] { latentInHeader(wrong); }, "must be MUSCLE SD KNOTS_S");
  }
  throwsSaying([] { latentInHeader("BRA 0 1"); }, "sd = 0, must be > 0");
  throwsSaying([] { latentInHeader("BRA 1 -1"); }, "knots every -1 s, must be > 0");
  throwsSaying([] { latentInHeader("BRA 1 1;BRA 1 1"); }, "'BRA' is given twice");
}

TEST(LatentExcitation, RefusesWhatHasNoMeaning) {
  throwsSaying([] { latentExcitation({"BRA", 1, 1e-6}, 0, 2); }, "must be 2 to 10000");
  throwsSaying(
      [] {
        withLatent(fine, fine.transpose(), {{0}, Eigen::VectorXd::Zero(1), 1});
      },
      "knots must rise");
  throwsSaying(
      [] {
        withLatent(fine, fine.transpose(), {{0, 1}, Eigen::VectorXd::Zero(3), 1});
      },
      "one finite value for each");
  const ExcitationSignal trial({0, 1}, Eigen::MatrixXd::Constant(2, 1, 0.5));
  EmgMapping mapping;
  mapping.latent["B"] = {{0, 1}, Eigen::VectorXd::Zero(2), 1};
  throwsSaying([&] { drivenExcitation(trial, {"A"}, mapping); }, "a muscle that moves");
  mapping.saturation["B"] = 1;
  throwsSaying([&] { drivenExcitation(trial, {"B"}, mapping); }, "does not saturate");
}

}  // namespace
}  // namespace bio
