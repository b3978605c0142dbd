#include "info/estimation/least_squares.h"

#include <gmock/gmock.h>

#include <cmath>

#include "info/estimation/estimate.h"
#include "support/closed_forms.h"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using info::LeastSquares;
using testing::HasSubstr;
using testing::ThrowsMessage;

const VectorXd kTimes = VectorXd::LinSpaced(40, 0, 4);
const Eigen::Vector2d kTheta(0.4, 3);

// The damped oscillation with data that do not fit it exactly.
LeastSquares problem(std::vector<info::Parameter> parameters = {{.name = "c", .start = 0.4},
                                                                {.name = "w", .start = 3}},
                     info::ObservationMask observed = {}) {
  const auto model = support::DampedOscillation{kTimes}.predictor();
  MatrixXd data = model.outputs(Eigen::Vector2d(0.5, 3.2));
  for (Eigen::Index k = 0; k < data.cols(); ++k) data(0, k) += 0.1 * std::sin(7.0 * double(k));
  return LeastSquares(model,
                      {data, info::OutputCovariance(MatrixXd::Constant(1, 1, 0.04)), observed},
                      std::move(parameters));
}

TEST(LeastSquares, CostIsHalfTheWeightedSquares) {
  const auto p = problem();
  const MatrixXd r = p.measurements().outputs - p.predictor().outputs(kTheta);
  EXPECT_NEAR(p.cost(kTheta), 0.5 * r.squaredNorm() / 0.04, 1e-12);
  EXPECT_DOUBLE_EQ(p.linearise(kTheta).cost, p.cost(kTheta));
}

TEST(LeastSquares, GradientAndHessianAreDerivativesOfTheCost) {
  for (bool withPrior : {false, true}) {
    std::vector<info::Parameter> parameters = {{.name = "c", .start = 0.4},
                                               {.name = "w", .start = 3}};
    if (withPrior) parameters[0].prior = info::GaussianPrior{0.1, 0.05};
    const auto p = problem(parameters);
    const auto at = p.linearise(kTheta);
    const MatrixXd hessian = p.hessian(kTheta, at);
    const double h = 1e-5;
    for (int i = 0; i < 2; ++i) {
      const VectorXd step = h * VectorXd::Unit(2, i);
      EXPECT_NEAR(at.gradient[i], (p.cost(kTheta + step) - p.cost(kTheta - step)) / (2 * h),
                  1e-7 * at.gradient.norm());
      const VectorXd column =
          (p.linearise(kTheta + step).gradient - p.linearise(kTheta - step).gradient) / (2 * h);
      EXPECT_LT((hessian.col(i) - column).norm(), 1e-7 * hessian.norm());
    }
    // the residuals matter here: the Gauss–Newton Hessian is another matrix
    EXPECT_GT((hessian - at.information).norm(), 0.05 * hessian.norm());
  }
}

TEST(LeastSquares, ReadsNoDatumThatWasNotObserved) {
  info::ObservationMask observed = info::ObservationMask::Constant(1, 40, true);
  observed(0, 7) = false;
  const auto p = problem({{.name = "c"}, {.name = "w"}}, observed);
  info::Measurements gap = p.measurements();
  gap.outputs(0, 7) = std::nan("");
  const LeastSquares q(p.predictor(), gap, p.parameters());
  EXPECT_EQ(q.observations(), 39);
  EXPECT_DOUBLE_EQ(p.cost(kTheta), q.cost(kTheta));
  const auto at = q.linearise(kTheta);
  EXPECT_TRUE(q.hessian(kTheta, at).isApprox(p.hessian(kTheta, p.linearise(kTheta)), 1e-14));
}

TEST(LeastSquares, IsInfiniteWhereTheModelIsUndefined) {
  auto p = problem();
  info::Predictor broken = p.predictor();
  broken.outputs = [](const VectorXd&) -> MatrixXd {
    return MatrixXd::Constant(1, 40, std::nan(""));
  };
  EXPECT_TRUE(std::isinf(LeastSquares(broken, p.measurements(), p.parameters()).cost(kTheta)));
}

TEST(LeastSquares, NamesTheDatumThatIsNotANumber) {
  auto p = problem();
  info::Measurements bad = p.measurements();
  bad.outputs(0, 11) = std::nan("");
  EXPECT_THAT([&] { LeastSquares(p.predictor(), bad, p.parameters()); },
              ThrowsMessage<std::domain_error>(HasSubstr("output 0 of sample 11 is nan")));
}

TEST(LeastSquares, RefusesShapesThatDoNotFit) {
  auto p = problem();
  info::Measurements bad = p.measurements();
  bad.outputs = MatrixXd::Zero(2, 40);
  EXPECT_THROW(LeastSquares(p.predictor(), bad, p.parameters()), std::invalid_argument);
  bad = p.measurements();
  bad.outputs = MatrixXd::Zero(1, 39);
  EXPECT_THROW(LeastSquares(p.predictor(), bad, p.parameters()).cost(kTheta),
               std::invalid_argument);
  bad = p.measurements();
  bad.observed = info::ObservationMask::Constant(1, 3, true);
  EXPECT_THROW(LeastSquares(p.predictor(), bad, p.parameters()), std::invalid_argument);
  EXPECT_THROW(LeastSquares({}, p.measurements(), p.parameters()), std::invalid_argument);
  EXPECT_THROW(LeastSquares(p.predictor(), p.measurements(), {}), std::invalid_argument);
  EXPECT_THROW(p.linearise(VectorXd::Zero(3)), std::invalid_argument);
  EXPECT_THROW(p.cost(VectorXd::Zero(1)), std::invalid_argument);
  info::Predictor narrow = p.predictor();
  narrow.withSensitivities = [f = narrow.withSensitivities](const VectorXd& theta) {
    const auto prediction = f(theta);
    return info::Prediction{prediction.outputs, prediction.gamma.leftCols(1)};
  };
  EXPECT_THROW(LeastSquares(narrow, p.measurements(), p.parameters()).linearise(kTheta),
               std::invalid_argument);
  info::Predictor first = p.predictor();
  first.contractedCurvature = nullptr;
  const LeastSquares q(first, p.measurements(), p.parameters());
  EXPECT_THROW(q.hessian(kTheta, q.linearise(kTheta)), std::logic_error);
}

TEST(LeastSquares, WithARobustLossTheGradientIsThatOfTheCost) {
  using Kind = info::RobustLoss::Kind;
  const auto plain = problem();
  for (const info::RobustLoss& loss :
       {info::RobustLoss{Kind::huber, 0.3}, info::RobustLoss{Kind::student, 1, 3}}) {
    info::Measurements measurements = plain.measurements();
    measurements.loss = loss;
    const LeastSquares robust(plain.predictor(), measurements, plain.parameters());
    EXPECT_NE(robust.cost(kTheta), plain.cost(kTheta));
    const auto at = robust.linearise(kTheta);
    EXPECT_DOUBLE_EQ(at.cost, robust.cost(kTheta));
    for (Eigen::Index i = 0; i < 2; ++i) {
      Eigen::Vector2d h = Eigen::Vector2d::Zero();
      h[i] = 1e-6;
      EXPECT_NEAR(at.gradient[i], (robust.cost(kTheta + h) - robust.cost(kTheta - h)) / 2e-6,
                  1e-6 * std::abs(at.gradient[i]) + 1e-7);
    }
    EXPECT_FALSE(robust.hasCurvature());
    EXPECT_THROW(robust.hessian(kTheta, at), std::logic_error);
  }
}

// A line through points of which one in ten is far off.
TEST(LeastSquares, ARobustLossForgetsOutliers) {
  const VectorXd t = VectorXd::LinSpaced(40, 0, 4);
  MatrixXd data = (1 + 2 * t.array() + 0.01 * (9 * t.array()).sin()).matrix().transpose();
  for (Eigen::Index k = 0; k < 40; k += 10) data(0, k) += 5;
  const auto slope = [&](info::RobustLoss loss) {
    const LeastSquares line(
        support::straightLine(t),
        {data, info::OutputCovariance(MatrixXd::Constant(1, 1, 1e-4)), {}, loss},
        {{.name = "a"}, {.name = "b"}});
    return info::estimate(line).parameters[1];
  };
  using Kind = info::RobustLoss::Kind;
  EXPECT_GT(std::abs(slope({Kind::gaussian}) - 2), 0.1);
  EXPECT_NEAR(slope({Kind::huber}), 2, 0.005);
  EXPECT_NEAR(slope({Kind::student}), 2, 0.005);
}

}  // namespace
