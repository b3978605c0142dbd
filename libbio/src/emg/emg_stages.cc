#include "bio/emg/emg_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/emg/filter.h"

namespace bio {

Eigen::VectorXd bandPassed(const Eigen::VectorXd& raw, double rate,
                           const BandPassOptions& options) {
  return filterZeroPhase(butterworthBandPass(options.order, options.low, options.high, rate,
                                             Passes::forwardAndBackward),
                         raw);
}

Eigen::VectorXd notched(const Eigen::VectorXd& raw, double rate, const NotchOptions& options) {
  if (options.harmonics < 1) {
    throw std::invalid_argument(
        fmt::format("notch harmonics {}: must be ≥ 1 (1 is the line itself)", options.harmonics));
  }
  if (!(options.width > 0)) {
    throw std::invalid_argument(fmt::format("notch width {} Hz: must be > 0", options.width));
  }
  Eigen::VectorXd out = raw;
  for (const double line : options.lines) {
    for (int h = 1; h <= options.harmonics; ++h) {
      const double low = h * line - options.width / 2;
      const double high = h * line + options.width / 2;
      if (h > 1 && high >= rate / 2) break;
      out = filterZeroPhase(
          butterworthBandStop(options.order, low, high, rate, Passes::forwardAndBackward), out);
    }
  }
  return out;
}

Eigen::VectorXd envelope(const Eigen::VectorXd& rectified, double rate,
                         const EnvelopeOptions& options) {
  return filterZeroPhase(
      butterworthLowPass(options.order, options.cutoff, rate, Passes::forwardAndBackward),
      rectified, Reflection::even);
}

double percentile(const Eigen::VectorXd& values, double percent) {
  if (!(percent >= 0 && percent <= 100)) {
    throw std::domain_error(fmt::format("percentile {}: must lie within 0 and 100", percent));
  }
  if (values.size() == 0) throw std::domain_error("percentile of 0 values");
  Eigen::VectorXd sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const double place = percent / 100 * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<Eigen::Index>(place);
  const auto above = std::min(below + 1, sorted.size() - 1);
  const double part = place - static_cast<double>(below);
  return (1 - part) * sorted[below] + part * sorted[above];
}

Clipped clippedToUnit(const Eigen::VectorXd& values) {
  Clipped out;
  out.values = values.cwiseMax(0.0).cwiseMin(1.0);
  if (values.size() > 0) {
    out.fractionBelow = (values.array() < 0).cast<double>().mean();
    out.fractionAbove = (values.array() > 1).cast<double>().mean();
  }
  return out;
}

double shapedExcitation(double u, double shape) {
  if (!(u >= 0 && u <= 1)) {
    throw std::domain_error(fmt::format("excitation {}: must lie within 0 and 1", u));
  }
  if (!(shape >= -3 && shape <= 0)) {
    throw std::domain_error(
        fmt::format("EMG shape factor A = {}: must lie within -3 and 0", shape));
  }
  // near A = 0 both exponentials lose their digits: series to second order in A
  if (shape > -1e-6) return u + 0.5 * shape * u * (u - 1);
  return std::expm1(shape * u) / std::expm1(shape);
}

Eigen::VectorXd sampledAt(const Eigen::VectorXd& values, double rate, double startTime,
                          const Eigen::VectorXd& times) {
  const Eigen::Index last = values.size() - 1;
  return times.unaryExpr([&](double t) {
    const double place = std::clamp((t - startTime) * rate, 0.0, static_cast<double>(last));
    const auto k = std::min(static_cast<Eigen::Index>(place), std::max<Eigen::Index>(last - 1, 0));
    const double part = place - static_cast<double>(k);
    return part == 0 ? values[k] : (1 - part) * values[k] + part * values[k + 1];
  });
}

void checkWithoutGaps(const Channel& channel) {
  const Eigen::VectorXd& x = channel.values;
  if (x.size() < 2) {
    throw std::invalid_argument(
        fmt::format("EMG channel '{}': {} samples, needs at least 2", channel.name, x.size()));
  }
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (std::isfinite(x[i])) continue;
    Eigen::Index end = i;
    while (end < x.size() && !std::isfinite(x[end])) ++end;
    throw std::invalid_argument(fmt::format(
        "EMG channel '{}': no value from {:.4f} s on ({} samples), must be without gaps",
        channel.name, channel.startTime + static_cast<double>(i) / channel.rate, end - i));
  }
}

}  // namespace bio
