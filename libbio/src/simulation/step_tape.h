#pragma once

// What the variational integrator took down of a run, for its sensitivities; not public.

#include <vector>

#include "simulation/integrators.h"

namespace bio::stepping {

/// A time at which a part of a step begins or ends, and its place on the tape.
struct TimeMark {
  double value = 0;  ///< [s]
  std::size_t index = 0;
};

/// Every part of a step that was accepted, and why it ended where it did.
class StepTape {
 public:
  using Values = const Eigen::Ref<const Eigen::VectorXd>&;

  /// Why a time is what it is: a row of the output is fixed, a switch of a path is met where a
  /// coordinate reaches a value, the middle of two times follows both.
  struct Time {
    enum class Law { row, onSwitch, middle } law = Law::row;
    double value = 0;                   ///< [s]
    const PathSwitch* met = nullptr;    ///< onSwitch; of the system
    std::size_t first = 0, second = 0;  ///< middle: of which times
  };
  /// A step or part of one; its states are columns of the tape, the first one is the start's.
  struct Part {
    std::size_t begin = 0, end = 0;  ///< of times()
    bool endsRow = false;
  };

  /// @param steps  about as many parts follow
  void begin(Values q, Values fibreLength, Values activation, std::size_t steps = 0) {
    numCoordinates_ = q.size();
    numMuscles_ = fibreLength.size();
    states_.reserve((steps + 1) * static_cast<std::size_t>(numCoordinates_ + 3 * numMuscles_));
    append(q, fibreLength, activation, activation);
  }
  std::size_t addRow(double value) { return addTime({Time::Law::row, value, nullptr, 0, 0}); }
  std::size_t addSwitch(double value, const PathSwitch& met) {
    return addTime({Time::Law::onSwitch, value, &met, 0, 0});
  }
  std::size_t addMiddle(double value, std::size_t first, std::size_t second) {
    return addTime({Time::Law::middle, value, nullptr, first, second});
  }
  void add(std::size_t begin, std::size_t end, Values q, Values fibreLength,
           Values middleActivation, Values endActivation) {
    parts_.push_back({begin, end, false});
    append(q, fibreLength, middleActivation, endActivation);
  }
  void endRow() { parts_.back().endsRow = true; }

  const std::vector<Time>& times() const { return times_; }
  const std::vector<Part>& parts() const { return parts_; }

  /// States at the end of a part; column 0 is the start, part i ends at column i + 1.
  auto q(std::size_t column) const { return view(column, 0, numCoordinates_); }
  auto fibreLength(std::size_t column) const { return view(column, numCoordinates_, numMuscles_); }
  /// At the middle of the part that ends there.
  auto middleActivation(std::size_t column) const {
    return view(column, numCoordinates_ + numMuscles_, numMuscles_);
  }
  auto activation(std::size_t column) const {
    return view(column, numCoordinates_ + 2 * numMuscles_, numMuscles_);
  }

 private:
  std::size_t addTime(const Time& time) {
    times_.push_back(time);
    return times_.size() - 1;
  }
  void append(Values q, Values fibreLength, Values middle, Values end) {
    for (const auto* values : {&q, &fibreLength, &middle, &end}) {
      states_.insert(states_.end(), values->data(), values->data() + values->size());
    }
  }
  Eigen::Map<const Eigen::VectorXd> view(std::size_t column, Eigen::Index from,
                                         Eigen::Index size) const {
    const Eigen::Index stride = numCoordinates_ + 3 * numMuscles_;
    return {states_.data() + static_cast<Eigen::Index>(column) * stride + from, size};
  }

  Eigen::Index numCoordinates_ = 0, numMuscles_ = 0;
  std::vector<Time> times_;
  std::vector<Part> parts_;
  std::vector<double> states_;
};

}  // namespace bio::stepping
