#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "bio/path/path.h"

namespace bio::stepping {

/// The longest step [s] at some time after the length of a path has jumped. The jump strains the
/// tendon at once, and the force that follows decays within tenths of a millisecond at first: a
/// longer step across that would be stable, but give the limb a wrong impulse (decision 071). A
/// share of a half would tie with the halves of halved steps, and rounding would decide.
/// @param time  since the jump [s]; infinite if there was none
inline double longestStepAfterJump(double time) {
  constexpr double first = 2e-5, share = 0.6;
  return std::max(first, share * time);
}

/// Where within a step a path gains or loses points. The length jumps there, so a step across it
/// would be of first order only; one that ends there is not. The secant through the last two ends,
/// at first through the start, in fractions of the step.
class SwitchSearch {
 public:
  /// Nearer to a switch than 1e-9 rad, or the tolerance of a step if that is less, counts as there.
  explicit SwitchSearch(double newtonTolerance) : onSwitch_(std::min(1e-9, newtonTolerance)) {}

  /// Whether a step between these coordinates crosses a switch that is worth ending on: the first.
  template <class Coordinates>
  bool begin(const std::vector<PathSwitch>& switches, const Coordinates& from,
             const Coordinates& to) {
    which_ = nullptr;
    fraction_ = 1;
    for (const PathSwitch& s : switches) {
      const double d0 = s.distance(from[s.freeIndex]);
      const double d1 = s.distance(to[s.freeIndex]);
      if (d0 * d1 >= 0 || std::abs(d0) < 1e-6) continue;
      if (d0 / (d0 - d1) < fraction_) {
        fraction_ = d0 / (d0 - d1);
        before_ = 0;
        distanceBefore_ = d0;
        which_ = &s;
      }
    }
    ends_ = 0;
    isNearEnd_ = which_ != nullptr && (fraction_ < worthwhile || fraction_ > 1 - worthwhile);
    return which_ != nullptr && !isNearEnd_;
  }

  /// Whether the first switch crossed is too near to the begin or the end of the step to end a part
  /// of it there: it may count as met at that end.
  bool isAtBegin() const { return isNearEnd_ && fraction_ < worthwhile; }
  bool isAtEnd() const { return isNearEnd_ && fraction_ > 1 - worthwhile; }

  /// The first that was crossed, if one was.
  const PathSwitch& which() const { return *which_; }
  /// Fraction of the whole step: how long the next one is to be.
  double fraction() const { return fraction_; }

  enum class Found { met, again, givenUp };
  /// @param q_k  the switch's coordinate at the end of the step of that length
  Found take(double q_k) {
    const double to = which_->distance(q_k);
    if (std::abs(to) < onSwitch_) return Found::met;
    const double next = fraction_ - to * (fraction_ - before_) / (to - distanceBefore_);
    before_ = fraction_;
    distanceBefore_ = to;
    fraction_ = next;
    const bool within = fraction_ > worthwhile / 10 && fraction_ < 1;
    return ++ends_ < mostEnds && within ? Found::again : Found::givenUp;
  }

 private:
  static constexpr double worthwhile = 1e-3;  ///< of the step, from either end
  static constexpr int mostEnds = 12;

  double onSwitch_;  ///< [rad] or [m]
  const PathSwitch* which_ = nullptr;
  bool isNearEnd_ = false;
  double fraction_ = 1, before_ = 0, distanceBefore_ = 0;
  int ends_ = 0;
};

}  // namespace bio::stepping
