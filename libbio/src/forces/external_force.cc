#include "bio/forces/external_force.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "info/dynamics/linear_table.h"

namespace bio {

ExternalForce::ExternalForce(std::vector<double> times, Eigen::MatrixXd values,
                             std::vector<Control> controls)
    : times_(std::move(times)), values_(values.transpose()), controls_(std::move(controls)) {
  if (times_.empty() || static_cast<Eigen::Index>(times_.size()) != values_.cols()) {
    throw std::invalid_argument(
        fmt::format("external force: {} times and {} rows, must agree and be ≥ 1", times_.size(),
                    values_.cols()));
  }
  for (std::size_t k = 0; k < times_.size(); ++k) {
    if (!std::isfinite(times_[k]) || (k > 0 && !(times_[k] > times_[k - 1]))) {
      throw std::invalid_argument(fmt::format(
          "external force: time = {} s in row {}, must be finite and rise", times_[k], k + 1));
    }
  }
  for (Eigen::Index k = 0; k < values_.cols(); ++k) {
    for (Eigen::Index i = 0; i < values_.rows(); ++i) {
      if (!std::isfinite(values_(i, k))) {
        throw std::invalid_argument(
            fmt::format("external force: {} at time {} s (column {}), must be finite",
                        values_(i, k), times_[static_cast<std::size_t>(k)], i + 1));
      }
    }
  }
}

ExternalForce::At ExternalForce::at(double t) const {
  At result{Eigen::VectorXd::Zero(values_.rows()), Eigen::VectorXd::Zero(values_.rows())};
  std::size_t hint = 0;
  add(t, hint, result.value);
  if (empty() || t < times_.front() || t >= times_.back()) return result;
  const auto k = static_cast<Eigen::Index>(hint);
  result.slope = (values_.col(k + 1) - values_.col(k)) / (times_[hint + 1] - times_[hint]);
  return result;
}

double ExternalForce::Control::at(double t) const {
  if (times.empty() || t < times.front() || t > times.back()) return 0;
  return info::linearAt(times, t).value(values);
}

double ExternalForce::controlAt(const std::string& actuator, double t) const {
  double control = 0;
  for (const Control& one : controls_) {
    if (one.actuator == actuator) control += one.at(t);
  }
  return control;
}

ExternalForce ExternalForce::withOptimalForces(const std::map<std::string, double>& forces) const {
  ExternalForce result = *this;
  for (std::size_t i = 0; i < controls_.size(); ++i) {
    const Control& control = controls_[i];
    const auto at = forces.find(control.actuator);
    if (at == forces.end() || at->second == control.optimalForce) continue;
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(control.values.size(), numCoordinates());
    change.col(control.coordinate) = (at->second - control.optimalForce) * control.values;
    result = sum(result, {control.times, std::move(change)});
    result.controls_[i].optimalForce = at->second;
  }
  return result;
}

ExternalForce sum(const ExternalForce& force, const ExternalForce& other) {
  if (force.empty()) return other;
  if (other.empty()) return force;
  std::vector<double> times;
  std::set_union(force.times().begin(), force.times().end(), other.times().begin(),
                 other.times().end(), std::back_inserter(times));
  Eigen::MatrixXd values(static_cast<Eigen::Index>(times.size()), force.numCoordinates());
  for (std::size_t k = 0; k < times.size(); ++k) {
    values.row(static_cast<Eigen::Index>(k)) =
        (force.at(times[k]).value + other.at(times[k]).value).transpose();
  }
  std::vector<ExternalForce::Control> controls = force.controls();
  controls.insert(controls.end(), other.controls().begin(), other.controls().end());
  return {std::move(times), values, std::move(controls)};
}

}  // namespace bio
