#pragma once

// Where the next end of a motion is sought first; not public.

namespace bio::stepping {

/// Lengths of the last two parts of a motion [s].
struct PartLengths {
  double last, before;
  int count = 0;  ///< parts so far

  void add(double h) {
    before = last;
    last = h;
    ++count;
  }
};

/// Newton's divided differences over the last ends of one quantity x, and the cubic through them.
/// @tparam Values  a number or a vector
template <class Values>
struct LastEnds {
  Values velocity, velocityBefore;  ///< over the last part and the one before it
  Values third;                     ///< x‴/6 over the last three parts; 0 before there are three

  explicit LastEnds(const Values& speed)
      : velocity(speed), velocityBefore(speed), third(0 * speed) {}

  /// x after a part of length h that begins at x = now.
  void guess(double h, const PartLengths& lengths, const Values& now, Values& next) const {
    const double bend = h * (h + lengths.last) / (lengths.last + lengths.before);
    const double twist = h * (h + lengths.last) * (h + lengths.last + lengths.before);
    next = now + (h + bend) * velocity - bend * velocityBefore + twist * third;
  }

  /// x‴/6 over a part of length h from begin to end and the last two.
  void thirdUpTo(double h, const PartLengths& lengths, const Values& begin, const Values& end,
                 Values& difference) const {
    const double h1 = h + lengths.last, h2 = lengths.last + lengths.before;
    difference =
        (((end - begin) / h - velocity) / h1 - (velocity - velocityBefore) / h2) / (h + h2);
  }

  /// A part is added; `lengths` are still those of the parts before it.
  void add(double h, const PartLengths& lengths, const Values& begin, const Values& end) {
    if (lengths.count >= 2) thirdUpTo(h, lengths, begin, end, third);
    velocityBefore = velocity;
    velocity = (end - begin) / h;
  }
};

}  // namespace bio::stepping
