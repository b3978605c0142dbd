#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <functional>
#include <vector>

namespace info {

/// Global sensitivity over the whole range of the parameters, as opposed to local derivatives. A
/// model is a function on the unit cube; if it has several outputs (a motion sampled in time), they
/// are evaluated together.
struct EnsembleOptions {
  int samples = 256;       ///< base points (Sobol) or trajectories (Morris) ≥ 2
  std::uint64_t seed = 1;  ///< the same seed gives identical results for any number of threads
  int threads = 0;         ///< 0: all cores
  /// Called with the number of finished runs, one call at a time; returning false stops.
  std::function<bool(int done, int runs)> progress = {};
};

/// Outputs at a point of the unit cube; not finite if the model is undefined there: the point and
/// its differences are then excluded.
using CubeModel = std::function<Eigen::VectorXd(const Eigen::VectorXd& unit)>;

/// Morris's screening (1991), with Campolongo's μ* (2007): along random trajectories on a grid of
/// four levels each parameter is stepped once by Δ = 2/3. An elementary effect is the root mean
/// square over the outputs of (y(x + Δe_i) − y(x))/Δ, for σ with the sign of its mean.
struct MorrisResult {
  Eigen::VectorXd meanAbsolute;  ///< μ*, per unit of the cube
  Eigen::VectorXd sd;  ///< σ of the signed effects; large relative to μ*: nonlinear or interacting
  int runs = 0;
  int undefined = 0;  ///< number of runs without finite outputs
  bool complete = true;
};
/// @throws std::invalid_argument without a parameter or for fewer than two trajectories
MorrisResult morris(const CubeModel& model, int parameters, const EnsembleOptions& options = {});

/// Sobol's indices by Saltelli's scheme with n·(p + 2) runs: first order by Saltelli et al. (2010),
/// S_i = E[y_B (y_ABi − y_A)]/V, total by Jansen, T_i = E[(y_A − y_ABi)²]/2V. Variances of several
/// outputs are added before dividing (Lamboni et al. 2011).
struct SobolResult {
  Eigen::VectorXd first;  ///< fraction of the variance explained by parameter i alone
  Eigen::VectorXd total;  ///< fraction of the variance in which parameter i takes part, ≥ first
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

/// The indices from given outputs at the points 0 … n·(p + 2) − 1.
/// @param outputs  empty where the model is undefined
/// @throws std::invalid_argument as morris, or if the outputs are not n·(p + 2)
SobolResult sobolIndices(const std::vector<Eigen::VectorXd>& outputs, int parameters);

/// Uncertainty of the indices due to the choice of base points.
struct SobolIntervals {
  Eigen::MatrixX2d first, total;  ///< from quantile to quantile
};
/// Percentile bootstrap: base points are resampled with replacement, all runs of a point together.
/// Halton's points fill the cube more evenly than random points, so the intervals tend to be too
/// wide.
/// @param replicates ≥ 20
/// @param confidence in (0, 1)
/// @throws std::invalid_argument for options out of range, and as sobolIndices
SobolIntervals bootstrapSobol(const std::vector<Eigen::VectorXd>& outputs, int parameters,
                              int replicates, std::uint64_t seed, double confidence = 0.95);

/// Point `index` of Halton's sequence with digits permuted at random for each prime base (the
/// permutation depends on seed and base alone): fills the unit cube more evenly than random points.
/// @param dimension 1 to 64
Eigen::VectorXd haltonPoint(std::uint64_t index, int dimension, std::uint64_t seed);

}  // namespace info
