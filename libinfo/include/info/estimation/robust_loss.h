#pragma once

#include <Eigen/Dense>

namespace info {

/// Cost ½ρ(s) of a residual as a function of its squared norm s = zᵀz in standard deviations.
///
///     gaussian   ρ = s
///     huber      ρ = s for s ≤ k², else 2k√s − k²          bounded influence; C¹
///     student    ρ = (ν + h)·ln(1 + s/ν)                   redescending influence; smooth
///
/// z is whitened, z = L⁻¹(ỹ − y) with Σ = LLᵀ, and h its length. Huber's loss with k = 1.345 loses
/// 5 % of efficiency for normal noise. Student's loss is the negative log likelihood of the t
/// distribution with ν degrees of freedom and scale Σ. Sources: Huber, Robust Statistics 1981, ch.
/// 3; Lange, Little & Taylor 1989.
struct RobustLoss {
  enum class Kind { gaussian, huber, student };
  Kind kind = Kind::gaussian;
  double threshold = 1.345;     ///< k [1] > 0, for huber
  double degreesOfFreedom = 4;  ///< ν [1] > 0, for student
};

struct LossValue {
  double value;  ///< ρ(s)
  double slope;  ///< ρ′(s): the weight of the residual, 1 if it is small (student: (ν+h)/ν)
  double curvature;  ///< ρ″(s)
};

/// @param squared s ≥ 0; @param outputs h ≥ 1
/// @throws std::invalid_argument if k or ν is not > 0
LossValue evaluate(const RobustLoss& loss, double squared, Eigen::Index outputs = 1);

/// Factor of the covariance of estimates with this loss,
///     κ = mean(ψ²)/mean(ψ′)²,      ψ(z) = ρ′(z²)·z
/// relative to (ΣΓᵀΣ⁻¹Γ)⁻¹, from the residuals (Huber 1981, (6.5)). For the gaussian loss mean(z²).
/// @param whitened residuals of one output in standard deviations, at least one
double varianceFactor(const RobustLoss& loss, const Eigen::VectorXd& whitened);

}  // namespace info
