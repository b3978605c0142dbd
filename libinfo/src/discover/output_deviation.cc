#include "info/discover/output_deviation.h"

#include <cmath>
#include <stdexcept>

namespace info::discover {

using Eigen::Index;
using Eigen::VectorXd;

OutputDeviation estimateOutputDeviation(const Disagreement& data, const std::vector<int>& trials) {
  double sum = 0;
  double count = 0;
  for (const int trial : trials) {
    const auto& t = data.times(trial);
    const VectorXd& y = data.measured(trial);
    for (std::size_t k = 3; k < t.size(); ++k) {
      const double step = t[k] - t[k - 1];
      if (std::abs(t[k - 1] - t[k - 2] - step) > 1e-3 * step ||
          std::abs(t[k - 2] - t[k - 3] - step) > 1e-3 * step)
        continue;
      const auto i = static_cast<Index>(k);
      const double third = y[i] - 3 * y[i - 1] + 3 * y[i - 2] - y[i - 3];
      sum += third * third;
      ++count;
    }
  }
  if (!(sum > 0))
    throw std::invalid_argument(
        "output deviation: there must be four equally spaced samples that are not on a parabola");
  // third differences of white noise have variance 20σ², and autocorrelations −15, 6, −1 of 20
  return {std::sqrt(sum / (20 * count)), std::sqrt(2 * (1 + 2 * 262.0 / 400.0) / count)};
}

}  // namespace info::discover
