#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "bio/simulation/musculoskeletal_system.h"
#include "simulation/switch_crossing.h"

namespace bio::stepping {

/// Looks at both sides of a switch. Allocates nothing after its construction.
template <int N>
class SwitchSides {
 public:
  using Vector = typename SystemConfiguration<N>::Vector;

  explicit SwitchSides(const MusculoskeletalSystem& system)
      : configuration_(system), lengths_(system.numPaths()) {}

  /// Whether a length jumps by more than 1e-5 m there. @param q  on the switch
  bool lengthJumps(const PathSwitch& met, const Vector& q) {
    configuration_.moveTo(beyondSwitch(met, q, 1));
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      lengths_[i] = configuration_.length(i).length;
    }
    configuration_.moveTo(beyondSwitch(met, q, -1));
    double largest = 0;
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      largest = std::max(largest, std::abs(configuration_.length(i).length - lengths_[i]));
    }
    return largest > noticeable;
  }
  /// Whether a length jumps at a switch that a step from q to qEnd crosses.
  bool lengthJumps(const PathSwitch& crossed, const Vector& q, const Vector& qEnd) {
    const double before = crossed.distance(q[crossed.freeIndex]);
    const double after = crossed.distance(qEnd[crossed.freeIndex]);
    Vector on = q;
    crossingOf(1, before, before, after, [&](double x) {
      on = q + x * (qEnd - q);
      return crossed.distance(on[crossed.freeIndex]);
    });
    return lengthJumps(crossed, on);
  }

 private:
  static constexpr double noticeable = 1e-5;  ///< [m]

  SystemConfiguration<N> configuration_;
  std::vector<double> lengths_;
};

}  // namespace bio::stepping
