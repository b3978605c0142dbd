#pragma once

#include <Eigen/Dense>

namespace info {

/// Which number stands for an information matrix I when experiments are compared. λ are its
/// eigenvalues, so all but D depend on the units of the parameters. Thesis, section 4.1.2 and
/// (4.6).
enum class Optimality {
  a,  ///< tr I⁻¹, the sum of the bounds' variances: less is better
  d,  ///< ln det I, minus twice the log volume of the confidence ellipsoid: more is better
  e,  ///< λ_min, the information about the worst direction: more is better
  conditionNumber  ///< κ = λ_max/λ_min: less is better
};

/// A criterion and how it follows the information.
struct Criterion {
  double value;
  Eigen::MatrixXd dvalue_dI;  ///< symmetric; d(value) = ⟨dvalue_dI, dI⟩ = tr(dvalue_dI·dI)
  Eigen::Index multiplicity;  ///< of λ_min for E and κ (1: differentiable there), else 1
};

/// Value and gradient of a criterion.
///     A: −I⁻²    D: I⁻¹    E: VVᵀ/r    κ: UUᵀ/(s·λ_min) − κ·VVᵀ/(r·λ_min)
/// V holds the r unit eigenvectors that belong to λ_min, U the s that belong to λ_max.
///
/// λ_min and λ_max are not differentiable where eigenvalues meet. Eigenvalues within
/// `repeatedTolerance`·λ_max count as equal, and the gradient is then the element of least
/// Frobenius norm of Clarke's generalised gradient {VSVᵀ : S ⪰ 0, tr S = 1}, which is S = 1/r. It
/// is an ascent direction: λ_min(I + t·VVᵀ/r) = λ_min + t/r, whereas along the square of one
/// eigenvector λ_min stays. Departs from the thesis (B.1), which takes one eigenvector. The
/// gradient jumps where multiplicity changes; where a smooth function is wanted, use
/// softMinEigenvalue.
///
/// @throws std::domain_error if I is not finite, or not positive definite (E: may be semidefinite)
/// @throws std::invalid_argument if I is not square and symmetric
Criterion criterion(Optimality which, const Eigen::MatrixXd& information,
                    double repeatedTolerance = 1e-9);

/// Smooth stand-in for λ_min with the width μ > 0 [unit of I],
///     s_μ(I) = −μ ln tr exp(−I/μ),   λ_min − μ ln p ≤ s_μ ≤ λ_min
/// C∞ also where eigenvalues meet; gradient exp(−I/μ)/tr exp(−I/μ), positive definite with trace 1.
/// @throws as criterion, and std::invalid_argument unless width > 0
Criterion softMinEigenvalue(const Eigen::MatrixXd& information, double width);

}  // namespace info
