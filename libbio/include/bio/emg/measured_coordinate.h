#pragma once

#include <Eigen/Dense>
#include <limits>
#include <optional>
#include <string>

#include "bio/tables/recording.h"

namespace bio {

/// Conversion of a channel to the measured angle of a coordinate,
///     angle = sign · degreesPerUnit · (value − zero)
/// Values at or beyond a limit of the instrument are clipped and count as not measured.
struct MeasuredOptions {
  std::string channel;
  std::string coordinate = "elbow_flexion";
  double degreesPerUnit = 1;  ///< [deg per unit of the channel] > 0
  double sign = 1;            ///< +1 or −1
  double zero = 0;            ///< reading at 0°, in the channel's unit
  double clipBelow = -std::numeric_limits<double>::infinity();  ///< values ≤ this are not measured
  double clipAbove = std::numeric_limits<double>::infinity();  ///< values ≥ this are not measured
  std::optional<double> lowPass;  ///< zero-lag Butterworth, −3 dB at this [Hz]
  int lowPassOrder = 2;           ///< of one pass
};

struct MeasuredCoordinate {
  std::string coordinate;
  double rate = 0;            ///< [Hz]
  double startTime = 0;       ///< [s]
  Eigen::VectorXd angle_deg;  ///< NaN: not measured
  double notMeasured = 0;     ///< share of samples
};

/// The low-pass filter interpolates gaps linearly; they still count as not measured afterwards.
/// @throws std::invalid_argument for a factor ≤ 0, a sign other than ±1, limits in the wrong order,
/// or nothing measured
MeasuredCoordinate measuredCoordinate(const Channel& channel, const MeasuredOptions& options);

/// The angle [deg] at the rows of a table, NaN where not measured. A coordinate sampled more slowly
/// than the rows has a value only in the row nearest to each sample, so that no measurement counts
/// twice; values are interpolated linearly between neighbouring samples, never across a gap.
/// @param times rising, equally spaced [s]
Eigen::VectorXd angleAtRows(const MeasuredCoordinate& measured, const Eigen::VectorXd& times);

}  // namespace bio
