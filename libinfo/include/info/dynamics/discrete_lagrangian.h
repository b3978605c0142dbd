#pragma once

#include <array>
#include <type_traits>

#include "info/dynamics/lagrangian.h"
#include "info/dynamics/step_map.h"

namespace info {

/// `Count` matrices, on the stack where the count is fixed.
template <int Count, class M>
using MatrixStack = std::conditional_t<Count == dynamic, std::vector<M>,
                                       std::array<M, std::size_t(Count == dynamic ? 1 : Count)>>;

/// a · b of two sizes, `dynamic` if either is.
constexpr int multiplySizes(int a, int b) {
  return a == dynamic || b == dynamic ? dynamic : a * b;
}

/// The two functions of a midpoint step and their derivatives,
///
///     r̂(σ) = D₁L_d + F⁻ = ½Δt ∂L/∂q − ∂L/∂q̇ + F⁻
///     p̂(σ) = D₂L_d + F⁺ = ½Δt ∂L/∂q + ∂L/∂q̇ + F⁺,   σ = (q_m, v, ρ_m, w, u, θ)
/// because L_d depends on its four positions only through the midpoint and the mean velocity. Both
/// are recorded once as formulas, together with their first and second derivatives in σ.
template <LagrangianSystem S>
class DiscreteLagrangian {
 public:
  static constexpr int n = S::coordinateSize;
  static constexpr int pairSize = addSizes(n, n);
  static constexpr int sigmaSize =
      addSizes(addSizes(pairSize, addSizes(S::kinematicSize, S::kinematicSize)),
               addSizes(S::forceInputSize, S::parameterSize));
  using Sigma = Vector<double, sigmaSize>;
  using Coordinates = CoordinatesOf<S>;
  using Hessian = Matrix<double, sigmaSize, sigmaSize>;

  struct Newton {
    Coordinates residual;         ///< r̂
    Matrix<double, n, n> dr_dq1;  ///< M = ∂r̂/∂q_{k+1} = ½ ∂r̂/∂q_m + ∂r̂/∂v/Δt
  };
  struct Slopes {
    Coordinates momentum;                           ///< p̂
    Matrix<double, sigmaSize, pairSize> gradients;  ///< column i: ∂(r̂, p̂)_i/∂σ
  };
  struct Curvatures {
    Slopes slopes;
    MatrixStack<pairSize, Hessian> hessians;  ///< ∂²(r̂, p̂)_i/∂σ²
  };

  DiscreteLagrangian(const S& system, double timeStep, Forcing forcing);

  Coordinates momentum(const Sigma& sigma) const {
    Coordinates out(d_.coordinate);
    momentum_.evaluate(sigma.data(), out.data());
    return out;
  }
  Newton newton(const Sigma& sigma) const;
  Slopes slopes(const Sigma& sigma) const;
  Curvatures curvatures(const Sigma& sigma) const;

  int sigmaLength() const { return 2 * d_.coordinate + 2 * d_.kinematic + d_.force + d_.parameter; }

 private:
  static constexpr int newtonSize = addSizes(n, multiplySizes(n, n));
  static constexpr int slopeSize = addSizes(n, multiplySizes(sigmaSize, pairSize));
  static constexpr int curvatureSize =
      addSizes(slopeSize, multiplySizes(pairSize, multiplySizes(sigmaSize, sigmaSize)));
  template <class Flat>
  Slopes slopesOf(const Flat& flat) const;

  MechanicalDimensions d_;
  RecordedFunction newton_, momentum_, slopes_, curvatures_;
};

template <LagrangianSystem S>
DiscreteLagrangian<S>::DiscreteLagrangian(const S& system, double timeStep, Forcing forcing)
    : d_(mechanicalDimensionsOf(system)) {
  Recording recording;
  const auto arguments = [&](auto&& vector) {
    for (auto& s : vector) s = recording.argument();
    return vector;
  };
  // Arguments in the order of σ.
  const auto q = arguments(CoordinatesOf<S, Symbol>(d_.coordinate));
  const auto v = arguments(CoordinatesOf<S, Symbol>(d_.coordinate));
  const auto rho = arguments(KinematicOf<S, Symbol>(d_.kinematic));
  const auto w = arguments(KinematicOf<S, Symbol>(d_.kinematic));
  const auto u = arguments(ForceInputOf<S, Symbol>(d_.force));
  const auto theta = arguments(ParametersOf<S, Symbol>(d_.parameter));
  std::vector<Symbol> sigma;
  for (const auto* part : {&q, &v}) sigma.insert(sigma.end(), part->begin(), part->end());
  for (const auto* part : {&rho, &w}) sigma.insert(sigma.end(), part->begin(), part->end());
  sigma.insert(sigma.end(), u.begin(), u.end());
  sigma.insert(sigma.end(), theta.begin(), theta.end());

  // r̂ and p̂.
  const Symbol L = system.lagrangian(q, v, rho, w, theta);
  const CoordinatesOf<S, Symbol> f = system.force(q, v, rho, w, u, theta);
  requireLength("force f", f.size(), d_.coordinate);
  const std::size_t size = std::size_t(d_.coordinate), ns = sigma.size();
  std::vector<Symbol> rp(2 * size);
  for (std::size_t i = 0; i < size; ++i) {
    const Symbol half = 0.5 * timeStep * recording.derivative(L, sigma[i]);
    const Symbol impulse = recording.derivative(L, sigma[size + i]);
    const Symbol force = f[Eigen::Index(i)];
    const bool left = forcing == Forcing::left;
    rp[i] = half + (left ? timeStep : 0.5 * timeStep) * force - impulse;
    rp[size + i] = half + impulse + (left ? 0.0 : 0.5 * timeStep) * force;
  }
  const std::vector<Symbol> r(rp.begin(), rp.begin() + d_.coordinate);
  const std::vector<Symbol> p(rp.begin() + d_.coordinate, rp.end());
  momentum_ = RecordedFunction(recording, p);

  // r̂ with M, column by column.
  std::vector<Symbol> newton = r;
  for (std::size_t j = 0; j < size; ++j)
    for (std::size_t i = 0; i < size; ++i)
      newton.push_back(0.5 * recording.derivative(r[i], sigma[j]) +
                       recording.derivative(r[i], sigma[size + j]) / timeStep);
  newton_ = RecordedFunction(recording, newton);

  // p̂ with all first derivatives, then with all second ones; zeros are not computed.
  std::vector<Symbol> outputs = p;
  std::vector<int> targets;
  for (std::size_t i = 0; i < size; ++i) targets.push_back(int(i));
  const auto put = [&](const Symbol& s, std::size_t target) {
    if (s.isZero()) return;
    outputs.push_back(s);
    targets.push_back(int(target));
  };
  for (std::size_t i = 0; i < 2 * size; ++i)
    for (std::size_t a = 0; a < ns; ++a)
      put(recording.derivative(rp[i], sigma[a]), size + i * ns + a);
  slopes_ = RecordedFunction(recording, outputs, targets);
  const std::size_t start = size + 2 * size * ns;
  for (std::size_t i = 0; i < 2 * size; ++i)
    for (std::size_t a = 0; a < ns; ++a)
      for (std::size_t b = 0; b <= a; ++b) {
        const Symbol s = recording.derivative(recording.derivative(rp[i], sigma[a]), sigma[b]);
        put(s, start + (i * ns + a) * ns + b);
        if (a != b) put(s, start + (i * ns + b) * ns + a);
      }
  curvatures_ = RecordedFunction(recording, outputs, targets);
}

template <LagrangianSystem S>
auto DiscreteLagrangian<S>::newton(const Sigma& sigma) const -> Newton {
  const int size = d_.coordinate;
  Vector<double, newtonSize> flat(size + size * size);
  newton_.evaluate(sigma.data(), flat.data());
  return {flat.template head<n>(size),
          Eigen::Map<const Matrix<double, n, n>>(flat.data() + size, size, size)};
}

template <LagrangianSystem S>
template <class Flat>
auto DiscreteLagrangian<S>::slopesOf(const Flat& flat) const -> Slopes {
  const int size = d_.coordinate;
  return {flat.template head<n>(size), Eigen::Map<const Matrix<double, sigmaSize, pairSize>>(
                                           flat.data() + size, sigmaLength(), 2 * size)};
}

template <LagrangianSystem S>
auto DiscreteLagrangian<S>::slopes(const Sigma& sigma) const -> Slopes {
  const int size = d_.coordinate;
  Vector<double, slopeSize> flat(size + 2 * size * sigmaLength());
  flat.setZero();
  slopes_.evaluate(sigma.data(), flat.data());
  return slopesOf(flat);
}

template <LagrangianSystem S>
auto DiscreteLagrangian<S>::curvatures(const Sigma& sigma) const -> Curvatures {
  const int size = d_.coordinate, ns = sigmaLength();
  Vector<double, curvatureSize> flat(size + 2 * size * ns * (1 + ns));
  flat.setZero();
  curvatures_.evaluate(sigma.data(), flat.data());
  Curvatures out{slopesOf(flat), {}};
  if constexpr (pairSize == dynamic) out.hessians.resize(std::size_t(2 * size));
  const double* place = flat.data() + size + 2 * size * ns;
  for (auto& hessian : out.hessians) {
    hessian = Eigen::Map<const Hessian>(place, ns, ns);
    place += ns * ns;
  }
  return out;
}

}  // namespace info
