#pragma once

// The noise of the measured channels of a calibration; not public.

#include <optional>
#include <vector>

#include "bio/calibration/calibrate.h"
#include "info/estimation/least_squares.h"

namespace bio {

/// Noise of each channel of a set of trials, given or from its residuals; and all outputs in units
/// that make the channels' effective noises equal, so that one standard deviation is that of all.
class ChannelNoise {
 public:
  /// @throws std::invalid_argument for a noise that is given of a channel that no trial measures,
  /// or
  ///   is not > 0
  ChannelNoise(const TrialSet& trials, const CalibrationOptions& options);

  bool areOne() const { return trials_.channels().size() == 1; }

  /// The given noise, else what the measurements alone show (measuredSd), at least 0.1 mrad of an
  /// angle, a thousandth of the root mean square of another channel.
  std::vector<ResidualNoise> shown() const;
  /// Noise by the residuals of a prediction after so many parameters were fitted, of which each
  /// channel has a share by its number of samples.
  std::vector<ResidualNoise> of(const Eigen::MatrixXd& predicted, Eigen::Index fitted) const;
  /// Residuals of one channel, series by series.
  std::vector<Eigen::VectorXd> residuals(const Eigen::MatrixXd& predicted,
                                         std::size_t channel) const;
  /// How far a prediction is from what was measured; of several channels each relative to the size
  /// of its measurements.
  double distance(const Eigen::MatrixXd& predicted) const;

  /// From now on, outputs are divided by a channel's effective noise over that of the first one.
  void weigh(const std::vector<ResidualNoise>& noises);
  Eigen::MatrixXd weighted(const Eigen::MatrixXd& outputs) const;
  info::Predictor weighted(const info::Predictor& predictor) const;

 private:
  std::optional<double> given(std::size_t channel) const;
  ResidualNoise ofSeries(const std::vector<Eigen::VectorXd>& series, double fitted,
                         const std::optional<double>& given) const;

  const TrialSet& trials_;
  const CalibrationOptions& options_;
  Eigen::MatrixXd measured_;
  Eigen::MatrixXd weight_;  ///< 1 × samples; empty: all 1
};

}  // namespace bio
