#pragma once

#include "info/dynamics/discrete_lagrangian.h"

namespace info {

/// The midpoint variational step written as an implicit step map, straight from its definition with
/// D₁L_d and D₂L_d by dual numbers: the independent second way for
/// VariationalIntegrator, without its chain rule, its recorded formulas or its implicit function.
template <LagrangianSystem S>
struct DualVariationalMap {
  static constexpr int n = S::coordinateSize, k = S::kinematicSize, m = S::forceInputSize;
  static constexpr int stateSize = 2 * n, inputSize = m + k, parameterSize = S::parameterSize,
                       outputSize = S::measurementSize;
  S system;
  double timeStep;
  Forcing forcing = Forcing::symmetric;

  std::vector<std::string> parameterNames() const { return system.parameterNames(); }

  template <class T>
  Vector<T, stateSize> residual(const Vector<T, stateSize>& x1, const Vector<T, stateSize>& x,
                                const Vector<T, inputSize>& u0, const Vector<T, inputSize>& u1,
                                const Vector<T, parameterSize>& theta) const {
    using D = Dual<stateSize, T>;
    Vector<D, n> q0, q1;
    for (int i = 0; i < n; ++i) {
      q0[i] = D(x[i], stateSize, i);
      q1[i] = D(x1[i], stateSize, n + i);
    }
    const auto constant = [](const auto& v) {
      using V = std::remove_cvref_t<decltype(v)>;
      Vector<D, V::RowsAtCompileTime> out;
      for (int i = 0; i < int(v.size()); ++i) out[i] = D(v[i]);
      return out;
    };
    const Vector<T, k> r0 = u0.template tail<k>(), r1 = u1.template tail<k>();
    const Vector<T, m> u = u0.template head<m>();
    const Vector<T, k> rm = (r0 + r1) * T(0.5), w = (r1 - r0) * T(1.0 / timeStep);
    Vector<D, n> qm, v;
    for (int i = 0; i < n; ++i) {
      qm[i] = 0.5 * (q0[i] + q1[i]);
      v[i] = (q1[i] - q0[i]) * (1.0 / timeStep);
    }
    const D Ld = system.lagrangian(qm, v, constant(rm), constant(w), constant(theta)) * timeStep;
    Vector<T, n> qmT, vT;
    for (int i = 0; i < n; ++i) {
      qmT[i] = qm[i].value();
      vT[i] = v[i].value();
    }
    const Vector<T, n> f = system.force(qmT, vT, rm, w, u, theta);
    const bool left = forcing == Forcing::left;
    Vector<T, stateSize> r;
    for (int i = 0; i < n; ++i) {
      r[i] = x[n + i] + Ld.derivatives()[i] + f[i] * (left ? timeStep : 0.5 * timeStep);
      r[n + i] = x1[n + i] - Ld.derivatives()[n + i] - f[i] * (left ? 0.0 : 0.5 * timeStep);
    }
    return r;
  }
  template <class T>
  Vector<T, outputSize> g(const Vector<T, stateSize>& x, const Vector<T, inputSize>& u,
                          const Vector<T, parameterSize>& theta) const {
    return system.measure(Vector<T, n>(x.template head<n>()), Vector<T, k>(u.template tail<k>()),
                          theta);
  }
};

}  // namespace info
