#include "info/information/output_covariance.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "info/information/symmetric_eigen.h"

namespace info {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd inverseLower(const MatrixXd& sigma) {
  const Eigen::LLT<MatrixXd> factor(sigma);
  return factor.matrixL().solve(MatrixXd::Identity(sigma.rows(), sigma.cols()));
}

void check(const MatrixXd& sigma, std::size_t sample) {
  if (sigma.rows() == 0 || sigma.rows() != sigma.cols())
    throw std::invalid_argument(
        fmt::format("output covariance of sample {}: {} × {}, must be square", sample, sigma.rows(),
                    sigma.cols()));
  if (!sigma.allFinite())
    throw std::domain_error(
        fmt::format("output covariance of sample {}: every entry must be finite", sample));
  if (!((sigma - sigma.transpose()).cwiseAbs().maxCoeff() <= 1e-12 * sigma.cwiseAbs().maxCoeff()))
    throw std::domain_error(
        fmt::format("output covariance of sample {}: must be symmetric", sample));
  // relative to the scales of the outputs, so that outputs of different units are treated alike
  const Eigen::VectorXd sd = sigma.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (Index i = 0; i < sd.size(); ++i)
    if (!(sd[i] > 0))
      throw std::domain_error(
          fmt::format("output covariance of sample {}: variance of output {} is {}, "
                      "must be > 0 (positive definite)",
                      sample, i, sigma(i, i)));
  const MatrixXd correlation =
      sd.cwiseInverse().asDiagonal() * sigma * sd.cwiseInverse().asDiagonal();
  const double smallest = symmetricEigenvalues(correlation)[0];
  if (!(smallest > 1e-14))
    throw std::domain_error(
        fmt::format("output covariance of sample {}: not positive definite, the "
                    "smallest eigenvalue of its correlation is {:.3g}, must be > 0",
                    sample, smallest));
}

}  // namespace

ObservationMask observedWhereNotNaN(const MatrixXd& outputs) {
  return outputs.array().isNaN() == false;
}

OutputCovariance::OutputCovariance(const MatrixXd& sigma) : OutputCovariance(PerSample{}, {sigma}) {
  constant_ = true;
}

OutputCovariance OutputCovariance::perSample(std::vector<MatrixXd> sigma_k) {
  return {PerSample{}, std::move(sigma_k)};
}

OutputCovariance::OutputCovariance(PerSample, std::vector<MatrixXd> sigma_k)
    : sigma_(std::move(sigma_k)) {
  if (sigma_.empty()) throw std::invalid_argument("output covariance: must have at least one");
  for (std::size_t k = 0; k < sigma_.size(); ++k) {
    check(sigma_[k], k);
    if (sigma_[k].rows() != sigma_[0].rows())
      throw std::invalid_argument(
          fmt::format("output covariance of sample {} has {} outputs, must be {} as in sample 0", k,
                      sigma_[k].rows(), sigma_[0].rows()));
    inverseRoot_.push_back(inverseLower(sigma_[k]));
  }
}

Index OutputCovariance::samples() const {
  return isConstant() ? 0 : static_cast<Index>(sigma_.size());
}

const MatrixXd& OutputCovariance::at(Index sample) const {
  return isConstant() ? sigma_.front() : sigma_.at(static_cast<std::size_t>(sample));
}

MatrixXd OutputCovariance::whiten(const MatrixXd& stacked, const ObservationMask& observed) const {
  const Index h = outputs();
  const Index n = stacked.rows() / h;
  if (n * h != stacked.rows())
    throw std::invalid_argument(
        fmt::format("{} stacked rows, must be a multiple of {} outputs", stacked.rows(), h));
  if (!isConstant() && samples() != n)
    throw std::invalid_argument(
        fmt::format("output covariance is given for {} samples, must be {}", samples(), n));
  if (observed.size() != 0 && (observed.rows() != h || observed.cols() != n))
    throw std::invalid_argument(fmt::format("observed is {} × {}, must be {} outputs × {} samples",
                                            observed.rows(), observed.cols(), h, n));
  // all there and one Σ: in memory a stacked matrix is h × (samples·columns)
  MatrixXd white(stacked.rows(), stacked.cols());
  if (observed.size() == 0 && isConstant()) {
    Eigen::Map<MatrixXd>(white.data(), h, n * stacked.cols()).noalias() =
        inverseRoot_.front() * Eigen::Map<const MatrixXd>(stacked.data(), h, n * stacked.cols());
    return white;
  }
  for (Index k = 0; k < n; ++k) {
    const auto rows = stacked.middleRows(k * h, h);
    if (observed.size() == 0 || observed.col(k).all()) {
      const auto& root = inverseRoot_[isConstant() ? 0 : static_cast<std::size_t>(k)];
      white.middleRows(k * h, h).noalias() = root * rows;
      continue;
    }
    // the marginal covariance of what was observed
    std::vector<Index> there;
    for (Index i = 0; i < h; ++i)
      if (observed(i, k)) there.push_back(i);
    white.middleRows(k * h, h).setZero();
    if (there.empty()) continue;
    white.middleRows(k * h, static_cast<Index>(there.size())) =
        inverseLower(at(k)(there, there)) * rows(there, Eigen::all);
  }
  return white;
}

}  // namespace info
