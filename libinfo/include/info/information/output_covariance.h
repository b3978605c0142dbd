#pragma once

#include <Eigen/Dense>
#include <vector>

namespace info {

/// Mask of measured values: outputs × samples, true for a measured value. Empty: all.
using ObservationMask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// The mask of data in which NaN marks a missing value.
ObservationMask observedWhereNotNaN(const Eigen::MatrixXd& outputs);

/// Covariance Σ_k of the noise on the outputs of sample k [(output unit)²], the same for all
/// samples or one for each; the noise of different samples is independent.
///
/// Stacked quantities hold sample k in rows k·h … k·h+h−1, h the number of outputs.
///
/// @throws std::invalid_argument if a Σ_k is not square, or differs in size from the others
/// @throws std::domain_error if a Σ_k is not symmetric or not positive definite (NaN included)
class OutputCovariance {
 public:
  /// A constant Σ for all samples.
  explicit OutputCovariance(const Eigen::MatrixXd& sigma);
  /// A Σ_k for each sample.
  static OutputCovariance perSample(std::vector<Eigen::MatrixXd> sigma_k);

  Eigen::Index outputs() const { return sigma_.front().rows(); }
  bool isConstant() const { return constant_; }
  /// Number of samples that it is given for; 0 if constant, for any number of samples.
  Eigen::Index samples() const;
  /// Σ_k
  const Eigen::MatrixXd& at(Eigen::Index sample) const;

  /// A_k ↦ L_k⁻¹A_k with Σ_k = L_kL_kᵀ for each sample of a stacked matrix, so that AᵀΣ⁻¹B becomes
  /// a plain product. Only the part of Σ_k of the observed outputs is used; the remaining rows are
  /// 0.
  /// @throws std::invalid_argument if the shapes do not fit
  Eigen::MatrixXd whiten(const Eigen::MatrixXd& stacked,
                         const ObservationMask& observed = {}) const;

 private:
  struct PerSample {};
  OutputCovariance(PerSample, std::vector<Eigen::MatrixXd> sigma_k);

  std::vector<Eigen::MatrixXd> sigma_;
  std::vector<Eigen::MatrixXd> inverseRoot_;  // L_k⁻¹
  bool constant_ = false;
};

}  // namespace info
