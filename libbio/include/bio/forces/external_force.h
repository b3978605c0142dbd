#pragma once

#include <Eigen/Dense>
#include <map>
#include <string>
#include <vector>

namespace bio {

/// External generalised forces on the free coordinates, e.g. of a dynamometer or an exoskeleton:
/// linear between rows, 0 before the first and after the last row.
class ExternalForce {
 public:
  /// No force: no rows, no coordinates.
  ExternalForce() = default;
  /// The control of a CoordinateActuator: linear between its times and 0 outside them;
  /// optimalForce·control is part of the values.
  struct Control {
    std::string actuator;
    int coordinate = 0;         ///< free index
    double optimalForce = 1;    ///< [N·m] or [N]
    std::vector<double> times;  ///< [s] strictly rising
    Eigen::VectorXd values;     ///< as many
    double at(double t) const;
  };
  /// @param times   [s], strictly rising, at least one
  /// @param values  rows = times, columns = free coordinates [N·m] or [N], finite; positive pushes
  ///   the coordinate up
  /// @param controls  whose forces are part of the values
  /// @throws std::invalid_argument sizes that differ, times not rising, a value that is not finite
  ExternalForce(std::vector<double> times, Eigen::MatrixXd values,
                std::vector<Control> controls = {});

  const std::vector<Control>& controls() const { return controls_; }
  /// The control of an actuator at time t; 0 if there is none of that name.
  double controlAt(const std::string& actuator, double t) const;
  /// This force with other optimal forces [N·m] or [N], by actuator; those not named stay.
  ExternalForce withOptimalForces(const std::map<std::string, double>& forces) const;

  bool empty() const { return times_.empty(); }
  int numCoordinates() const { return static_cast<int>(values_.rows()); }
  const std::vector<double>& times() const { return times_; }

  /// Value and slope at time t.
  struct At {
    Eigen::VectorXd value;  ///< [N·m] or [N]
    Eigen::VectorXd slope;  ///< [unit of the force per s]; at a row, of the line that begins there
  };
  At at(double t) const;

  /// Adds the forces at t to `force` (numCoordinates() entries); nothing if empty. `hint` speeds up
  /// evaluation at rising times: any value is allowed, it is set to the row used.
  template <class Force>
  void add(double t, std::size_t& hint, Force& force) const {
    if (empty() || t < times_.front() || t > times_.back()) return;
    const std::size_t last = times_.size() - 1;
    if (t >= times_[last]) {
      force += values_.col(static_cast<Eigen::Index>(last));
      return;
    }
    if (hint >= last || times_[hint] > t) hint = 0;
    while (times_[hint + 1] <= t) ++hint;
    const double w = (t - times_[hint]) / (times_[hint + 1] - times_[hint]);
    const auto k = static_cast<Eigen::Index>(hint);
    force += (1 - w) * values_.col(k) + w * values_.col(k + 1);
  }

 private:
  std::vector<double> times_;
  Eigen::MatrixXd values_;  ///< one column per row of the table: contiguous in time
  std::vector<Control> controls_;
};

/// The sum of both forces, with rows at the times of either; both act on the same coordinates.
ExternalForce sum(const ExternalForce& force, const ExternalForce& other);

}  // namespace bio
