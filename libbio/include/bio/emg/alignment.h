#pragma once

#include <limits>

#include "bio/tables/recording.h"

namespace bio {

/// How the clock of one recording is found on another's.
struct AlignmentOptions {
  double within = std::numeric_limits<double>::infinity();  ///< |offset| looked for [s] > 0
};

struct Alignment {
  double offset = 0;       ///< time of the reference = the other's time + offset [s]
  double correlation = 0;  ///< at this offset, below 0: one shows the event upside down
  double rival = 0;        ///< largest |correlation| at an offset outside the peak
  double overlap = 0;      ///< [s]
};

/// The offset at which two channels that show the same event correlate best.
///
/// Both are brought to the lower of their rates (low-pass at 0.4 of it before), gaps bridged by
/// straight lines. At every lag for which the signals overlap by half of the shorter or more, the
/// correlation of the overlapping parts is taken, each without its own mean; a parabola through the
/// largest |r| and its neighbours gives the offset between samples.
/// @throws std::invalid_argument naming the channels for one value throughout, no overlap within
///   the range, |r| < 0.5 at best, or a rival above 0.95 of it
Alignment alignmentOf(const Channel& reference, const Channel& other,
                      const AlignmentOptions& options = {});

/// Samples of a channel at another rate from its own start on; a channel that is faster passes a
/// zero-lag Butterworth low-pass of order 6 at 0.4·rate first, so that nothing is folded back.
/// Gaps are bridged by straight lines.
Eigen::VectorXd resampled(const Channel& channel, double rate);

}  // namespace bio
