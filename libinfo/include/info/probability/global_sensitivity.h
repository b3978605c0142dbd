#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <functional>
#include <vector>

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
  Eigen::VectorXd sd;  ///< σ of the signed effects: large beside μ*: curved or interacting
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
  Eigen::VectorXd totalSd;
  double variance = 0;  ///< summed over the outputs
  int runs = 0;
  int undefined = 0;
  bool complete = true;
};
/// @throws std::invalid_argument as morris
SobolResult sobol(const CubeModel& model, int parameters, const EnsembleOptions& options = {});

/// Run `index` of those that sobol() makes, a function of its arguments alone: base point
/// k = index/(p + 2), of which run 0 is A_k, run 1 is B_k, and run 2 + i is A_k with coordinate i
/// of B_k. A_k and B_k are the halves of point k of Halton's sequence in 2p dimensions.
/// @throws std::invalid_argument for a number of parameters that is not 1 to 32
Eigen::VectorXd sobolPoint(std::uint64_t index, int parameters, std::uint64_t seed);

/// The indices from outputs that somebody else has computed at the points 0 … n·(p + 2) − 1.
/// @param outputs  empty where the model is undefined
/// @throws std::invalid_argument as morris, or if the outputs are not n·(p + 2)
SobolResult sobolIndices(const std::vector<Eigen::VectorXd>& outputs, int parameters);

/// How far chance in the choice of base points may have moved the indices.
struct SobolIntervals {
  Eigen::MatrixX2d first, total;  ///< from quantile to quantile
};
/// Percentile bootstrap: base points are drawn anew with replacement, all runs of a point together.
/// Halton's points fill the cube more evenly than chance, so the intervals are rather too wide.
/// @param replicates ≥ 20
/// @param confidence in (0, 1)
/// @throws std::invalid_argument for options out of range, and as sobolIndices
SobolIntervals bootstrapSobol(const std::vector<Eigen::VectorXd>& outputs, int parameters,
                              int replicates, std::uint64_t seed, double confidence = 0.95);

/// Point `index` of Halton's sequence with digits permuted at random for each prime base (the
/// permutation depends on seed and base alone): fills the unit cube more evenly than chance.
/// @param dimension 1 to 64
Eigen::VectorXd haltonPoint(std::uint64_t index, int dimension, std::uint64_t seed);

}  // namespace info
