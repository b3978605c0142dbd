#include "bio/muscle/activation/excitation.h"

#include <fmt/format.h>

#include <stdexcept>

namespace bio {

ExcitationSignal::ExcitationSignal(std::vector<double> times, Eigen::MatrixXd values)
    : times_(std::move(times)), values_(values.transpose()) {
  if (times_.empty() || static_cast<Eigen::Index>(times_.size()) != values_.cols()) {
    throw std::invalid_argument(fmt::format(
        "excitations: {} times and {} rows, must agree and be ≥ 1", times_.size(), values_.cols()));
  }
  for (std::size_t k = 0; k < times_.size(); ++k) {
    if (!std::isfinite(times_[k]) || (k > 0 && !(times_[k] > times_[k - 1]))) {
      throw std::invalid_argument(fmt::format(
          "excitations: time = {} s in row {}, must be finite and rise", times_[k], k + 1));
    }
  }
  for (Eigen::Index k = 0; k < values_.cols(); ++k) {
    for (Eigen::Index i = 0; i < values_.rows(); ++i) {
      const double u = values_(i, k);
      if (!(u >= 0 && u <= 1)) {
        throw std::invalid_argument(
            fmt::format("excitations: {} at time {} s (column {}), must be 0 to 1", u,
                        times_[static_cast<std::size_t>(k)], i + 1));
      }
    }
  }
}

}  // namespace bio
