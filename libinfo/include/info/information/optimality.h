#pragma once

#include <Eigen/Dense>

namespace info {

/// Optimality criteria: scalar measures of an information matrix I by which experiments are
/// compared. λ are its eigenvalues; comparisons by all criteria but D depend on the units of the
/// parameters. Wilson's thesis, section 4.1.2 and (4.6).
enum class Optimality {
  a,  ///< tr I⁻¹, the sum of the Cramér–Rao variances: smaller is better
  d,  ///< ln det I, minus twice the log volume of the confidence ellipsoid: larger is better
  e,  ///< λ_min, the information about the worst direction: larger is better
  conditionNumber  ///< κ = λ_max/λ_min: smaller is better
};

/// A criterion and its gradient in the information matrix.
struct Criterion {
  double value;
  Eigen::MatrixXd dvalue_dI;  ///< symmetric; d(value) = ⟨dvalue_dI, dI⟩ = tr(dvalue_dI·dI)
  Eigen::Index multiplicity;  ///< of λ_min for E and κ (1: differentiable there), else 1
};

/// Value and gradient of a criterion.
///     A: −I⁻²    D: I⁻¹    E: VVᵀ/r    κ: UUᵀ/(s·λ_min) − κ·VVᵀ/(r·λ_min)
/// The columns of V are the r unit eigenvectors of λ_min, those of U the s of λ_max.
///
/// λ_min and λ_max are not differentiable at repeated eigenvalues. Eigenvalues within
/// `repeatedTolerance`·λ_max count as equal, and the gradient is then the element of least
/// Frobenius norm of Clarke's generalised gradient {VSVᵀ : S ⪰ 0, tr S = 1}, which is S = 1/r. It
/// is an ascent direction: λ_min(I + t·VVᵀ/r) = λ_min + t/r, whereas along vvᵀ of a single
/// eigenvector v λ_min is constant. This differs from Wilson's thesis (B.1), which takes one
/// eigenvector. The gradient is discontinuous where the multiplicity changes.
///
/// @throws std::domain_error if I is not finite, or not positive definite (E: may be semidefinite)
/// @throws std::invalid_argument if I is not square and symmetric
Criterion criterion(Optimality which, const Eigen::MatrixXd& information,
                    double repeatedTolerance = 1e-9);

}  // namespace info
