#pragma once

#include <Eigen/Dense>

#include "report/report.h"

namespace app {

/// Contour lines over a rectangular grid with `heights` at (x_i, y_j): pieces in any order,
/// separated by NaN. Marching squares with linear interpolation; cells with a height that is not
/// finite are left out.
/// @throws std::invalid_argument unless heights is x.size() × y.size(), both ≥ 2
Series isolines(const std::string& name, const std::vector<double>& x, const std::vector<double>& y,
                const Eigen::MatrixXd& heights, const std::vector<double>& levels);

}  // namespace app
