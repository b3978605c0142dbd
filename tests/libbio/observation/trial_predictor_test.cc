#include "bio/observation/trial_predictor.h"

#include <gtest/gtest.h>

#include "info/estimation/estimate.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::forSeconds;
using fixtures::ShippedElbow;

TrialPredictor experimentOn(const ShippedElbow& elbow, const std::vector<std::string>& names,
                            std::vector<double> times) {
  return {elbow.catalogue,  ShippedElbow::options(),       elbow.excitation, "elbow_flexion",
          std::move(times), elbow.catalogue.select(names), forSeconds(1.0)};
}

TEST(TrialPredictor, GivesTheMotionAtTheTimesAskedFor) {
  const ShippedElbow elbow;
  const TrialPredictor e = experimentOn(elbow, {"TRI.radius"}, {0, 0.25, 0.333, 1.0});
  const Eigen::VectorXd theta = elbow.catalogue.values(e.selection());
  const Trajectory motion = e.simulate(theta);
  const Eigen::VectorXd y = e.outputs(theta);
  EXPECT_DOUBLE_EQ(y[0], motion.q(0, 0));
  EXPECT_NEAR(y[1], motion.q(0, 25), 1e-12);
  EXPECT_NEAR(y[2], 0.7 * motion.q(0, 33) + 0.3 * motion.q(0, 34), 1e-3);
  EXPECT_NEAR(y[3], motion.q(0, 100), 1e-12);
  EXPECT_EQ(e.withSensitivities(theta).outputs, y);
}

TEST(TrialPredictor, GammaMatchesDifferencesAwayFromTheModelsValues) {
  const ShippedElbow elbow;
  const std::vector<std::string> names = {"TRI.radius",
                                          "BRA.tendon_strain_scale",
                                          "BIClong.passive_force_scale",
                                          "hand.mass",
                                          "emg.BRA.gain",
                                          "emg.delay",
                                          "initial.elbow_flexion",
                                          "emg.nonlinearity",
                                          "BRD.active_force_width"};
  const TrialPredictor e = experimentOn(elbow, names, {0.1, 0.335, 0.7, 0.99});
  Eigen::VectorXd theta = elbow.catalogue.values(e.selection());
  theta << 0.017, 1.3, 1.4, 0.7, 1.2, 0.0123, theta[6] + 0.05, -0.7, 1.1;
  const auto at = e.withSensitivities(theta);
  for (Eigen::Index j = 0; j < theta.size(); ++j) {
    const double h = 1e-5 * std::max(std::abs(theta[j]), 0.1);
    Eigen::VectorXd plus = theta, minus = theta;
    plus[j] += h;
    minus[j] -= h;
    const Eigen::VectorXd difference = (e.outputs(plus) - e.outputs(minus)) / (2 * h);
    EXPECT_LT((difference - at.gamma.col(j)).cwiseAbs().maxCoeff(),
              2e-5 * at.gamma.col(j).cwiseAbs().maxCoeff() + 1e-9)
        << names[static_cast<std::size_t>(j)];
  }
}

TEST(TrialPredictor, OutsideTheModelsDomainNothingIsFinite) {
  const ShippedElbow elbow;
  const TrialPredictor e = experimentOn(elbow, {"TRI.radius"}, {0.5});
  EXPECT_TRUE(std::isnan(e.outputs(Eigen::VectorXd::Constant(1, -0.01))[0]));
  EXPECT_TRUE(std::isnan(e.withSensitivities(Eigen::VectorXd::Constant(1, -0.01)).gamma(0, 0)));
}

// The first step of Gauss and Newton leads to half the negative force, which no muscle has.
TEST(TrialPredictor, LetsASearchStepBackFromWhereASimulationFails) {
  const ShippedElbow elbow;
  const TrialPredictor e = experimentOn(elbow, {"BRA.max_isometric_force"}, {0.3, 0.6, 0.9});
  const double start = elbow.catalogue.values(e.selection())[0];
  const auto at = e.withSensitivities(Eigen::VectorXd::Constant(1, start));
  const Eigen::MatrixXd measured = at.outputs - at.gamma.col(0) * 1.5 * start;
  info::Predictor predictor = joined({e});
  int outside = 0;
  const auto outputs = predictor.outputs;
  predictor.outputs = [&, outputs](const Eigen::VectorXd& theta) {
    const Eigen::MatrixXd y = outputs(theta);
    if (!y.allFinite()) {
      ++outside;
      EXPECT_LT(theta[0], 0);
    }
    return y;
  };
  const auto linearised = predictor.withSensitivities;
  predictor.withSensitivities = [&, linearised](const Eigen::VectorXd& theta) {
    const info::Prediction y = linearised(theta);
    outside += y.outputs.allFinite() ? 0 : 1;
    return y;
  };
  const info::LeastSquares problem(
      predictor,
      {measured.transpose(), info::OutputCovariance(Eigen::MatrixXd::Constant(1, 1, 1e-4))},
      {{.name = "force", .start = start}});
  const info::Estimate found = info::estimate(problem);
  EXPECT_GE(outside, 1);
  EXPECT_GT(found.parameters[0], 0);
  EXPECT_LT(found.parameters[0], start);
  EXPECT_LT(found.cost, 0.5 * (measured - at.outputs).squaredNorm() / 1e-4);
}

TEST(TrialPredictor, JoinsTrialsOneBehindTheOther) {
  const ShippedElbow elbow;
  const TrialPredictor first = experimentOn(elbow, {"hand.mass"}, {0.2, 0.4});
  const TrialPredictor second = experimentOn(elbow, {"hand.mass"}, {0.3});
  const info::Predictor both = joined({first, second});
  const Eigen::VectorXd theta = elbow.catalogue.values(first.selection());
  const info::Prediction p = both.withSensitivities(theta);
  EXPECT_EQ(p.outputs.cols(), 3);
  EXPECT_DOUBLE_EQ(p.outputs(0, 2), second.outputs(theta)[0]);
  EXPECT_DOUBLE_EQ(p.gamma(1, 0), first.withSensitivities(theta).gamma(1, 0));
  EXPECT_THROW(joined({first, experimentOn(elbow, {"ulna.mass"}, {0.3})}), std::invalid_argument);
}

TEST(TrialPredictor, RefusesTimesOutsideAndCoordinatesThatAreNotFree) {
  const ShippedElbow elbow;
  EXPECT_THROW(experimentOn(elbow, {"hand.mass"}, {1.5}), std::invalid_argument);
  EXPECT_THROW(experimentOn(elbow, {"hand.mass"}, {0.5, 0.5}), std::invalid_argument);
  EXPECT_THROW(TrialPredictor(elbow.catalogue, ShippedElbow::options(), elbow.excitation, "pro_sup",
                              {0.1}, {}, forSeconds(1)),
               std::invalid_argument);
}

}  // namespace
}  // namespace bio
