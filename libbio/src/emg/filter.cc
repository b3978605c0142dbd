#include "bio/emg/filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace bio {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

void checkOrder(int order) {
  if (order < 1 || order > 10) {
    throw std::invalid_argument(fmt::format("filter order {}: must be 1 to 10", order));
  }
}

// The edge in the bilinear transform's own frequency, w = tan(πf/fs).
double prewarped(const char* name, double edge, double sampleRate) {
  if (!(sampleRate > 0 && std::isfinite(sampleRate))) {
    throw std::invalid_argument(fmt::format("sample rate {} Hz: must be > 0", sampleRate));
  }
  if (!(edge > 0 && edge < sampleRate / 2)) {
    throw std::invalid_argument(
        fmt::format("{} {} Hz: must lie between 0 and half the sample rate, {} Hz", name, edge,
                    sampleRate / 2));
  }
  return std::tan(pi * edge / sampleRate);
}

void checkBand(double low, double high) {
  if (!(low < high)) {
    throw std::invalid_argument(
        fmt::format("band from {} Hz to {} Hz: the lower edge must be below the upper", low, high));
  }
}

// Corner of the prototype: 1 for one pass; for two, the Ω_c with (1 + Ω_c⁻²ⁿ)² = 2.
double corner(int order, Passes passes) {
  return passes == Passes::once ? 1.0 : std::pow(std::numbers::sqrt2 - 1, -0.5 / order);
}

// Poles of the prototype with unit corner in the upper half plane (and on the real axis, last).
std::vector<Complex> prototypePoles(int order) {
  std::vector<Complex> poles;
  for (int k = 0; k < order / 2; ++k) {
    poles.push_back(std::polar(1.0, pi * (2 * k + order + 1) / (2.0 * order)));
  }
  if (order % 2 == 1) poles.emplace_back(-1.0, 0.0);
  return poles;
}

Complex toUnitDisc(Complex s) {
  return (1.0 + s) / (1.0 - s);
}

// Section with analog poles s1, s2 and the numerator given up to a factor; the factor makes |H| = 1
// at zRef.
SecondOrderSection section(Complex s1, Complex s2, double b1, double b2, Complex zRef) {
  const Complex z1 = toUnitDisc(s1);
  const Complex z2 = toUnitDisc(s2);
  SecondOrderSection out{1, b1, b2, -(z1 + z2).real(), (z1 * z2).real()};
  const Complex inverse = 1.0 / zRef;
  const double gain = std::abs((1.0 + inverse * (out.b1 + inverse * out.b2)) /
                               (1.0 + inverse * (out.a1 + inverse * out.a2)));
  out.b0 /= gain;
  out.b1 /= gain;
  out.b2 /= gain;
  return out;
}

// A real analog pole s: H = (1 + z⁻¹)/(1 + a1 z⁻¹) with gain 1 at z = 1.
SecondOrderSection firstOrderSection(double s) {
  SecondOrderSection out{1, 1, 0, -(1 + s) / (1 - s), 0};
  const double gain = 2 / (1 + out.a1);
  out.b0 /= gain;
  out.b1 /= gain;
  return out;
}

// The two roots of s² − 2h s + p = 0.
std::pair<Complex, Complex> roots(Complex h, double p) {
  const Complex d = std::sqrt(h * h - p);
  return {h + d, h - d};
}

// Sections of a band filter: the prototype pole p becomes the two roots of s² − 2h(p) s + w0² = 0.
template <class HalfSum>
std::vector<SecondOrderSection> bandSections(int order, double w0, HalfSum halfSum, double b1,
                                             double b2, Complex zRef) {
  std::vector<SecondOrderSection> out;
  for (const Complex& pole : prototypePoles(order)) {
    const auto [s1, s2] = roots(halfSum(pole), w0 * w0);
    if (pole.imag() == 0) {
      out.push_back(section(s1, s2, b1, b2, zRef));
    } else {
      out.push_back(section(s1, std::conj(s1), b1, b2, zRef));
      out.push_back(section(s2, std::conj(s2), b1, b2, zRef));
    }
  }
  return out;
}

void checkFinite(const Eigen::VectorXd& signal) {
  if (signal.size() == 0) throw std::invalid_argument("signal of 0 samples: nothing to filter");
  for (Eigen::Index i = 0; i < signal.size(); ++i) {
    if (!std::isfinite(signal[i])) {
      throw std::invalid_argument(
          fmt::format("signal value {} at sample {}: must be finite to be filtered", signal[i], i));
    }
  }
}

// One pass over checked values, in place (transposed direct form II).
void pass(const Filter& filter, Eigen::VectorXd& x) {
  for (const SecondOrderSection& s : filter.sections) {
    // steady state of a constant input equal to the first sample
    const double dcGain = (s.b0 + s.b1 + s.b2) / (1 + s.a1 + s.a2);
    double w2 = (s.b2 - s.a2 * dcGain) * x[0];
    double w1 = (dcGain - s.b0) * x[0];
    for (double& value : x) {
      const double in = value;
      value = s.b0 * in + w1;
      w1 = s.b1 * in - s.a1 * value + w2;
      w2 = s.b2 * in - s.a2 * value;
    }
  }
}

}  // namespace

Filter butterworthLowPass(int order, double cutoff, double sampleRate, Passes passes) {
  checkOrder(order);
  const double w = prewarped("low-pass cut-off", cutoff, sampleRate) * corner(order, passes);
  Filter out{{}, sampleRate};
  for (const Complex& p : prototypePoles(order)) {
    out.sections.push_back(p.imag() == 0 ? firstOrderSection(-w)
                                         : section(w * p, w * std::conj(p), 2, 1, 1.0));
  }
  return out;
}

Filter butterworthBandPass(int order, double low, double high, double sampleRate, Passes passes) {
  checkOrder(order);
  const double wLow = prewarped("lower band edge", low, sampleRate);
  const double wHigh = prewarped("upper band edge", high, sampleRate);
  checkBand(low, high);
  const double w0 = std::sqrt(wLow * wHigh);
  const double width = (wHigh - wLow) * corner(order, passes);
  const Complex centre = toUnitDisc(Complex(0, w0));
  return {bandSections(
              order, w0, [&](Complex p) { return p * width / 2.0; }, 0, -1, centre),
          sampleRate};
}

Filter butterworthBandStop(int order, double low, double high, double sampleRate, Passes passes) {
  checkOrder(order);
  const double wLow = prewarped("lower band edge", low, sampleRate);
  const double wHigh = prewarped("upper band edge", high, sampleRate);
  checkBand(low, high);
  const double w0 = std::sqrt(wLow * wHigh);
  const double width = (wHigh - wLow) / corner(order, passes);
  // zeros on the unit circle at the centre
  const double b1 = -2 * toUnitDisc(Complex(0, w0)).real();
  return {bandSections(
              order, w0, [&](Complex p) { return width / (2.0 * p); }, b1, 1, 1.0),
          sampleRate};
}

Eigen::Index settlingSamples(const Filter& filter, double remainder) {
  double largest = 0;
  for (const SecondOrderSection& s : filter.sections) {
    const auto [z1, z2] = roots(-s.a1 / 2, s.a2);
    largest = std::max({largest, std::abs(z1), std::abs(z2)});
  }
  if (largest < 1e-12) return 1;
  return static_cast<Eigen::Index>(std::ceil(std::log(remainder) / std::log(largest)));
}

Eigen::VectorXd filterZeroPhase(const Filter& filter, const Eigen::VectorXd& signal,
                                Reflection reflection) {
  checkFinite(signal);
  const Eigen::Index n = signal.size();
  const auto least = static_cast<Eigen::Index>(6 * filter.sections.size() + 1);
  if (n < least) {
    throw std::invalid_argument(
        fmt::format("signal of {} samples: a zero-phase filter of {} sections needs at least {}", n,
                    filter.sections.size(), least));
  }
  // continue both ends
  const Eigen::Index pad = std::min(n - 1, settlingSamples(filter));
  Eigen::VectorXd x(n + 2 * pad);
  x.head(pad) = signal.segment(1, pad).reverse();
  x.segment(pad, n) = signal;
  x.tail(pad) = signal.segment(n - 1 - pad, pad).reverse();
  if (reflection == Reflection::odd) {
    x.head(pad) = (2 * signal[0] - x.head(pad).array()).matrix();
    x.tail(pad) = (2 * signal[n - 1] - x.tail(pad).array()).matrix();
  }
  // there and back
  pass(filter, x);
  x.reverseInPlace();
  pass(filter, x);
  x.reverseInPlace();
  return x.segment(pad, n);
}

}  // namespace bio
