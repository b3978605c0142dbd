#include "info/probability/gaussian_copula.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "info/probability/marginal.h"

namespace info {

GaussianCopula::GaussianCopula(const Eigen::MatrixXd& correlation) {
  const Eigen::ArrayXXd apart = (correlation - correlation.transpose()).cwiseAbs();
  if (!(apart <= 1e-8).all()) {
    throw std::invalid_argument(fmt::format(
        "correlation matrix is asymmetric by {:.3g}, must be symmetric", apart.maxCoeff()));
  }
  const Eigen::ArrayXd off = (correlation.diagonal().array() - 1).abs();
  if (!(off <= 1e-8).all()) {
    throw std::invalid_argument(fmt::format(
        "diagonal of the correlation matrix differs by {:.3g} from 1, must be 1", off.maxCoeff()));
  }
  const double least =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlation, Eigen::EigenvaluesOnly)
          .eigenvalues()
          .minCoeff();
  if (!(least >= 1e-10)) {
    throw std::invalid_argument(
        fmt::format("not positive definite: the smallest eigenvalue of the correlations is {:.3g}, "
                    "must be at least 1e-10",
                    least));
  }
  lower_ = correlation.llt().matrixL();
}

Eigen::VectorXd GaussianCopula::shares(const Eigen::VectorXd& independent) const {
  // the ends would be infinite
  static constexpr double end = 0x1p-53;
  const Eigen::VectorXd z = lower_ * independent.unaryExpr([](double u) {
    return standardNormalQuantile(std::clamp(u, end, 1 - end));
  });
  return z.unaryExpr([](double x) { return standardNormalShare(x); });
}

}  // namespace info
