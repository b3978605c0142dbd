#pragma once

#include <cmath>

#include "info/dynamics/system.h"

namespace info {

/// A cart with a mass on a string and a load cell at its top: the second robot of chapter 4 of
/// Wilson's thesis.
///
///     ẍ = u,   ℓ φ̈ = u cos φ − g sin φ,   state (x, φ, ẋ, φ̇),   θ = (m, ℓ)
///     y = F = m (g cos φ + ℓ φ̇² + u sin φ)      tension of the string [N]
/// φ [rad] from hanging down, the bob at x − ℓ sin φ, u cart acceleration [m/s²]; smooth for ℓ > 0,
/// valid while the string is taut, F > 0.
///
/// Source: Wilson, Information-based Trajectory Optimization, section 4.5. The output differs from
/// the printed (4.7), in which the signs of ℓφ̇² and of u are reversed and the factor m of u is
/// missing; here it is the constraint force from first principles.
struct SuspendedMass {
  static constexpr int stateSize = 4, inputSize = 1, parameterSize = 2, outputSize = 1;
  double gravity = 9.81;  ///< g [m/s²]

  std::vector<std::string> parameterNames() const { return {"mass", "length"}; }
  template <class T>
  Vector<T, 4> f(const Vector<T, 4>& x, const Vector<T, 1>& u, const Vector<T, 2>& theta) const {
    using std::cos, std::sin;
    const T cosine = cos(x[1]), sine = sin(x[1]);
    Vector<T, 4> xDot;
    xDot << x[2], x[3], u[0], (u[0] * cosine - gravity * sine) / theta[1];
    return xDot;
  }
  template <class T>
  Vector<T, 1> g(const Vector<T, 4>& x, const Vector<T, 1>& u, const Vector<T, 2>& theta) const {
    using std::cos, std::sin;
    const T cosine = cos(x[1]), sine = sin(x[1]);
    const T pull = gravity * cosine + theta[1] * x[3] * x[3] + u[0] * sine;
    Vector<T, 1> y;
    y << theta[0] * pull;
    return y;
  }
};

}  // namespace info
