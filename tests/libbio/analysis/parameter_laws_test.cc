#include "bio/analysis/parameter_laws.h"

#include <gtest/gtest.h>

#include "info/probability/random_stream.h"
#include "support/shipped_elbow.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;
using support::throwsSaying;

const ShippedElbow& lawsElbow() {
  static const ShippedElbow elbow;
  return elbow;
}

NamedCovariance radiusAndMass() {
  NamedCovariance covariance{{"TRI.radius", "hand.mass"}, Eigen::MatrixXd(2, 2)};
  covariance.values << 1e-6, -1.5e-5, -1.5e-5, 4e-4;
  return covariance;
}

TEST(ParameterLaws, AreTheCatalogueUnlessTheRequestSaysOtherwise) {
  const ParameterCatalogue& catalogue = lawsElbow().catalogue;
  const ParameterLaws laws = parameterLaws(catalogue, {.names = {"hand.mass", "TRI.radius"},
                                                       .spread = 0.5,
                                                       .priors = {{"hand.mass", {0.6, 0.2}}},
                                                       .bounds = {{"hand.mass", {0.5, 0.9}}}});
  ASSERT_EQ(laws.parameters.size(), 2u);
  const DrawnParameter& mass = laws.parameters[0];
  EXPECT_EQ(mass.name, "hand.mass");
  EXPECT_EQ(mass.unit, "kg");
  EXPECT_EQ(mass.law.mean, 0.6);
  EXPECT_EQ(mass.law.sd, 0.1);  // the factor applies to given ones, too
  EXPECT_EQ(mass.law.lower, 0.5);
  EXPECT_EQ(mass.law.upper, 0.9);
  const ModelParameter& radius = catalogue.parameters()[catalogue.find("TRI.radius")];
  EXPECT_EQ(laws.parameters[1].law.mean, radius.value);
  EXPECT_EQ(laws.parameters[1].law.sd, 0.5 * radius.sd);
  EXPECT_EQ(laws.parameters[1].law.upper, radius.upper);
  EXPECT_EQ(laws.at(Eigen::Vector2d(0, 1))[0], mass.law.quantile(0));
  EXPECT_EQ(laws.at(Eigen::Vector2d(0, 1))[1], laws.parameters[1].law.quantile(1));
  EXPECT_FALSE(laws.together);
}

// Bounds far away: normal distributions with exactly the given covariance.
TEST(ParameterLaws, DrawsOfACovarianceHaveIt) {
  const ParameterLaws laws = parameterLaws(
      lawsElbow().catalogue, {.names = {"BRA.pennation_angle", "hand.mass", "TRI.radius"},
                              .bounds = {{"TRI.radius", {0.001, 0.0205}}},
                              .covariance = radiusAndMass()});
  ASSERT_TRUE(laws.together);
  constexpr int n = 4000;
  Eigen::MatrixXd draws(n, 3);
  for (int k = 0; k < n; ++k) {
    info::RandomStream random(1, static_cast<std::uint64_t>(k));
    Eigen::VectorXd unit(3);
    for (double& u : unit) u = random.uniform();
    draws.row(k) = laws.at(unit);
  }
  const Eigen::MatrixXd centred = draws.rowwise() - draws.colwise().mean();
  const Eigen::MatrixXd covariance = centred.transpose() * centred / (n - 1);
  const double pennation = covariance(0, 0);
  Eigen::Matrix3d wanted;
  wanted << pennation, 0, 0, 0, 4e-4, -1.5e-5, 0, -1.5e-5, 1e-6;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double error =
          std::sqrt((wanted(i, i) * wanted(j, j) + wanted(i, j) * wanted(i, j)) / n);
      EXPECT_NEAR(covariance(i, j), wanted(i, j), 4 * error) << i << ' ' << j;
    }
  }
}

TEST(ParameterLaws, ACovarianceAloneSaysWhatIsDrawn) {
  const ParameterLaws laws = parameterLaws(lawsElbow().catalogue, {.covariance = radiusAndMass()});
  ASSERT_EQ(laws.parameters.size(), 2u);
  EXPECT_EQ(laws.parameters[0].name, "TRI.radius");
  EXPECT_DOUBLE_EQ(laws.parameters[0].law.sd, 1e-3);
  EXPECT_DOUBLE_EQ(laws.parameters[1].law.sd, 2e-2);
  EXPECT_DOUBLE_EQ(radiusAndMass().correlation()(0, 1), -0.75);
}

TEST(ParameterLaws, SayWhatIsWrong) {
  const auto refused = [](const LawRequest& request, const char* words) {
    throwsSaying([&] { parameterLaws(lawsElbow().catalogue, request); }, words);
  };
  refused({.names = {"hand.mass"}, .priors = {{"ulna.mass", {1, 0.1}}}},
          "prior: ulna.mass is not one of the parameters");
  refused({.names = {"hand.mass"}, .bounds = {{"ulna.mass", {1, 2}}}, .optionPrefix = "--"},
          "--bounds: ulna.mass is not one of the --parameters");
  refused({.names = {"BRA.pennation_angle"},
           .priors = {{"BRA.pennation", {0, 1}}, {"BRA.pennation_angle", {0, 2}}}},
          "prior: BRA.pennation_angle is given under another name as well");
  refused({.names = {"TRI.radius"}, .bounds = {{"TRI.radius", {0.01, 0.022}}}},
          "bounds: TRI.radius = 0.022 m, must be below 0.0206");
  refused({.names = {"hand.mass"}, .bounds = {{"hand.mass", {2, 3}}}}, "must lie within 2 and 3");
  refused({.names = {"hand.mass"}, .spread = 0}, "spread = 0, must be > 0");
  refused({.names = {"hand.mass"}, .covariance = radiusAndMass()},
          "covariance: TRI.radius is not one of the parameters");
  refused({.priors = {{"hand.mass", {0.5, 0.1}}}, .covariance = radiusAndMass()},
          "prior: hand.mass already has its distribution from covariance");
  refused({.shape = info::Marginal::Shape::even, .covariance = radiusAndMass()},
          "covariance cannot be combined with distribution uniform");
  NamedCovariance wrong = radiusAndMass();
  wrong.values(0, 1) = 0;
  refused({.covariance = wrong}, "must be symmetric");
  wrong.values(1, 0) = NAN;
  refused({.covariance = wrong}, "covariance: the row of hand.mass has a value that is not finite");
  wrong = radiusAndMass();
  wrong.names.push_back("ulna.mass");
  refused({.covariance = wrong}, "2 × 2 values for 3 names, must be as many");
  wrong = radiusAndMass();
  wrong.names[1] = "TRI.radius";
  refused({.covariance = wrong}, "TRI.radius is listed twice");
  wrong = radiusAndMass();
  wrong.values(0, 1) = wrong.values(1, 0) = 3e-5;
  refused({.covariance = wrong}, "covariance: not positive definite");
}

}  // namespace
}  // namespace bio
