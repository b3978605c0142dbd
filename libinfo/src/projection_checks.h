#pragma once

#include <Eigen/Dense>
#include <vector>

#include "info/trajectory_search.h"

/// Rules that both projections check; each throws with quantity, value and rule.
namespace info::detail {

/// Fills an empty weight with zeros, unless it must be definite.
void fillWeight(const char* name, Eigen::MatrixXd& W, Eigen::Index size, bool definite);

/// Σ⁻¹. @throws std::domain_error unless Σ is symmetric and positive definite
Eigen::MatrixXd inverseCovariance(const Eigen::MatrixXd& covariance, Eigen::Index outputs);

void checkInputs(const char* name, const std::vector<Eigen::VectorXd>& inputs, std::size_t count,
                 Eigen::Index size);

/// lower < upper for each input, weight > 0.
void checkLimits(const InputLimits& limits, Eigen::Index inputs);

}  // namespace info::detail
