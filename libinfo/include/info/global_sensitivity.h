#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <functional>

namespace info {

/// Sensitivity over the whole range of the parameters, beside the local one of derivatives. A model
/// is a function of the unit cube; its outputs may be many (a motion sampled in time), and count
/// together.
struct EnsembleOptions {
  int samples = 256;       ///< base points (Sobol) or trajectories (Morris) ≥ 2
  std::uint64_t seed = 1;  ///< same seed, same bits, whatever the number of threads
  int threads = 0;         ///< 0: all cores
  /// Called with the number of runs done, one call at a time; returning false stops.
  std::function<bool(int done, int runs)> progress = {};
};

/// Outputs at a point of the unit cube; not finite where the model is undefined: that point, and
/// what is compared with it, is left out.
using CubeModel = std::function<Eigen::VectorXd(const Eigen::VectorXd& unit)>;

/// Morris's screening (1991), with Campolongo's μ* (2007): along random trajectories on a grid of
/// four levels each parameter is stepped once by Δ = 2/3. An elementary effect is the root mean
/// square over the outputs of (y(x + Δe_i) − y(x))/Δ, for σ with the sign of its mean.
struct MorrisResult {
  Eigen::VectorXd meanAbsolute;  ///< μ*, per unit of the cube
  Eigen::VectorXd deviation;  ///< σ of the signed effects: large beside μ*: curved or interacting
  int runs = 0;
  int undefined = 0;  ///< runs that gave nothing finite
  bool complete = true;
};
/// @throws std::invalid_argument for no parameter or fewer than two trajectories
MorrisResult morris(const CubeModel& model, int parameters, const EnsembleOptions& options = {});

/// Sobol's indices by Saltelli's scheme with n·(p + 2) runs: first order by Saltelli et al. (2010),
/// S_i = E[y_B (y_ABi − y_A)]/V, total by Jansen, T_i = E[(y_A − y_ABi)²]/2V. Variances of several
/// outputs are added before dividing (Lamboni et al. 2011).
struct SobolResult {
  Eigen::VectorXd first;           ///< share of the variance that i explains alone
  Eigen::VectorXd total;           ///< share that would vanish at best if i were known ≥ first
  Eigen::VectorXd firstDeviation;  ///< standard errors over the base points
  Eigen::VectorXd totalDeviation;
  double variance = 0;  ///< summed over the outputs
  int runs = 0;
  int undefined = 0;
  bool complete = true;
};
/// @throws std::invalid_argument as morris
SobolResult sobol(const CubeModel& model, int parameters, const EnsembleOptions& options = {});

/// Point `index` of Halton's sequence with digits permuted at random for each prime base (the
/// permutation depends on seed and base alone): fills the unit cube more evenly than chance.
/// @param dimension 1 to 64
Eigen::VectorXd haltonPoint(std::uint64_t index, int dimension, std::uint64_t seed);

}  // namespace info
