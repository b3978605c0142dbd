#pragma once

// Activations of a run and their derivatives from step to step; not public.

#include "sensitivity/excitation_sensitivity.h"
#include "sensitivity/sensitivity_columns.h"

namespace bio::stepping {

/// d(activation)/dθ at the end and at the middle of a step. Few parameters reach activations while
/// times are fixed: only theirs are stored, until a time moves and takes all along.
class ActivationColumns {
 public:
  using Index = Eigen::Index;

  explicit ActivationColumns(ExcitationSensitivity excitation, Index numMuscles)
      : excitation_(std::move(excitation)) {
    end_.setZero(numMuscles, static_cast<Index>(excitation_.columns().size()));
    middle_ = end_;
  }

  void start(double time) { excitation_.start(time, end_); }

  SensitivityMatrix& end() { return end_; }
  const SensitivityMatrix& end() const { return end_; }
  const SensitivityMatrix& middle() const { return middle_; }

  /// Over a step, whose times' derivatives are rows or null (fixed).
  struct StepTime {
    double value;
    const Eigen::RowVectorXd* slope;
  };
  template <class Activation>
  void advance(const StepTime& begin, const StepTime& middle, const StepTime& end,
               const Activation& atBegin, const Activation& atMiddle) {
    excitation_.advance(begin.value, middle.value, begin.slope, middle.slope, atBegin, end_,
                        middle_);
    excitation_.advance(middle.value, end.value, middle.slope, end.slope, atMiddle, middle_, end_);
  }

  /// Adds factor·∂a/∂θ of a muscle, from end() or middle(), to a row with a column for every θ.
  template <class Row>
  void add(double factor, const SensitivityMatrix& activation, Index muscle, Row&& row) const {
    if (excitation_.isSpread()) {
      row += factor * activation.row(muscle);
      return;
    }
    const std::vector<Index>& columns = excitation_.columns();
    for (std::size_t j = 0; j < columns.size(); ++j) {
      row[columns[j]] += factor * activation(muscle, static_cast<Index>(j));
    }
  }
  /// ∂a/∂θ of a muscle at the end into a row with a column for every parameter.
  template <class Row>
  void record(Index muscle, Row&& row) const {
    row.setZero();
    if (excitation_.isSpread()) {
      row = end_.row(muscle).head(row.size());
    } else {
      add(1, end_, muscle, row);
    }
  }

  /// A column for every θ, since a time moves.
  void spread(const SensitivityColumns& columns) {
    if (excitation_.isSpread()) return;
    SensitivityMatrix all = SensitivityMatrix::Zero(end_.rows(), columns.count());
    for (std::size_t j = 0; j < excitation_.columns().size(); ++j) {
      all.col(excitation_.columns()[j]) = end_.col(static_cast<Index>(j));
    }
    middle_.setZero(end_.rows(), columns.count());
    end_ = std::move(all);
    excitation_.spread();
  }
  void widen(const SensitivityColumns& columns) {
    if (!excitation_.isSpread()) return;
    for (SensitivityMatrix* rows : {&end_, &middle_}) columns.widen(*rows);
  }

 private:
  ExcitationSensitivity excitation_;
  SensitivityMatrix end_, middle_;
};

}  // namespace bio::stepping
