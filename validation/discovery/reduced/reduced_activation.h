#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <vector>

#include "info/autodiff/dual.h"
#include "reduced/reduced_elbow.h"
#include "reduced/reduced_quantities.h"

namespace reduced {

/// Which of the input-like quantities moves activations; derivatives are carried in this order.
inline constexpr std::array<std::size_t, 5> kInputLike = {kTau, kDelay, kShape, kTriFromBic,
                                                          kBicFromTri};

/// Activations every half step, and what they add up to, ∫level dt.
template <class T>
struct Activation {
  std::vector<std::array<T, kMuscles>> level, used;
};

/// What reaches the muscles at time t: delayed, freed of crosstalk, reshaped.
template <class T>
std::array<T, kMuscles> drive(const Trial& trial, double t, const std::array<T, 5>& p) {
  const auto last = static_cast<std::ptrdiff_t>(trial.excitations.size()) - 2;
  const T place = (t - p[1]) / kTick;
  auto k = static_cast<std::ptrdiff_t>(std::floor(info::plainValue(place) + 1e-9));
  T share = place - static_cast<double>(k);
  if (k < 0) k = 0, share = T(0.0);
  if (k > last) k = last, share = T(1.0);
  const auto& from = trial.excitations[static_cast<std::size_t>(k)];
  const auto& to = trial.excitations[static_cast<std::size_t>(k) + 1];
  std::array<T, kMuscles> u;
  for (std::size_t m = 0; m < kMuscles; ++m) u[m] = from[m] + share * (to[m] - from[m]);
  const T biceps = u[0];
  u[0] = u[0] - p[4] * u[3];
  u[3] = u[3] - p[3] * biceps;
  const T A = p[2];
  for (T& x : u) {
    using std::exp;
    if (std::abs(info::plainValue(A)) < 1e-4)
      x = x + A * (0.5 * x * (x - 1.0));  // the series of what follows
    else
      x = (exp(A * x) - 1.0) / (exp(A) - 1.0);
  }
  return u;
}

/// Solves ȧ = (u − a)·(u/τ_a + (1 − u)/τ_d) by the classical Runge–Kutta method, `count` values.
template <class T>
Activation<T> activate(const Trial& trial, double half, std::size_t count,
                       const Eigen::VectorXd& values) {
  std::array<T, 5> p;
  for (std::size_t i = 0; i < 5; ++i) {
    p[i] = T(values[static_cast<Eigen::Index>(kInputLike[i])]);
    if constexpr (!std::same_as<T, double>)
      p[i] = T(values[static_cast<Eigen::Index>(kInputLike[i])], 5, static_cast<int>(i));
  }
  const T up = 1.0 / p[0], down = 0.5 * up;
  const auto rate = [&](const T& a, const T& u) { return (u - a) * (down + u * (up - down)); };
  Activation<T> result;
  result.level.resize(count);
  result.used.resize(count);
  std::array<T, kMuscles> u = drive<T>(trial, 0, p);
  for (std::size_t m = 0; m < kMuscles; ++m) {
    result.level[0][m] = u[m];
    result.used[0][m] = T(0.0);
  }
  for (std::size_t n = 0; n + 1 < count; ++n) {
    const double t = static_cast<double>(n) * half;
    const auto middle = drive<T>(trial, t + 0.5 * half, p), end = drive<T>(trial, t + half, p);
    for (std::size_t m = 0; m < kMuscles; ++m) {
      const T& a = result.level[n][m];
      const T k1 = rate(a, u[m]), k2 = rate(a + (0.5 * half) * k1, middle[m]);
      const T k3 = rate(a + (0.5 * half) * k2, middle[m]), k4 = rate(a + half * k3, end[m]);
      result.level[n + 1][m] = a + (half / 6) * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
      result.used[n + 1][m] = result.used[n][m] + (0.5 * half) * (a + result.level[n + 1][m]);
    }
    u = end;
  }
  return result;
}

}  // namespace reduced
