#pragma once

#include <limits>

#include "bio/discover/elbow_disagreement.h"

namespace bio::discover {

/// What an effect does to one motion, in physical terms. NaN: not known, or there is no such thing.
struct EffectSize {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double momentRms = unknown;   ///< root mean square of its moment [N·m] or force [N]
  double momentPeak = unknown;  ///< largest size of that
  double share = unknown;       ///< momentRms over the root mean square of the muscles' net moment
  double motionRms = unknown;   ///< root mean square of what it changes in the motion [rad] or [m]
};

/// The size of one of the candidates along the motion of a trial, simulated at `values`.
///
/// The moment of an effect is what would have to push the coordinate from outside to make the same
/// motion q(t) without it. With τ(θ) = M q̈ + ½ M' q̇² + V' − τ_passive − Σ r_i F_i, what the arm
/// with the numbers θ needs,
///     moment = τ(without) − τ(with)
/// the fibres of both moving along q(t). Of a law it is the law's own force, of a mass its weight
/// and inertia, of an error of EMG or muscle what the muscles' moments differ by. motionRms
/// compares the simulation at `values` with the one where this effect alone is absent, from the
/// same start. An effect of the sensor has no moment; its motionRms is how far the sensor is from
/// the motion.
///
/// @param candidate  index into ElbowDisagreement::candidates()
/// @param values     of all quantities
EffectSize effectSize(const ElbowDisagreement& data, std::size_t candidate,
                      const Eigen::VectorXd& values, int trial);

}  // namespace bio::discover
