#include "info/information/optimality.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "info/information/symmetric_eigen.h"

namespace info {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

SymmetricEigen decompose(const MatrixXd& information) {
  if (information.rows() == 0 || information.rows() != information.cols())
    throw std::invalid_argument("information matrix must be square");
  if (!information.allFinite())
    throw std::domain_error("every entry of the information matrix must be finite");
  if (!((information - information.transpose()).cwiseAbs().maxCoeff() <=
        1e-9 * information.cwiseAbs().maxCoeff()))
    throw std::invalid_argument("information matrix must be symmetric");
  return symmetricEigen(information);
}

}  // namespace

Criterion criterion(Optimality which, const MatrixXd& information, double repeatedTolerance) {
  const auto eigen = decompose(information);
  const VectorXd& lambda = eigen.values;
  const MatrixXd& vectors = eigen.vectors;
  const double least = lambda[0], largest = lambda[lambda.size() - 1];
  if (which != Optimality::e && !(least > 0))
    throw std::domain_error(fmt::format(
        "information matrix must be positive definite, its least eigenvalue is {}", least));

  // projectors on the eigenspaces of the extreme eigenvalues, trace 1
  const double gap = repeatedTolerance * std::abs(largest);
  const Index r = (lambda.array() <= least + gap).count();
  const Index s = (lambda.array() >= largest - gap).count();
  const MatrixXd low =
      vectors.leftCols(r) * vectors.leftCols(r).transpose() / static_cast<double>(r);
  const MatrixXd high =
      vectors.rightCols(s) * vectors.rightCols(s).transpose() / static_cast<double>(s);
  const auto power = [&](int n) {
    return MatrixXd(vectors * lambda.array().pow(n).matrix().asDiagonal() * vectors.transpose());
  };
  switch (which) {
    case Optimality::a:
      return {lambda.cwiseInverse().sum(), -power(-2), 1};
    case Optimality::d:
      return {lambda.array().log().sum(), power(-1), 1};
    case Optimality::e:
      return {least, low, r};
    case Optimality::conditionNumber:
      return {largest / least, (high - largest / least * low) / least, r};
  }
  throw std::invalid_argument("unknown optimality criterion");
}

}  // namespace info
