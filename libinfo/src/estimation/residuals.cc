#include "info/estimation/residuals.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace info {

using Eigen::Index;
using Eigen::VectorXd;

std::vector<double> autocorrelation(const std::vector<VectorXd>& series, Index maxLag) {
  Index n = 0;
  double power = 0;
  for (const VectorXd& r : series) {
    n += r.size();
    power += r.squaredNorm();
  }
  if (n == 0 || !(power > 0)) {
    throw std::invalid_argument("autocorrelation: at least one residual must differ from 0");
  }
  std::vector<double> rho;
  for (Index lag = 0; lag <= maxLag; ++lag) {
    double sum = 0;
    Index pairs = 0;
    for (const VectorXd& r : series) {
      const Index count = r.size() - lag;
      if (count <= 0) continue;
      sum += r.head(count).dot(r.tail(count));
      pairs += count;
    }
    if (pairs == 0) break;
    rho.push_back(sum / static_cast<double>(pairs) * static_cast<double>(n) / power);
  }
  return rho;
}

double autocorrelationTime(const std::vector<double>& rho, Index samples) {
  const double noise = 2 / std::sqrt(static_cast<double>(samples));
  double time = 1;
  for (std::size_t lag = 1; lag < rho.size() && rho[lag] > noise; ++lag) time += 2 * rho[lag];
  return time;
}

double robustSd(const VectorXd& residuals) {
  if (residuals.size() == 0)
    throw std::invalid_argument("robust standard deviation: must have at least one residual");
  std::vector<double> sizes(static_cast<std::size_t>(residuals.size()));
  VectorXd::Map(sizes.data(), residuals.size()) = residuals.cwiseAbs();
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  double median = *middle;
  if (sizes.size() % 2 == 0) median = 0.5 * (median + *std::max_element(sizes.begin(), middle));
  return 1.482602218505602 * median;
}

}  // namespace info
