#pragma once

#include <limits>
#include <vector>

#include "bio/discovery/musculoskeletal_problem.h"

namespace bio::discover {

/// Moment of an effect on one coordinate along one motion. NaN: unknown or undefined.
struct EffectMoment {
  double rms = std::numeric_limits<double>::quiet_NaN();    ///< [N·m] or force [N]
  double peak = std::numeric_limits<double>::quiet_NaN();   ///< its largest absolute value
  double share = std::numeric_limits<double>::quiet_NaN();  ///< rms over the RMS of the muscles'
                                                            ///< net moment on this coordinate
  /// RMS change of the simulated coordinate without the effect [rad] or [m].
  double motionRms = std::numeric_limits<double>::quiet_NaN();
};

/// The physical size of an effect along one motion. NaN: unknown or undefined.
struct EffectSize {
  EffectMoment moment;                ///< on the observed coordinate
  std::vector<EffectMoment> moments;  ///< on every free coordinate, in order; empty: unknown
  double motionRms = std::numeric_limits<double>::quiet_NaN();  ///< RMS change of the observed
                                                                ///< coordinate [rad] or [m]
};

/// The size of one of the candidates along the motion of a trial, simulated at `values`.
///
/// The moment of an effect is the external moment that would produce the same motion q(t) without
/// it. With τ(θ) the generalised forces that keep the model with the parameters θ on that motion
/// (inverse_dynamics.h),
///     moment = τ(without) − τ(with)
/// coordinate by coordinate; the fibres of both follow q(t). For a force it is the force itself,
/// for a mass its weight and inertia, for an error of EMG or muscle the difference of the muscles'
/// moments. motionRms compares the simulation at `values` with the one without this effect, from
/// the same initial state. An effect of the sensor has no moment; its motionRms is the RMS
/// difference between sensor and motion. What cannot be simulated without the effect is unknown.
///
/// @param candidate  index into MusculoskeletalProblem::candidates()
/// @param values     of all quantities
EffectSize effectSize(const MusculoskeletalProblem& data, std::size_t candidate,
                      const Eigen::VectorXd& values, int trial);

}  // namespace bio::discover
