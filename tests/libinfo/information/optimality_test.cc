#include "info/information/optimality.h"

#include <gtest/gtest.h>

#include <cmath>

#include "info/information/symmetric_eigen.h"

namespace {

using Eigen::MatrixXd;
using info::criterion;
using info::Optimality;

// A symmetric matrix with the eigenvalues given, in a frame of no special direction.
MatrixXd withEigenvalues(const Eigen::VectorXd& lambda) {
  MatrixXd a(3, 3);
  a << 1, 2, -1, 0.5, -1, 3, 2, 1, 1;
  const MatrixXd q = Eigen::HouseholderQR<MatrixXd>(a).householderQ();
  const MatrixXd matrix = q * lambda.asDiagonal() * q.transpose();
  return 0.5 * (matrix + matrix.transpose());
}
const MatrixXd kDistinct = withEigenvalues(Eigen::Vector3d(0.5, 2, 7));
const MatrixXd kMove =
    (Eigen::Matrix3d() << 0.3, -0.2, 0.5, -0.2, 0.4, 0.1, 0.5, 0.1, -0.6).finished();

TEST(Optimality, HasTheValuesOfItsDefinition) {
  EXPECT_NEAR(criterion(Optimality::a, kDistinct).value, 1 / 0.5 + 1.0 / 2 + 1.0 / 7, 1e-13);
  EXPECT_NEAR(criterion(Optimality::d, kDistinct).value, std::log(7.0), 1e-13);
  EXPECT_NEAR(criterion(Optimality::e, kDistinct).value, 0.5, 1e-13);
  EXPECT_NEAR(criterion(Optimality::conditionNumber, kDistinct).value, 14, 1e-11);
}

TEST(Optimality, GradientAgreesWithFiniteDifferences) {
  const double h = 1e-5;
  for (Optimality which :
       {Optimality::a, Optimality::d, Optimality::e, Optimality::conditionNumber}) {
    const double difference = (criterion(which, kDistinct + h * kMove).value -
                               criterion(which, kDistinct - h * kMove).value) /
                              (2 * h);
    const auto at = criterion(which, kDistinct);
    EXPECT_NEAR(at.dvalue_dI.cwiseProduct(kMove).sum(), difference,
                1e-7 * std::abs(difference) + 1e-8);
    EXPECT_EQ(at.multiplicity, 1);
  }
}

// Where two least eigenvalues meet, the square of one eigenvector is no ascent direction; VVᵀ/2 is,
// and it is the shortest element: any other mixture of the two is longer.
TEST(Optimality, ClimbsFromARepeatedLeastEigenvalue) {
  const MatrixXd repeated = withEigenvalues(Eigen::Vector3d(1, 1, 6));
  const auto at = criterion(Optimality::e, repeated);
  EXPECT_EQ(at.multiplicity, 2);
  const double t = 1e-3;
  EXPECT_NEAR(criterion(Optimality::e, repeated + t * at.dvalue_dI).value, 1 + t / 2, 1e-12);
  const auto eigen = info::symmetricEigen(repeated);
  const MatrixXd single = eigen.vectors.col(0) * eigen.vectors.col(0).transpose();
  EXPECT_NEAR(criterion(Optimality::e, repeated + t * single).value, 1, 1e-12);
  EXPECT_NEAR(at.dvalue_dI.norm(), std::sqrt(0.5), 1e-12);
  EXPECT_LT(at.dvalue_dI.norm(), single.norm());
}

TEST(Optimality, DescendsInConditionFromRepeatedExtremes) {
  for (const Eigen::Vector3d& lambda : {Eigen::Vector3d(1, 1, 6), Eigen::Vector3d(1, 6, 6)}) {
    const MatrixXd repeated = withEigenvalues(lambda);
    const auto at = criterion(Optimality::conditionNumber, repeated);
    const double t = 1e-4;
    const double fall =
        criterion(Optimality::conditionNumber, repeated - t * at.dvalue_dI).value - at.value;
    // as steep as the generalised gradient's least element promises
    EXPECT_NEAR(fall, -t * at.dvalue_dI.squaredNorm(), 0.01 * t * at.dvalue_dI.squaredNorm());
  }
  // κ = 1 cannot improve
  EXPECT_LT(criterion(Optimality::conditionNumber, MatrixXd(3 * MatrixXd::Identity(3, 3)))
                .dvalue_dI.norm(),
            1e-15);
}

TEST(Optimality, RefusesWhatIsNoInformationMatrix) {
  EXPECT_THROW(criterion(Optimality::d, withEigenvalues(Eigen::Vector3d(0, 1, 2)) -
                                            1e-9 * MatrixXd::Identity(3, 3)),
               std::domain_error);
  EXPECT_THROW(criterion(Optimality::e, MatrixXd::Constant(2, 2, std::nan(""))), std::domain_error);
  EXPECT_THROW(criterion(Optimality::e, MatrixXd::Ones(1, 2)), std::invalid_argument);
  EXPECT_THROW(criterion(Optimality::e, MatrixXd((Eigen::Matrix2d() << 1, 2, 0, 1).finished())),
               std::invalid_argument);
}

}  // namespace
