#pragma once

#include <Eigen/Dense>

namespace bio {

/// Gaps (NaN) replaced by straight lines, held at the ends.
Eigen::VectorXd bridged(const Eigen::VectorXd& x);

}  // namespace bio
