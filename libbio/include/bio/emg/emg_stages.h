#pragma once

#include <Eigen/Dense>
#include <vector>

#include "bio/tables/recording.h"

/// The stages from raw EMG to excitation, as pure functions.
namespace bio {

/// Band of a surface EMG.
struct BandPassOptions {
  double low = 20;    ///< lower edge, −3 dB [Hz]
  double high = 450;  ///< upper edge, −3 dB [Hz]
  int order = 2;  ///< of the prototype and one pass; both passes together act like twice the order
};

/// Frequencies to remove, e.g. mains hum.
struct NotchOptions {
  std::vector<double> lines;  ///< [Hz]
  int harmonics =
      1;  ///< multiples of each line, itself included, ≥ 1; those above fs/2 are left out
  double width = 2;  ///< between the −3 dB points [Hz] > 0
  int order = 2;     ///< of the prototype and one pass
};

/// Low-pass of the rectified signal.
struct EnvelopeOptions {
  double cutoff = 6;  ///< −3 dB after both passes [Hz]
  int order = 2;      ///< of one pass
};

/// All zero-lag (filter.h), corners corrected for the two passes.
Eigen::VectorXd bandPassed(const Eigen::VectorXd& raw, double rate, const BandPassOptions& options);
Eigen::VectorXd notched(const Eigen::VectorXd& raw, double rate, const NotchOptions& options);
Eigen::VectorXd envelope(const Eigen::VectorXd& rectified, double rate,
                         const EnvelopeOptions& options);

/// The value below which `percent` of the values lie; linear between the sorted values, with the
/// smallest at 0 and the largest at 100.
/// @param percent 0 to 100
/// @throws std::domain_error outside, or for no values
double percentile(const Eigen::VectorXd& values, double percent);

struct Clipped {
  Eigen::VectorXd values;    ///< within 0 to 1
  double fractionBelow = 0;  ///< share of values that were < 0
  double fractionAbove = 0;  ///< share of values that were > 1
};
Clipped clippedToUnit(const Eigen::VectorXd& values);

/// Exponential EMG–excitation relation, (e^{A·u} − 1)/(e^A − 1); A = 0 is its limit, u itself. Maps
/// 0 to 0 and 1 to 1; a more negative A increases the excitation of weak EMG. Smooth. Source: Lloyd
/// & Besier 2003, eq. 3, range of A from there.
/// @param u 0 to 1
/// @param shape A, −3 to 0
/// @throws std::domain_error outside
double shapedExcitation(double u, double shape);

/// Values at other times: linear between samples, constant before the first and after the last.
Eigen::VectorXd sampledAt(const Eigen::VectorXd& values, double rate, double startTime,
                          const Eigen::VectorXd& times);

/// @throws std::invalid_argument naming channel, time and length of the first gap in the channel's
/// values, or that it has fewer than two samples
void checkWithoutGaps(const Channel& channel);

}  // namespace bio
