#pragma once

#include <array>
#include <vector>

#include "bio/forces/expression.h"
#include "bio/model/model.h"
#include "bio/skeleton/skeleton.h"

namespace bio {

/// A passive generalised force on one free coordinate, with derivatives.
struct CoordinateForceValue {
  double force = 0;         ///< τ [N m] or [N], positive along the coordinate
  double dForce_dq = 0;     ///< ∂τ/∂q
  double dForce_dqDot = 0;  ///< ∂τ/∂q̇
};

/// Limit springs and dampers as OpenSim's CoordinateLimitForce defines them: with the quintic step
/// s(x) = x³(10 − 15x + 6x²) over the transition δ beyond a limit,
///     τ = −K_u s_u (q − q_u) + K_l s_l (q_l − q) − B (s_u + s_l) q̇
/// C² in q.
CoordinateForceValue evaluate(const CoordinateLimitForce& law, double q, double qDot);

/// τ = −k (q − q_0) − b q̇
CoordinateForceValue evaluate(const SpringGeneralizedForce& law, double q, double qDot);

/// ∂τ/∂θ with respect to the force's parameters, in this order: upper limit and stiffness, lower
/// limit and stiffness, damping, transition; stiffness, rest length, viscosity.
std::array<double, 6> parameterDerivatives(const CoordinateLimitForce& law, double q, double qDot);
std::array<double, 3> parameterDerivatives(const SpringGeneralizedForce& law, double q,
                                           double qDot);

/// A compiled formula with constants: τ(q, q̇; c).
class CoordinateExpression {
 public:
  /// @throws std::invalid_argument syntax error, unknown name, more than maxConstants constants
  explicit CoordinateExpression(const ExpressionBasedCoordinateForce& law);

  static constexpr std::size_t maxConstants = 6;

  CoordinateForceValue evaluate(double q, double qDot) const;
  /// Whether τ is 0 everywhere, e.g. because its amplitude is 0.
  bool vanishes() const;
  /// ∂τ/∂c of one of the constants.
  double parameterDerivative(std::size_t constant, double q, double qDot) const;

 private:
  Expression expression_;
  std::vector<double> constants_;
};

/// The formula with its constants replaced by their values, to 17 digits, as written to a file.
/// @throws std::invalid_argument a constant that is not finite
std::string plainExpression(const ExpressionBasedCoordinateForce& law);

/// All passive coordinate forces of a model that act on the free coordinates of a skeleton.
class CoordinateForces {
 public:
  /// @throws std::invalid_argument unknown coordinate, or an expression that cannot be read
  CoordinateForces(const Model& model, const Skeleton& skeleton);

  /// Adds forces and derivatives: tau += τ, tau_q += ∂τ/∂q, tau_qDot += ∂τ/∂q̇.
  template <int N>
  void add(const Eigen::Matrix<double, N, 1>& q, const Eigen::Matrix<double, N, 1>& qDot,
           Eigen::Matrix<double, N, 1>& tau, Eigen::Matrix<double, N, N>& tau_q,
           Eigen::Matrix<double, N, N>& tau_qDot) const {
    for (const Acting& acting : acting_) {
      if (acting.vanishes) continue;
      const CoordinateForceValue value = evaluateLaw(acting, q[acting.index], qDot[acting.index]);
      tau[acting.index] += value.force;
      tau_q(acting.index, acting.index) += value.dForce_dq;
      tau_qDot(acting.index, acting.index) += value.dForce_dqDot;
    }
  }

  bool empty() const { return acting_.empty(); }
  std::vector<std::string> names() const;

 private:
  struct Acting {
    int index = 0;
    std::variant<CoordinateLimitForce, SpringGeneralizedForce, CoordinateExpression> law;
    std::string name;
    bool vanishes = false;
  };
  static CoordinateForceValue evaluateLaw(const Acting& acting, double q, double qDot);

  std::vector<Acting> acting_;
};

}  // namespace bio
