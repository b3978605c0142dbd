#pragma once

// How the times of a run's steps follow parameters; not public.

#include "sensitivity/sensitivity_columns.h"
#include "simulation/step_tape.h"

namespace bio::stepping {

/// dt/dθ of the tape's times: 0 for rows of the output, the mean of two times for a middle, and
/// what the pass has found for a switch.
class TapeSlopes {
 public:
  using Row = Eigen::RowVectorXd;

  explicit TapeSlopes(const StepTape& tape) : tape_(&tape), slopes_(tape.times().size()) {}

  /// Slope of one of the tape's times; null: fixed.
  const Row* of(std::size_t index, const SensitivityColumns& columns) {
    const StepTape::Time& time = tape_->times()[index];
    Row& slope = slopes_[index];
    if (slope.size()) columns.widen(slope);
    if (time.law == StepTape::Time::Law::middle && slope.size() == 0) {
      const Row* a = of(time.first, columns);
      const Row* b = of(time.second, columns);
      if (a && b) slope = (*a + *b) / 2;
      if (a && !b) slope = *a / 2;
      if (!a && b) slope = *b / 2;
    }
    return slope.size() ? &slope : nullptr;
  }

  /// Slope of the time of a switch.
  Row& found(std::size_t index) { return slopes_[index]; }

 private:
  const StepTape* tape_;
  std::vector<Row> slopes_;  ///< empty: fixed, or not asked for yet
};

}  // namespace bio::stepping
