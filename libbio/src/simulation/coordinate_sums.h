#pragma once

// Sums over N coordinates, or any number of them where N is Eigen::Dynamic; not public.

#include <Eigen/Dense>

#include "bio/simulation/musculoskeletal_system.h"

namespace bio::stepping {

/// N, or where it is Eigen::Dynamic the number given.
template <int N>
constexpr int countOf(int number) {
  return N == Eigen::Dynamic ? number : N;
}
template <int N>
int countOf(const MusculoskeletalSystem& system) {
  return countOf<N>(system.skeleton().numCoordinates());
}

/// Calls use(coordinate, slot) for every coordinate that moves a path; slots number these.
template <int N, class Use>
void forEachMoved(const LengthJet<N>& path, const Use& use) {
  if constexpr (N == Eigen::Dynamic) {
    for (std::size_t slot = 0; slot < path.support.size(); ++slot) {
      use(path.support[slot], static_cast<int>(slot));
    }
  } else {
    for (int k = 0; k < N; ++k) use(k, k);
  }
}

/// sum += factor ∂ℓ ∂ℓᵀ
template <int N>
void addOuter(Eigen::Matrix<double, N, N>& sum, double factor, const LengthJet<N>& path) {
  if constexpr (N == Eigen::Dynamic) {
    for (const int j : path.support) {
      const double scaled = factor * path.dL_dq[j];
      for (const int i : path.support) sum(i, j) += scaled * path.dL_dq[i];
    }
  } else {
    sum.noalias() += (factor * path.dL_dq) * path.dL_dq.transpose();
  }
}

/// sum += factor ∂²ℓ
template <int N>
void addSecond(Eigen::Matrix<double, N, N>& sum, double factor, const LengthJet<N>& path) {
  if constexpr (N == Eigen::Dynamic) {
    for (std::size_t b = 0; b < path.support.size(); ++b) {
      for (std::size_t a = 0; a < path.support.size(); ++a) {
        sum(path.support[a], path.support[b]) +=
            factor * path.second(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      }
    }
  } else {
    sum += factor * path.d2L_dq2;
  }
}

/// sum += outer ∂ℓ ∂ℓᵀ + second ∂²ℓ, other += factor ∂ℓ ∂ℓᵀ, in one pass
template <int N>
void addStiffness(Eigen::Matrix<double, N, N>& sum, double outer, double second,
                  Eigen::Matrix<double, N, N>& other, double factor, const LengthJet<N>& path) {
  if constexpr (N == Eigen::Dynamic) {
    const auto n = static_cast<Eigen::Index>(path.support.size());
    const int* support = path.support.data();
    const double* d = path.dL_dq.data();
    for (Eigen::Index b = 0; b < n; ++b) {
      const int j = support[b];
      const double scaled = outer * d[j], scaledOther = factor * d[j];
      const double* bend = path.second.col(b).data();
      double* into = sum.col(j).data();
      double* intoOther = other.col(j).data();
      for (Eigen::Index a = 0; a < n; ++a) {
        const int i = support[a];
        into[i] = into[i] + scaled * d[i] + second * bend[a];
        intoOther[i] += scaledOther * d[i];
      }
    }
  } else {
    addOuter<N>(sum, outer, path);
    addSecond<N>(sum, second, path);
    addOuter<N>(other, factor, path);
  }
}

/// sum += factor ∂²ℓ v
template <int N>
void addSecondTimes(Eigen::Matrix<double, N, 1>& sum, double factor, const LengthJet<N>& path,
                    const Eigen::Matrix<double, N, 1>& v) {
  if constexpr (N == Eigen::Dynamic) {
    for (std::size_t b = 0; b < path.support.size(); ++b) {
      const double scaled = factor * v[path.support[b]];
      for (std::size_t a = 0; a < path.support.size(); ++a) {
        sum[path.support[a]] +=
            scaled * path.second(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      }
    }
  } else {
    sum.noalias() += factor * (path.d2L_dq2 * v);
  }
}

/// Rows and columns of some coordinates become those of the unit matrix, so that what is solved for
/// them is given.
template <class Matrix>
void decouple(const std::vector<int>& coordinates, Matrix& M) {
  for (const int k : coordinates) {
    M.row(k).setZero();
    M.col(k).setZero();
    M(k, k) = 1;
  }
}

/// force += factor ∂ℓ
template <int N>
void addAlong(Eigen::Matrix<double, N, 1>& force, double factor, const LengthJet<N>& path) {
  if constexpr (N == Eigen::Dynamic) {
    for (const int k : path.support) force[k] += factor * path.dL_dq[k];
  } else {
    force += factor * path.dL_dq;
  }
}

/// Vectors and matrices of a step: locals of a fixed size, or kept from step to step so that
/// nothing is allocated.
template <int N, int Vectors, int Matrices>
class Scratch {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  explicit Scratch(int number) {
    if constexpr (N == Eigen::Dynamic) {
      for (Vector& v : vectors_) v.setZero(number);
      for (Matrix& m : matrices_) m.setZero(number, number);
    }
  }

  /// A reference, or a local that is not set.
  template <int I>
  decltype(auto) vector() {
    static_assert(I < Vectors);
    if constexpr (N == Eigen::Dynamic) {
      return (vectors_[I]);
    } else {
      return Vector();
    }
  }
  template <int I>
  decltype(auto) matrix() {
    static_assert(I < Matrices);
    if constexpr (N == Eigen::Dynamic) {
      return (matrices_[I]);
    } else {
      return Matrix();
    }
  }

 private:
  std::array<Vector, N == Eigen::Dynamic ? Vectors : 0> vectors_;
  std::array<Matrix, N == Eigen::Dynamic ? Matrices : 0> matrices_;
};

}  // namespace bio::stepping
