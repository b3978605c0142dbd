#pragma once

#include <limits>

#include "bio/discovery/musculoskeletal_problem.h"

namespace bio::discover {

/// The physical size of an effect along one motion. NaN: unknown or undefined.
struct EffectSize {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double momentRms = unknown;   ///< RMS of its moment [N·m] or force [N]
  double momentPeak = unknown;  ///< its largest absolute value
  double share = unknown;       ///< momentRms over the RMS of the muscles' net moment
  double motionRms = unknown;   ///< RMS change of the motion [rad] or [m]
};

/// The size of one of the candidates along the motion of a trial, simulated at `values`.
///
/// The moment of an effect is the external moment that would produce the same motion q(t) without
/// it. With τ(θ) = M q̈ + ½ M' q̇² + V' − τ_passive − Σ r_i F_i, the moment that the model needs
/// with the parameters θ,
///     moment = τ(without) − τ(with)
/// where the fibres of both follow q(t). For a force it is the force itself, for a mass its weight
/// and inertia, for an error of EMG or muscle the difference of the muscles' moments. motionRms
/// compares the simulation at `values` with the one without this effect, from the same initial
/// state. An effect of the sensor has no moment; its motionRms is the RMS difference between sensor
/// and motion.
///
/// @param candidate  index into MusculoskeletalProblem::candidates()
/// @param values     of all quantities
EffectSize effectSize(const MusculoskeletalProblem& data, std::size_t candidate,
                      const Eigen::VectorXd& values, int trial);

}  // namespace bio::discover
