#include "info/information/output_covariance.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "info/information/symmetric_eigen.h"

namespace info {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd inverseLower(const MatrixXd& sigma) {
  const Eigen::LLT<MatrixXd> factor(sigma);
  return factor.matrixL().solve(MatrixXd::Identity(sigma.rows(), sigma.cols()));
}

void check(const MatrixXd& sigma) {
  if (sigma.rows() == 0 || sigma.rows() != sigma.cols())
    throw std::invalid_argument(
        fmt::format("output covariance: {} × {}, must be square", sigma.rows(), sigma.cols()));
  if (!sigma.allFinite()) throw std::domain_error("output covariance: every entry must be finite");
  if (!((sigma - sigma.transpose()).cwiseAbs().maxCoeff() <= 1e-12 * sigma.cwiseAbs().maxCoeff()))
    throw std::domain_error("output covariance: must be symmetric");
  // relative to the scales of the outputs, so that outputs of different units are treated alike
  const Eigen::VectorXd sd = sigma.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (Index i = 0; i < sd.size(); ++i)
    if (!(sd[i] > 0))
      throw std::domain_error(
          fmt::format("output covariance: variance of output {} is {}, "
                      "must be > 0 (positive definite)",
                      i, sigma(i, i)));
  const MatrixXd correlation =
      sd.cwiseInverse().asDiagonal() * sigma * sd.cwiseInverse().asDiagonal();
  const double smallest = symmetricEigenvalues(correlation)[0];
  if (!(smallest > 1e-14))
    throw std::domain_error(
        fmt::format("output covariance: not positive definite, the "
                    "smallest eigenvalue of its correlation is {:.3g}, must be > 0",
                    smallest));
}

}  // namespace

ObservationMask observedWhereNotNaN(const MatrixXd& outputs) {
  return outputs.array().isNaN() == false;
}

OutputCovariance::OutputCovariance(const MatrixXd& sigma) : sigma_(sigma) {
  check(sigma_);
  inverseRoot_ = inverseLower(sigma_);
}

MatrixXd OutputCovariance::whiten(const MatrixXd& stacked, const ObservationMask& observed) const {
  const Index h = outputs();
  const Index n = stacked.rows() / h;
  if (n * h != stacked.rows())
    throw std::invalid_argument(
        fmt::format("{} stacked rows, must be a multiple of {} outputs", stacked.rows(), h));
  if (observed.size() != 0 && (observed.rows() != h || observed.cols() != n))
    throw std::invalid_argument(fmt::format("observed is {} × {}, must be {} outputs × {} samples",
                                            observed.rows(), observed.cols(), h, n));
  // all there: in memory a stacked matrix is h × (samples·columns)
  MatrixXd white(stacked.rows(), stacked.cols());
  if (observed.size() == 0) {
    Eigen::Map<MatrixXd>(white.data(), h, n * stacked.cols()).noalias() =
        inverseRoot_ * Eigen::Map<const MatrixXd>(stacked.data(), h, n * stacked.cols());
    return white;
  }
  for (Index k = 0; k < n; ++k) {
    const auto rows = stacked.middleRows(k * h, h);
    if (observed.col(k).all()) {
      white.middleRows(k * h, h).noalias() = inverseRoot_ * rows;
      continue;
    }
    // the marginal covariance of what was observed
    std::vector<Index> there;
    for (Index i = 0; i < h; ++i)
      if (observed(i, k)) there.push_back(i);
    white.middleRows(k * h, h).setZero();
    if (there.empty()) continue;
    white.middleRows(k * h, static_cast<Index>(there.size())) =
        inverseLower(sigma_(there, there)) * rows(there, Eigen::all);
  }
  return white;
}

}  // namespace info
