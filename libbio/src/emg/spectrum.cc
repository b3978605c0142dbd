#include "emg/spectrum.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace bio {

Spectrum spectrumOf(const Eigen::VectorXd& signal, double rate) {
  Spectrum out;
  const auto whole = static_cast<std::size_t>(signal.size());
  if (whole < 4) return out;
  const auto second = static_cast<std::size_t>(std::clamp(rate, 16.0, 65536.0));
  const std::size_t length = std::min(std::bit_ceil(second), std::bit_floor(whole));
  const auto n = static_cast<Eigen::Index>(length);
  const Eigen::VectorXd window = Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index i) {
    const double s = std::sin(std::numbers::pi * static_cast<double>(i) / static_cast<double>(n));
    return s * s;
  });
  out.spacing = rate / static_cast<double>(length);
  out.power.setZero(n / 2 + 1);
  Eigen::FFT<double> fft;
  int pieces = 0;
  for (Eigen::Index begin = 0; begin + n <= signal.size(); begin += n / 2, ++pieces) {
    const Eigen::ArrayXd piece = signal.segment(begin, n).array();
    const Eigen::VectorXd windowed = ((piece - piece.mean()) * window.array()).matrix();
    Eigen::VectorXcd transform;
    fft.fwd(transform, windowed);
    out.power += transform.head(n / 2 + 1).cwiseAbs2();
  }
  // both sides of the spectrum, and the window's own power
  out.power *= 2 / (static_cast<double>(pieces) * static_cast<double>(n) * window.squaredNorm());
  out.power[0] /= 2;
  out.power[n / 2] /= 2;
  return out;
}

Eigen::VectorXd correlationSums(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const Eigen::Index lags = x.size() + y.size() - 1;
  const auto length = static_cast<Eigen::Index>(
      std::bit_ceil(static_cast<std::size_t>(std::max<Eigen::Index>(lags, 2))));
  const auto padded = [&](const Eigen::VectorXd& values) {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(length);
    out.head(values.size()) = values;
    return out;
  };
  Eigen::FFT<double> fft;
  Eigen::VectorXcd fx, fy;
  fft.fwd(fx, padded(x));
  fft.fwd(fy, padded(y));
  const Eigen::VectorXcd product = fx.cwiseProduct(fy.conjugate());
  Eigen::VectorXd circular;
  fft.inv(circular, product);
  // negative lags stand at the end
  Eigen::VectorXd out(lags);
  const Eigen::Index negative = y.size() - 1;
  out.head(negative) = circular.tail(negative);
  out.tail(x.size()) = circular.head(x.size());
  return out;
}

}  // namespace bio
