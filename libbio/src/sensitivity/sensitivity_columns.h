#pragma once

// The columns of a run's sensitivities; not public.

#include <algorithm>

#include "bio/sensitivity/coupled_sensitivity.h"

namespace bio::stepping {

/// One column per parameter. Behind them stands one more: in it, at a switch of a path, runs the
/// derivative in the time of the switch. Behind it stand the nodes of an external force, each of
/// which is 0, and has no column, until its hat begins.
class SensitivityColumns {
 public:
  using Index = Eigen::Index;

  SensitivityColumns(Index numParameters, const ExternalNodes& nodes)
      : numParameters_(numParameters), nodes_(&nodes) {}

  Index numParameters() const { return numParameters_; }
  Index ofTime() const { return numParameters_; }
  Index count() const { return numParameters_ + 1 + numBegun(); }
  /// Nodes that have columns, the last ones.
  Index numBegun() const { return static_cast<Index>(begun_); }
  const ExternalNodes& nodes() const { return *nodes_; }

  /// Takes in every node whose hat has begun before t. @return whether there are columns more
  bool beginNodes(double t) {
    const std::vector<double>& times = nodes_->times;
    std::size_t begun = begun_;
    while (begun < times.size() && times[begun == 0 ? 0 : begun - 1] < t) ++begun;
    if (begun == begun_) return false;
    constexpr std::size_t together = 8;  // rather than one by one
    begun_ = std::min(times.size(), (begun + together - 1) / together * together);
    return true;
  }

  /// Gives rows all columns there are; the new ones are 0.
  template <class RowsOf>
  void widen(RowsOf& rows) const {
    const Index before = rows.cols();
    if (before == count()) return;
    rows.conservativeResize(Eigen::NoChange, count());
    rows.rightCols(count() - before).setZero();
  }

  /// Adds ∂f/∂d of the nodes between which t lies to the force's rows.
  template <class Rows>
  void addNodes(double t, Rows& force) {
    const std::vector<double>& times = nodes_->times;
    if (times.empty() || t < times.front() || t > times.back()) return;
    while (node_ + 2 < times.size() && times[node_ + 1] <= t) ++node_;
    while (node_ > 0 && times[node_] > t) --node_;
    const Index first = numParameters_ + 1 + static_cast<Index>(node_);
    const double w = (t - times[node_]) / (times[node_ + 1] - times[node_]);
    force(nodes_->coordinate, first) += 1 - w;
    force(nodes_->coordinate, first + 1) += w;
  }

  /// See SensitivityState::moveAlong.
  template <class RowsOf>
  void moveAlong(RowsOf& rows, const Eigen::RowVectorXd& dt) const {
    for (Index r = 0; r < rows.rows(); ++r) {
      const double rate = rows(r, ofTime());
      rows.row(r) += rate * dt;
      rows(r, ofTime()) = 0;
    }
  }

 private:
  Index numParameters_;
  const ExternalNodes* nodes_;
  std::size_t begun_ = 0;
  std::size_t node_ = 0;  ///< before the time reached
};

}  // namespace bio::stepping
