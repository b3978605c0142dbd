#pragma once

#include <Eigen/Dense>
#include <vector>

#include "bio/observation/observed_motion.h"
#include "bio/sensitivity/cost_gradient.h"

namespace bio {

/// J = ½ Σ ((y_i − m_i)/σ_i)² over measured samples m of observables y at any times.
/// @param series    coordinates, their speeds or markers, between the rows as ObservedMotion has it
/// @param measured  m, series after series, in unitOf()
/// @param sd        σ > 0, as many
/// @throws std::invalid_argument sizes that differ; σ not above 0; a measured value that is not
///   finite; fibre lengths, tendon forces, activations and moments, whose costs have no adjoint
MotionCost leastSquaresCost(const MusculoskeletalSystem& system, std::vector<ObservedSeries> series,
                            Eigen::VectorXd measured, Eigen::VectorXd sd);

}  // namespace bio
