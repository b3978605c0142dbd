#pragma once

// Where the next end of a motion is sought first; not public.

namespace bio::stepping {

/// Weights of Newton's divided differences in the guess of what follows; 0: it stays where it is.
struct GuessWeights {
  double velocity = 0, before = 0, third = 0;

  /// x at the end of the next part, of a number or a vector.
  template <class X>
  auto guess(const X& now, const X& meanVelocity, const X& meanVelocityBefore,
             const X& thirdDifference) const {
    return now + velocity * meanVelocity - before * meanVelocityBefore + third * thirdDifference;
  }
};

/// Lengths of the last two parts of a motion [s].
struct PartLengths {
  double last, before;
  int count = 0;  ///< parts so far

  /// Weights that give the cubic through the last four ends, for a part of length h.
  GuessWeights weights(double h) const {
    const double bend = h * (h + last) / (last + before);
    return {h + bend, bend, h * (h + last) * (h + last + before)};
  }
  void add(double h) {
    before = last;
    last = h;
    ++count;
  }
};

/// Newton's divided differences over the last ends of one quantity x.
/// @tparam Values  a number or a vector
template <class Values>
struct LastEnds {
  Values velocity, velocityBefore;  ///< over the last part and the one before it
  Values third;                     ///< x‴/6 over the last three parts; 0 before there are three

  explicit LastEnds(const Values& speed)
      : velocity(speed), velocityBefore(speed), third(0 * speed) {}

  /// To be used at once: of a vector it is an expression that refers to its arguments.
  auto guess(const GuessWeights& weights, const Values& now) const {
    return weights.guess(now, velocity, velocityBefore, third);
  }

  /// x‴/6 over a part of length h from begin to end and the last two.
  void thirdUpTo(double h, const PartLengths& lengths, const Values& begin, const Values& end,
                 Values& difference) const {
    const double before = lengths.last + lengths.before;
    const double one = 1 / ((h + lengths.last) * (h + before)), other = 1 / (before * (h + before));
    difference = one / h * (end - begin) - (one + other) * velocity + other * velocityBefore;
  }

  /// A part is added; `lengths` are still those of the parts before it.
  void add(double h, const PartLengths& lengths, const Values& begin, const Values& end) {
    if (lengths.count >= 2) thirdUpTo(h, lengths, begin, end, third);
    velocityBefore = velocity;
    velocity = (end - begin) / h;
  }
};

}  // namespace bio::stepping
