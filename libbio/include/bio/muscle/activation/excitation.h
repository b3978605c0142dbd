#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

namespace bio {

/// Excitations of several muscles over time, linear between rows and constant outside.
class ExcitationSignal {
 public:
  ExcitationSignal() = default;
  /// @param times   [s], strictly rising, at least one
  /// @param values  rows = times, columns = muscles, each 0 … 1
  /// @throws std::invalid_argument sizes that differ, times not rising, a value outside 0 … 1 or
  /// NaN
  ExcitationSignal(std::vector<double> times, Eigen::MatrixXd values);

  int numMuscles() const { return static_cast<int>(values_.rows()); }
  const std::vector<double>& times() const { return times_; }

  /// All excitations at t; `out` has numMuscles() entries. `hint` speeds up evaluation at rising
  /// times: any value is allowed, it is set to the row used.
  template <class Out>
  void at(double t, std::size_t& hint, Out&& out) const {
    const std::size_t last = times_.size() - 1;
    if (!(t > times_.front())) {
      out = values_.col(0);
      return;
    }
    if (t >= times_[last]) {
      out = values_.col(static_cast<Eigen::Index>(last));
      return;
    }
    if (hint >= last || times_[hint] > t) hint = 0;
    while (times_[hint + 1] <= t) ++hint;
    const double w = (t - times_[hint]) / (times_[hint + 1] - times_[hint]);
    const auto k = static_cast<Eigen::Index>(hint);
    out = (1 - w) * values_.col(k) + w * values_.col(k + 1);
  }

 private:
  std::vector<double> times_;
  Eigen::MatrixXd values_;  ///< one column per row of the table: contiguous in time
};

}  // namespace bio
