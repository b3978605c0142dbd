#include "info/information/output_covariance.h"

#include <gmock/gmock.h>

#include <limits>

namespace {

using Eigen::MatrixXd;
using info::OutputCovariance;
using testing::HasSubstr;
using testing::ThrowsMessage;

const MatrixXd kSigma = (Eigen::Matrix2d() << 4, 1, 1, 2).finished();

TEST(OutputCovariance, WhitensSoThatProductsCarryItsInverse) {
  const MatrixXd a = MatrixXd::Random(6, 3);
  const MatrixXd white = OutputCovariance(kSigma).whiten(a);
  MatrixXd expected = MatrixXd::Zero(3, 3);
  for (int k = 0; k < 3; ++k)
    expected += a.middleRows(2 * k, 2).transpose() * kSigma.inverse() * a.middleRows(2 * k, 2);
  EXPECT_LT((white.transpose() * white - expected).norm(), 1e-13 * expected.norm());
}

// An output that was not measured leaves the marginal variance of the other: 1/4, not (Σ⁻¹)_00 =
// 2/7.
TEST(OutputCovariance, UsesTheMarginalWhereAnOutputIsMissing) {
  info::ObservationMask observed(2, 2);
  observed << true, false, false, false;
  const MatrixXd white = OutputCovariance(kSigma).whiten(MatrixXd::Constant(4, 1, 3.0), observed);
  EXPECT_DOUBLE_EQ(white.squaredNorm(), 9.0 / 4);
}

TEST(OutputCovariance, ReadsGapsFromNaNOnlyWhenAsked) {
  MatrixXd data(1, 3);
  data << 1, std::numeric_limits<double>::quiet_NaN(), 3;
  const info::ObservationMask observed = info::observedWhereNotNaN(data);
  EXPECT_TRUE(observed(0, 0));
  EXPECT_FALSE(observed(0, 1));
  EXPECT_TRUE(observed(0, 2));
}

TEST(OutputCovariance, RefusesWhatIsNoCovariance) {
  const auto make = [](const MatrixXd& sigma) { return [sigma] { OutputCovariance{sigma}; }; };
  MatrixXd bad = kSigma;
  bad(0, 1) = bad(1, 0) = 3;
  EXPECT_THAT(make(bad), ThrowsMessage<std::domain_error>(HasSubstr("not positive definite")));
  bad(0, 1) = 0;
  EXPECT_THAT(make(bad), ThrowsMessage<std::domain_error>(HasSubstr("symmetric")));
  bad(0, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(make(bad), ThrowsMessage<std::domain_error>(HasSubstr("finite")));
  bad = kSigma;
  bad(1, 1) = 0;
  EXPECT_THAT(make(bad), ThrowsMessage<std::domain_error>(HasSubstr("output 1")));
  EXPECT_THROW(OutputCovariance(MatrixXd::Identity(2, 3)), std::invalid_argument);
  EXPECT_THROW(OutputCovariance(kSigma).whiten(MatrixXd::Ones(3, 1)), std::invalid_argument);
}

}  // namespace
