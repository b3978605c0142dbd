#pragma once

#include <cmath>

#include "info/dynamics/discrete_lagrangian.h"

namespace info {

/// The midpoint variational integrator: (q_k, p_k) ↦ (q_{k+1}, p_{k+1}) for any Lagrangian, with
/// forcing and kinematic coordinates, and its exact first and second derivatives.
///
///     0 = p_k + D₁L_d + F⁻,   p_{k+1} = D₂L_d + F⁺                          (2.22)
///     L_d = Δt L(q_m, v, ρ_m, w, θ),   q_m = (q_k + q_{k+1})/2,   v = (q_{k+1} − q_k)/Δt,
///     and ρ_m, w likewise from ρ_k, ρ_{k+1}
/// Source: Wilson, Information-based Trajectory Optimization, section 2.4. Differences: the factor
/// Δt, which is missing in the printed (2.23); symmetric forcing as the default beside the
/// left-endpoint forcing of the thesis; and the terms of ∂M/∂z in the second derivatives that
/// Appendix B.2.1 omits (docs/theory/variational.md).
///
/// As a step map: state (q, p), input (u, ρ), u_k held over the step, ρ at both ends. L and f are
/// recorded in the constructor and differentiated symbolically, so they must not branch on their
/// arguments; a system that branches is written as an implicit step map instead (system.h). With
/// fixed sizes a step allocates no memory after the first one of a thread. Immutable; usable from
/// several threads.
template <LagrangianSystem S>
class VariationalIntegrator {
 public:
  static constexpr int stateSize = addSizes(S::coordinateSize, S::coordinateSize);
  static constexpr int inputSize = addSizes(S::forceInputSize, S::kinematicSize);
  static constexpr int parameterSize = S::parameterSize;
  static constexpr int outputSize = S::measurementSize;
  /// Length of z = (q_k, p_k, u_k, ρ_k, ρ_{k+1}, θ).
  static constexpr int zSize =
      addSizes(addSizes(stateSize, inputSize), addSizes(S::kinematicSize, parameterSize));

  using Coordinates = CoordinatesOf<S>;
  using Kinematic = KinematicOf<S>;
  using ForceInput = ForceInputOf<S>;
  using Parameters = ParametersOf<S>;
  using State = Vector<double, stateSize>;
  using Input = Vector<double, inputSize>;
  using Jacobian = Matrix<double, stateSize, zSize>;
  using Hessian = Matrix<double, zSize, zSize>;

  struct Arguments {
    Coordinates q, p;  ///< q_k and p_k
    ForceInput u;      ///< u_k
    Kinematic rho0;    ///< ρ_k
    Kinematic rho1;    ///< ρ_{k+1}
    Parameters theta;
  };
  struct Result {
    Coordinates q1, p1;         ///< q_{k+1}, p_{k+1}
    bool converged = false;     ///< false: q1 is the last iterate and p1 is meaningless
    int iterations = 0;         ///< Newton iterations
    double residualNorm = 0.0;  ///< largest |p_k + D₁L_d + F⁻| at the last evaluation
  };

  /// @param timeStep Δt [s] > 0
  /// @throws std::domain_error unless Δt > 0 and finite
  explicit VariationalIntegrator(S system, double timeStep, Forcing forcing = Forcing::symmetric,
                                 NewtonOptions options = {})
      : system_(std::move(system)),
        timeStep_(checkedTimeStep(timeStep)),
        options_(options),
        d_(mechanicalDimensionsOf(system_)),
        formulas_(system_, timeStep, forcing) {}

  const S& system() const { return system_; }
  double timeStep() const { return timeStep_; }
  Dimensions dimensions() const {
    return {2 * d_.coordinate, d_.force + d_.kinematic, d_.parameter, d_.output};
  }
  std::vector<std::string> parameterNames() const { return system_.parameterNames(); }

  /// One step by Newton's method from the initial value `guess` of q_{k+1}, for instance an
  /// extrapolation.
  /// @throws DimensionError if a run-time size is wrong
  Result step(const Arguments& z, const Coordinates& guess) const;
  Result step(const Arguments& z) const { return step(z, z.q); }

  /// ∂(q_{k+1}, p_{k+1})/∂z at a completed step, by the implicit function theorem.
  Jacobian firstDerivatives(const Arguments& z, const Result& taken) const;

  struct SecondDerivatives {
    Jacobian first;
    MatrixStack<stateSize, Hessian> second;  ///< ∂²/∂z² of each component of (q_{k+1}, p_{k+1})
  };
  /// First and second derivatives at a completed step.
  SecondDerivatives secondDerivatives(const Arguments& z, const Result& taken) const;

  /// Σ_i w_i ∂²(q_{k+1}, p_{k+1})_i/∂z² at a completed step: one Hessian instead of 2n.
  Hessian contractedSecondDerivatives(const Arguments& z, const Result& taken,
                                      const State& w) const;

  // --- as a step map, see step_map.h

  Arguments argumentsOf(const State& x, const Input& u0, const Input& u1,
                        const Parameters& theta) const {
    constexpr int nr = S::kinematicSize;
    return {x.template head<n>(d_.coordinate),
            x.template segment<n>(d_.coordinate, d_.coordinate),
            u0.template head<S::forceInputSize>(d_.force),
            u0.template segment<nr>(d_.force, d_.kinematic),
            u1.template segment<nr>(d_.force, d_.kinematic),
            theta};
  }
  Step<stateSize> solve(const State& x, const Input& u0, const Input& u1,
                        const Parameters& theta) const {
    return stepOf(step(argumentsOf(x, u0, u1, theta)));
  }
  StepLinearisation<stateSize, inputSize, parameterSize> linearise(const State& x, const Input& u0,
                                                                   const Input& u1,
                                                                   const Parameters& theta) const;
  Matrix<double, argumentSize<VariationalIntegrator>, argumentSize<VariationalIntegrator>>
  contractedHessian(const State& x, const Input& u0, const Input& u1, const Parameters& theta,
                    const State& w) const;
  template <class T>
  Vector<T, outputSize> g(const Vector<T, stateSize>& x, const Vector<T, inputSize>& u,
                          const Vector<T, parameterSize>& theta) const {
    return system_.measure(
        CoordinatesOf<S, T>(x.template head<n>(d_.coordinate)),
        KinematicOf<S, T>(u.template segment<S::kinematicSize>(d_.force, d_.kinematic)), theta);
  }

 private:
  static constexpr int n = S::coordinateSize;
  using Formulas = DiscreteLagrangian<S>;
  using Square = Matrix<double, n, n>;
  using Slope = Matrix<double, n, zSize>;

  static double checkedTimeStep(double timeStep) {
    if (!(timeStep > 0.0) || !std::isfinite(timeStep))
      throw std::domain_error("time step: must be > 0 s and finite, value is " +
                              std::to_string(timeStep) + " s");
    return timeStep;
  }
  static Square inverse(const Square& M) {
    if constexpr (n != dynamic && n <= 4)
      return M.inverse();
    else
      return M.partialPivLu().inverse();
  }
  int zLength() const { return 2 * d_.coordinate + d_.force + 2 * d_.kinematic + d_.parameter; }
  typename Formulas::Sigma sigma(const Arguments& z, const Coordinates& q1) const {
    typename Formulas::Sigma s(formulas_.sigmaLength());
    s << 0.5 * (z.q + q1), (q1 - z.q) / timeStep_, 0.5 * (z.rho0 + z.rho1),
        (z.rho1 - z.rho0) / timeStep_, z.u, z.theta;
    return s;
  }
  /// (∂σ/∂q_{k+1})ᵀ G
  template <class G>
  Matrix<double, n, G::ColsAtCompileTime> alongUnknown(const G& g) const {
    const int k = d_.coordinate;
    return 0.5 * g.template topRows<n>(k) + g.template middleRows<n>(k, k) / timeStep_;
  }
  /// (∂σ/∂z at fixed q_{k+1})ᵀ G
  template <class G>
  Matrix<double, zSize, G::ColsAtCompileTime> alongKnown(const G& g) const;

  struct Chain {
    Square inverseM;  ///< M⁻¹
    Square dp_dq1;    ///< ∂p̂/∂q_{k+1}
    Slope dq1_dz;     ///< Y = ∂q_{k+1}/∂z
    Slope dp1_dz;
  };
  Chain chain(const typename Formulas::Slopes& slopes) const;
  /// Wᵀ H W with W = ∂σ/∂z in total, q_{k+1} following z.
  Hessian sandwich(const typename Formulas::Hessian& H, const Slope& dq1_dz) const;
  static Step<stateSize> stepOf(const Result& r) {
    State x1(r.q1.size() + r.p1.size());
    x1 << r.q1, r.p1;
    return {x1, r.converged, r.iterations, r.residualNorm};
  }

  S system_;
  double timeStep_;
  NewtonOptions options_;
  MechanicalDimensions d_;
  Formulas formulas_;
};

template <LagrangianSystem S>
auto VariationalIntegrator<S>::step(const Arguments& z, const Coordinates& guess) const -> Result {
  if constexpr (zSize == dynamic) {
    requireLength("coordinates q", z.q.size(), d_.coordinate);
    requireLength("momenta p", z.p.size(), d_.coordinate);
    requireLength("force input u", z.u.size(), d_.force);
    requireLength("kinematic coordinates rho_k", z.rho0.size(), d_.kinematic);
    requireLength("kinematic coordinates rho_k+1", z.rho1.size(), d_.kinematic);
    requireLength("parameters theta", z.theta.size(), d_.parameter);
  }
  Result out{guess, z.p};
  while (out.iterations < options_.maxIterations) {
    ++out.iterations;
    const auto at = formulas_.newton(sigma(z, out.q1));
    const Coordinates residual = z.p + at.residual;
    out.residualNorm = residual.cwiseAbs().maxCoeff();
    const Coordinates delta = -inverse(at.dr_dq1) * residual;
    const double scaled = (delta.array().abs() / (1.0 + out.q1.array().abs())).maxCoeff();
    if (!std::isfinite(scaled) || !std::isfinite(out.residualNorm)) return out;
    out.q1 += delta;
    if (scaled <= options_.tolerance) {
      out.converged = true;
      out.p1 = formulas_.momentum(sigma(z, out.q1));
      return out;
    }
  }
  return out;
}

template <LagrangianSystem S>
template <class G>
auto VariationalIntegrator<S>::alongKnown(const G& g) const
    -> Matrix<double, zSize, G::ColsAtCompileTime> {
  const int k = d_.coordinate, r = d_.kinematic, u = d_.force, p = d_.parameter;
  Matrix<double, zSize, G::ColsAtCompileTime> out(zLength(), g.cols());
  constexpr int nr = S::kinematicSize, nu = S::forceInputSize, np = S::parameterSize;
  const auto rho = g.template middleRows<nr>(2 * k, r), w = g.template middleRows<nr>(2 * k + r, r);
  out.template topRows<n>(k) =
      0.5 * g.template topRows<n>(k) - g.template middleRows<n>(k, k) / timeStep_;
  out.template middleRows<n>(k, k).setZero();
  out.template middleRows<nu>(2 * k, u) = g.template middleRows<nu>(2 * k + 2 * r, u);
  out.template middleRows<nr>(2 * k + u, r) = 0.5 * rho - w / timeStep_;
  out.template middleRows<nr>(2 * k + u + r, r) = 0.5 * rho + w / timeStep_;
  out.template bottomRows<np>(p) = g.template bottomRows<np>(p);
  return out;
}

template <LagrangianSystem S>
auto VariationalIntegrator<S>::chain(const typename Formulas::Slopes& slopes) const -> Chain {
  const int k = d_.coordinate;
  const auto unknown = alongUnknown(slopes.gradients);
  const auto known = alongKnown(slopes.gradients);
  Chain c;
  // 0 = p_k + r̂: M dq_{k+1} = −(dp_k + ∂r̂/∂z dz)
  const Square transposedM = unknown.template leftCols<n>(k);
  c.inverseM = inverse(transposedM).transpose();
  Slope dr_dz = Slope::Zero(k, known.rows());
  dr_dz.template middleCols<n>(k, k).diagonal().setOnes();
  dr_dz += known.template leftCols<n>(k).transpose();
  c.dq1_dz = -c.inverseM * dr_dz;
  // p_{k+1} = p̂
  c.dp_dq1.noalias() = unknown.template rightCols<n>(k).transpose();
  c.dp1_dz.noalias() = known.template rightCols<n>(k).transpose();
  c.dp1_dz.noalias() += c.dp_dq1 * c.dq1_dz;
  return c;
}

template <LagrangianSystem S>
auto VariationalIntegrator<S>::sandwich(const typename Formulas::Hessian& H,
                                        const Slope& dq1_dz) const -> Hessian {
  const auto A = alongKnown(H);
  const auto At = A.transpose().eval();
  Hessian out = alongKnown(At);
  // mixed terms and twice half of the unknown's own
  Matrix<double, zSize, n> mixed = alongUnknown(At).transpose();
  const Square own = alongUnknown(alongUnknown(H).transpose().eval());
  mixed.noalias() += 0.5 * dq1_dz.transpose() * own;
  const Hessian half = mixed * dq1_dz;
  out += half + half.transpose();
  return out;
}

template <LagrangianSystem S>
auto VariationalIntegrator<S>::firstDerivatives(const Arguments& z, const Result& taken) const
    -> Jacobian {
  const Chain c = chain(formulas_.slopes(sigma(z, taken.q1)));
  Jacobian out(2 * d_.coordinate, zLength());
  out << c.dq1_dz, c.dp1_dz;
  return out;
}

template <LagrangianSystem S>
auto VariationalIntegrator<S>::secondDerivatives(const Arguments& z, const Result& taken) const
    -> SecondDerivatives {
  const std::size_t k = std::size_t(d_.coordinate);
  const auto at = formulas_.curvatures(sigma(z, taken.q1));
  const Chain c = chain(at.slopes);
  SecondDerivatives out;
  out.first.resize(2 * d_.coordinate, zLength());
  out.first << c.dq1_dz, c.dp1_dz;
  // Differentiating 0 = p_k + r̂ twice: M q″ = −Wᵀ r̂″ W; then p″ = Wᵀ p̂″ W + ∂p̂/∂q_{k+1} q″.
  MatrixStack<n, Hessian> r;
  if constexpr (stateSize == dynamic) {
    r.resize(k);
    out.second.resize(2 * k);
  }
  for (std::size_t i = 0; i < k; ++i) r[i] = sandwich(at.hessians[i], c.dq1_dz);
  for (std::size_t i = 0; i < k; ++i) {
    out.second[i].setZero(zLength(), zLength());
    for (std::size_t j = 0; j < k; ++j)
      out.second[i] -= c.inverseM(Eigen::Index(i), Eigen::Index(j)) * r[j];
  }
  for (std::size_t i = 0; i < k; ++i) {
    out.second[k + i] = sandwich(at.hessians[k + i], c.dq1_dz);
    for (std::size_t j = 0; j < k; ++j)
      out.second[k + i] += c.dp_dq1(Eigen::Index(i), Eigen::Index(j)) * out.second[j];
  }
  return out;
}

template <LagrangianSystem S>
auto VariationalIntegrator<S>::contractedSecondDerivatives(const Arguments& z, const Result& taken,
                                                           const State& w) const -> Hessian {
  const auto at = formulas_.curvatures(sigma(z, taken.q1));
  const Chain c = chain(at.slopes);
  // The weights of r̂″ and p̂″ once q″ is eliminated.
  const int k = d_.coordinate;
  State weights(2 * k);
  weights << -c.inverseM.transpose() *
                 (w.template head<n>(k) + c.dp_dq1.transpose() * w.template segment<n>(k, k)),
      w.template segment<n>(k, k);
  typename Formulas::Hessian sum = weights[0] * at.hessians[0];
  for (int i = 1; i < 2 * k; ++i) sum += weights[i] * at.hessians[std::size_t(i)];
  return sandwich(sum, c.dq1_dz);
}

template <LagrangianSystem S>
auto VariationalIntegrator<S>::linearise(const State& x, const Input& u0, const Input& u1,
                                         const Parameters& theta) const
    -> StepLinearisation<stateSize, inputSize, parameterSize> {
  const Arguments z = argumentsOf(x, u0, u1, theta);
  const Result taken = step(z);
  const Jacobian d = firstDerivatives(z, taken);
  const int k = d_.coordinate, m = d_.force + d_.kinematic, r = d_.kinematic;
  Matrix<double, stateSize, inputSize> du1(2 * k, m);
  du1.setZero();
  du1.template rightCols<S::kinematicSize>(r) =
      d.template middleCols<S::kinematicSize>(2 * k + m, r);
  return {stepOf(taken), d.template leftCols<stateSize>(2 * k),
          d.template middleCols<inputSize>(2 * k, m), du1,
          d.template rightCols<parameterSize>(d_.parameter)};
}

template <LagrangianSystem S>
auto VariationalIntegrator<S>::contractedHessian(const State& x, const Input& u0, const Input& u1,
                                                 const Parameters& theta, const State& w) const
    -> Matrix<double, argumentSize<VariationalIntegrator>, argumentSize<VariationalIntegrator>> {
  const Arguments z = argumentsOf(x, u0, u1, theta);
  const Hessian own = contractedSecondDerivatives(z, step(z), w);
  // The argument of a step map has u_{k+1}, which has no effect, between ρ_k and ρ_{k+1}.
  const int first = 2 * d_.coordinate + d_.force + d_.kinematic, gap = d_.force;
  const int rest = int(own.rows()) - first;
  Matrix<double, argumentSize<VariationalIntegrator>, argumentSize<VariationalIntegrator>> out(
      own.rows() + gap, own.cols() + gap);
  out.setZero();
  out.topLeftCorner(first, first) = own.topLeftCorner(first, first);
  out.topRightCorner(first, rest) = own.topRightCorner(first, rest);
  out.bottomLeftCorner(rest, first) = own.bottomLeftCorner(rest, first);
  out.bottomRightCorner(rest, rest) = own.bottomRightCorner(rest, rest);
  return out;
}

}  // namespace info
