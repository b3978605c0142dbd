#include "info/estimation/convergence.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace info {

std::vector<ConvergenceRow> convergenceTable(const Estimate& estimate,
                                             const Eigen::VectorXd& minimum) {
  const Eigen::VectorXd unit = (minimum.array() == 0).select(1.0, minimum.cwiseAbs());
  const double undefined = std::numeric_limits<double>::quiet_NaN();
  std::vector<ConvergenceRow> rows;
  for (std::size_t k = 0; k < estimate.parameterHistory.size(); ++k) {
    if (estimate.parameterHistory[k].size() != minimum.size())
      throw std::invalid_argument(
          "convergence table: estimate and minimum must have the same size");
    const double error = (estimate.parameterHistory[k] - minimum).cwiseQuotient(unit).norm();
    rows.push_back({static_cast<int>(k), estimate.costHistory[k], error, undefined, undefined});
    if (k > 0 && rows[k - 1].error > 0) rows[k].ratio = error / rows[k - 1].error;
    if (k > 1 && error > 0 && rows[k - 1].ratio > 0 && rows[k - 1].ratio < 1)
      rows[k].order = std::log(rows[k].ratio) / std::log(rows[k - 1].ratio);
  }
  return rows;
}

}  // namespace info
