#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "bio/path/path.h"

namespace bio::stepping {

// Between two switches the integrators of the first-order form hold the paths' conditional points,
// so that no stage or trial step sees a length beyond a jump; they end a step on the jump and hold
// those of its other side from there on.

/// A configuration on the other side of a switch that the system has come to: q but for 1e-7 of one
/// coordinate.
/// @param before  the sign of PathSwitch::distance on the side that the system comes from
template <class Coordinates>
Coordinates beyondSwitch(const PathSwitch& met, Coordinates q, double before) {
  const double at = q[met.freeIndex];
  for (const double by : {1e-7, -1e-7}) {
    q[met.freeIndex] = at + by;
    if (met.distance(at + by) * before < 0) return q;
  }
  q[met.freeIndex] = at;
  return q;
}

/// The switch that a motion from q to qEnd crosses first, as a straight line would; null if none.
/// @param held  where the conditional points are those of the motion's start
template <class Held, class Coordinates>
const PathSwitch* firstCrossed(const std::vector<PathSwitch>& switches, const Held& held,
                               const Coordinates& q, const Coordinates& qEnd) {
  const PathSwitch* first = nullptr;
  double earliest = 2;
  for (const PathSwitch& s : switches) {
    const double before = s.distance(held[s.freeIndex]);
    const double after = s.distance(qEnd[s.freeIndex]);
    if (!(before * after < 0)) continue;
    const double start = s.distance(q[s.freeIndex]);
    const double fraction = start * before > 0 ? start / (start - after) : 0;
    if (fraction < earliest) {
      earliest = fraction;
      first = &s;
    }
  }
  return first;
}

/// The x in [0, end] at which a function that starts with the sign of `before` changes it: false
/// position with halving, to the last bits.
/// @param value  called at least once, last at the x returned
template <class Value>
double crossingOf(double end, double before, double atStart, double atEnd, const Value& value) {
  double low = 0, high = end, fLow = atStart, fHigh = atEnd;
  double x = end;
  for (int i = 0; i < 60; ++i) {
    const bool bracketed = fLow * before > 0 && i % 3 != 2;
    x = bracketed ? low + (high - low) * fLow / (fLow - fHigh) : low + (high - low) / 2;
    const double f = value(x);
    if (f == 0 || std::abs(f) < 1e-14) return x;
    if (f * before > 0) {
      low = x, fLow = f;
    } else {
      high = x, fHigh = f;
    }
    if (high - low <= 1e-16 * end) break;
  }
  return x;
}

/// So many switches within one step are a path that cannot decide: the step is taken as it is.
inline constexpr int mostSwitchesInAStep = 50;

}  // namespace bio::stepping
