#include "bio/emg/measured_coordinate.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "bio/emg/filter.h"
#include "emg/bridged.h"

namespace bio {
namespace {

constexpr double notMeasured = std::numeric_limits<double>::quiet_NaN();

void check(const Channel& channel, const MeasuredOptions& options) {
  const auto fail = [&](const std::string& what) {
    throw std::invalid_argument(
        fmt::format("measured coordinate '{}': {}", options.coordinate, what));
  };
  if (!(options.degreesPerUnit > 0 && std::isfinite(options.degreesPerUnit))) {
    fail(fmt::format("{} degrees per {}, must be > 0 (use sign for the direction)",
                     options.degreesPerUnit, channel.unit.empty() ? "unit" : channel.unit));
  }
  if (options.sign != 1 && options.sign != -1) {
    fail(fmt::format("sign {}, must be 1 or -1", options.sign));
  }
  if (!std::isfinite(options.zero)) fail(fmt::format("zero {}, must be finite", options.zero));
  if (!(options.clipBelow < options.clipAbove)) {
    fail(fmt::format("clipped below {} and above {}, the first must be smaller", options.clipBelow,
                     options.clipAbove));
  }
}

}  // namespace

Eigen::VectorXd bridged(const Eigen::VectorXd& x) {
  Eigen::VectorXd out = x;
  Eigen::Index previous = -1;
  for (Eigen::Index i = 0; i <= x.size(); ++i) {
    if (i < x.size() && std::isnan(x[i])) continue;
    for (Eigen::Index k = previous + 1; k < i; ++k) {
      if (previous < 0) {
        out[k] = x[i];
      } else if (i == x.size()) {
        out[k] = x[previous];
      } else {
        const double part = static_cast<double>(k - previous) / static_cast<double>(i - previous);
        out[k] = (1 - part) * x[previous] + part * x[i];
      }
    }
    previous = i;
  }
  return out;
}

MeasuredCoordinate measuredCoordinate(const Channel& channel, const MeasuredOptions& options) {
  check(channel, options);
  MeasuredCoordinate out{options.coordinate, channel.rate, channel.startTime, {}, 0};
  out.angle_deg = channel.values.unaryExpr([&](double value) {
    const bool within = value > options.clipBelow && value < options.clipAbove;
    return within ? options.sign * options.degreesPerUnit * (value - options.zero) : notMeasured;
  });
  const Eigen::VectorXd seen = out.angle_deg;
  const auto gap = [](double a) { return std::isnan(a) ? 1.0 : 0.0; };
  out.notMeasured = seen.unaryExpr(gap).mean();
  if (out.notMeasured == 1) {
    throw std::invalid_argument(fmt::format(
        "measured coordinate '{}': channel '{}' has no value between the limits {} and {}",
        options.coordinate, channel.name, options.clipBelow, options.clipAbove));
  }
  if (options.lowPass) {
    const Eigen::VectorXd smooth =
        filterZeroPhase(butterworthLowPass(options.lowPassOrder, *options.lowPass, channel.rate,
                                           Passes::forwardAndBackward),
                        bridged(seen));
    out.angle_deg = seen.binaryExpr(smooth, [](double raw, double filtered) {
      return std::isnan(raw) ? notMeasured : filtered;
    });
  }
  return out;
}

Eigen::VectorXd angleAtRows(const MeasuredCoordinate& measured, const Eigen::VectorXd& times) {
  const Eigen::VectorXd& angle = measured.angle_deg;
  const double spacing = times.size() > 1 ? times[1] - times[0] : 1.0;
  const bool slower = measured.rate * spacing < 1 - 1e-6;
  constexpr double onSample = 1e-6;  // of a sample interval
  return times.unaryExpr([&](double t) {
    const double place = (t - measured.startTime) * measured.rate;
    const double nearest = std::round(place);
    if (!(nearest >= 0 && nearest < static_cast<double>(angle.size()))) return notMeasured;
    // slower than the rows: only the row nearest to the sample (a tie goes to the later row)
    const double rowsAway = (place - nearest) / (measured.rate * spacing);
    if (slower && !(rowsAway > -0.5 + onSample && rowsAway <= 0.5 + onSample)) return notMeasured;
    if (std::abs(place - nearest) < onSample) return angle[static_cast<Eigen::Index>(nearest)];
    // between two samples, both measured
    const auto k = static_cast<Eigen::Index>(std::floor(place));
    if (k < 0 || k + 1 >= angle.size()) return notMeasured;
    const double part = place - static_cast<double>(k);
    return (1 - part) * angle[k] + part * angle[k + 1];
  });
}

}  // namespace bio
