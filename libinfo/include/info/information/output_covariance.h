#pragma once

#include <Eigen/Dense>
#include <vector>

namespace info {

/// Mask of measured values: outputs × samples, true for a measured value. Empty: all.
using ObservationMask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// The mask of data in which NaN marks a missing value.
ObservationMask observedWhereNotNaN(const Eigen::MatrixXd& outputs);

/// Covariance Σ of the noise on the outputs of a sample [(output unit)²], the same for all samples;
/// the noise of different samples is independent.
///
/// Stacked quantities hold sample k in rows k·h … k·h+h−1, h the number of outputs.
class OutputCovariance {
 public:
  /// @throws std::invalid_argument if Σ is not square
  /// @throws std::domain_error if Σ is not symmetric or not positive definite (NaN included)
  explicit OutputCovariance(const Eigen::MatrixXd& sigma);

  Eigen::Index outputs() const { return sigma_.rows(); }
  const Eigen::MatrixXd& sigma() const { return sigma_; }

  /// A_k ↦ L⁻¹A_k with Σ = LLᵀ for each sample of a stacked matrix, so that AᵀΣ⁻¹B becomes a plain
  /// product. Only the part of Σ of the observed outputs is used; the remaining rows are 0.
  /// @throws std::invalid_argument if the shapes do not fit
  Eigen::MatrixXd whiten(const Eigen::MatrixXd& stacked,
                         const ObservationMask& observed = {}) const;

 private:
  Eigen::MatrixXd sigma_;
  Eigen::MatrixXd inverseRoot_;  // L⁻¹
};

}  // namespace info
