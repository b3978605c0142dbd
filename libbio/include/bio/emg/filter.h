#pragma once

#include <Eigen/Dense>
#include <vector>

namespace bio {

/// One second-order section, H(z) = (b0 + b1 z⁻¹ + b2 z⁻²) / (1 + a1 z⁻¹ + a2 z⁻²).
/// A first-order factor has b2 = a2 = 0.
struct SecondOrderSection {
  double b0 = 1;
  double b1 = 0;
  double b2 = 0;
  double a1 = 0;
  double a2 = 0;
};

/// A linear filter for signals of one sampling rate, as a cascade of sections.
struct Filter {
  std::vector<SecondOrderSection> sections;
  double sampleRate = 0;  ///< [Hz] > 0
};

/// Number of passes over the signal. Filtering forward and backward squares the gain, so a filter
/// designed for one pass would have −6 dB at its cut-off; for `forwardAndBackward` the prototype's
/// corner is moved by (√2 − 1)^(−1/2n), so that the gain of both passes together is −3 dB at the
/// requested cut-off.
enum class Passes { once, forwardAndBackward };

/// Butterworth filters by the bilinear transform with prewarped edges. With w = tan(πf/fs) the gain
/// of one pass is exactly |H|² = 1/(1 + Ω²ⁿ), n the order of the low-pass prototype, and
///     low-pass   Ω = w/w_c
///     band-pass  Ω = (w² − w_l w_h)/((w_h − w_l) w)          band-stop  the reciprocal
/// so a band-pass or band-stop of order n has 2n poles and slopes of order n on both sides. Unit
/// gain at 0 (low-pass, band-stop) or the band's centre, |Ω| = 1 at every edge.
/// Edges (cutoff, low, high) are in Hz, 0 < edge < sampleRate/2, low < high. Source: Butterworth
/// 1930; Oppenheim & Schafer, Discrete-Time Signal Processing, section 7.1.
///
/// @param order n, 1 to 10
/// @param sampleRate fs [Hz] > 0
/// @throws std::invalid_argument naming the edge, order or rate that breaks its rule
Filter butterworthLowPass(int order, double cutoff, double sampleRate,
                          Passes passes = Passes::once);
Filter butterworthBandPass(int order, double low, double high, double sampleRate,
                           Passes passes = Passes::once);
Filter butterworthBandStop(int order, double low, double high, double sampleRate,
                           Passes passes = Passes::once);

/// Samples until the slowest pole has decayed to `remainder` (0 < remainder < 1).
Eigen::Index settlingSamples(const Filter& filter, double remainder = 1e-6);

/// Extrapolation of a signal beyond its ends. `odd`, 2·x₀ − x, continues value and slope and keeps
/// the end value; `even`, x, continues a level, for signals that fluctuate about one, such as a
/// rectified EMG, whose single end value is not representative.
enum class Reflection { odd, even };

/// A forward and a backward pass: zero phase, gain |H|², each in the steady state of its first
/// sample, so that a constant passes without a transient. Both ends are extended by reflection over
/// the memory of the filter or the length of the signal.
/// @throws std::invalid_argument if the signal has fewer than 6·sections + 1 samples or holds a
/// value that is not finite
Eigen::VectorXd filterZeroPhase(const Filter& filter, const Eigen::VectorXd& signal,
                                Reflection reflection = Reflection::odd);

}  // namespace bio
