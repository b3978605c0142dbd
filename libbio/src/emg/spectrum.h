#pragma once

#include <Eigen/Dense>
#include <complex>
#include <vector>

namespace bio {

/// Power of a signal over frequency: value k belongs to k·spacing.
struct Spectrum {
  double spacing = 0;     ///< [Hz]
  Eigen::VectorXd power;  ///< [unit²], from 0 to half the rate; its sum is the variance
};

/// Welch's estimate: mean over half-overlapping pieces of about 1 s (at least 16 samples, at most
/// the signal), each without its mean and under a Hann window. No values: no power.
/// @param signal finite
Spectrum spectrumOf(const Eigen::VectorXd& signal, double rate);

/// Σ_i x[i + k]·y[i] for lags k from −(y.size() − 1) to x.size() − 1, by Fourier transforms.
Eigen::VectorXd correlationSums(const Eigen::VectorXd& x, const Eigen::VectorXd& y);

}  // namespace bio
