#pragma once

// The columns of a run's sensitivities; not public.

#include <algorithm>

#include "bio/sensitivity/coupled_sensitivity.h"

namespace bio::stepping {

/// One column per parameter. Behind them stands one more: in it, at a switch of a path, runs the
/// derivative in the time of the switch. Behind it stand the nodes of external forces, time by time
/// and at one time coordinate by coordinate; each is 0, and has no column, until its hat begins.
class SensitivityColumns {
 public:
  using Index = Eigen::Index;

  SensitivityColumns(Index numParameters, const SensitivityOptions& options)
      : numParameters_(numParameters),
        nodes_(&options.externalNodes),
        slopes_(&options.externalSlopes),
        perTime_(static_cast<Index>(nodes_->coordinates.size())) {}

  Index numParameters() const { return numParameters_; }
  Index ofTime() const { return numParameters_; }
  Index count() const { return numParameters_ + 1 + static_cast<Index>(begun_) * perTime_; }
  /// Columns of the result: parameters and all nodes.
  Index numRecorded() const { return numParameters_ + nodes_->count(); }
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

  /// A row of count() columns into one of numRecorded(): first all nodes of the first coordinate.
  template <class From, class To>
  void record(const From& row, To&& recorded) const {
    recorded.head(numParameters_) = row.head(numParameters_);
    const auto begun = static_cast<Index>(begun_), all = static_cast<Index>(nodes_->times.size());
    for (Index c = 0; c < perTime_; ++c) {
      auto nodes = recorded.segment(numParameters_ + c * all, all);
      for (Index k = 0; k < begun; ++k) nodes[k] = row[numParameters_ + 1 + k * perTime_ + c];
      nodes.tail(all - begun).setZero();
    }
  }

  /// Adds ∂f/∂d of the nodes between which t lies, and the slopes of the external force, to the
  /// force's rows.
  template <class Rows>
  void addExternal(double t, Rows& force) const {
    for (const ExternalSlope& slope : *slopes_)
      force(slope.coordinate, slope.column) += slope.at(t);
    addNodes(t, force);
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
  template <class Rows>
  void addNodes(double t, Rows& force) const {
    const std::vector<double>& times = nodes_->times;
    if (times.empty() || t < times.front() || t > times.back()) return;
    while (node_ + 2 < times.size() && times[node_ + 1] <= t) ++node_;
    while (node_ > 0 && times[node_] > t) --node_;
    const Index first = numParameters_ + 1 + static_cast<Index>(node_) * perTime_;
    const double w = (t - times[node_]) / (times[node_ + 1] - times[node_]);
    for (Index c = 0; c < perTime_; ++c) {
      const int coordinate = nodes_->coordinates[static_cast<std::size_t>(c)];
      force(coordinate, first + c) += 1 - w;
      if (w > 0) force(coordinate, first + perTime_ + c) += w;  // else it may have no column yet
    }
  }

  Index numParameters_;
  const ExternalNodes* nodes_;
  const std::vector<ExternalSlope>* slopes_;
  Index perTime_;                 ///< nodes at one time
  std::size_t begun_ = 0;         ///< times whose nodes have columns
  mutable std::size_t node_ = 0;  ///< before the time reached
};

}  // namespace bio::stepping
