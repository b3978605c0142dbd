#pragma once

#include "info/dynamics/system.h"

namespace info {

/// A system with some parameters fixed: θ are those with the indices Free, in that order; the
/// others have given values.
template <System S, int... Free>
struct FreeParameters {
  static constexpr int stateSize = S::stateSize, inputSize = S::inputSize,
                       parameterSize = sizeof...(Free), outputSize = S::outputSize;
  static_assert(parameterSize > 0 && ((Free >= 0 && Free < S::parameterSize) && ...),
                "at least one parameter, each one the system has");

  S system;
  ParametersOf<S> values;  ///< of the whole system, each in its unit

  std::vector<std::string> parameterNames() const {
    const std::vector<std::string> all = system.parameterNames();
    return {all[std::size_t{Free}]...};
  }
  template <class T>
  ParametersOf<S, T> whole(const Vector<T, parameterSize>& theta) const {
    ParametersOf<S, T> all = values.template cast<T>();
    Eigen::Index i = 0;
    ((all[Free] = theta[i++]), ...);
    return all;
  }
  template <class T>
  Vector<T, stateSize> f(const Vector<T, stateSize>& x, const Vector<T, inputSize>& u,
                         const Vector<T, parameterSize>& theta) const {
    return system.f(x, u, whole(theta));
  }
  template <class T>
  Vector<T, outputSize> g(const Vector<T, stateSize>& x, const Vector<T, inputSize>& u,
                          const Vector<T, parameterSize>& theta) const {
    return system.g(x, u, whole(theta));
  }
};

}  // namespace info
