#include "bio/emg/alignment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/emg/emg_stages.h"
#include "bio/emg/filter.h"
#include "emg/bridged.h"
#include "emg/spectrum.h"

namespace bio {
namespace {

// Sums over the first k values, for k = 0 … size.
Eigen::VectorXd runningSums(const Eigen::VectorXd& x) {
  Eigen::VectorXd out(x.size() + 1);
  out[0] = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) out[i + 1] = out[i] + x[i];
  return out;
}

// Correlation of the overlapping parts over the lag; NaN where it is not asked for.
class LagCorrelation {
 public:
  LagCorrelation(const Eigen::VectorXd& x, const Eigen::VectorXd& y)
      : nx_(x.size()),
        ny_(y.size()),
        sums_(correlationSums(x, y)),
        x_(runningSums(x)),
        y_(runningSums(y)),
        xx_(runningSums(x.cwiseAbs2())),
        yy_(runningSums(y.cwiseAbs2())) {}

  Eigen::Index overlap(Eigen::Index lag) const { return end(lag) - begin(lag); }
  double at(Eigen::Index lag) const {
    const Eigen::Index first = begin(lag), last = end(lag);
    if (last - first < 4) return std::numeric_limits<double>::quiet_NaN();
    const auto n = static_cast<double>(last - first);
    const double sx = x_[last + lag] - x_[first + lag], sy = y_[last] - y_[first];
    const double vx = xx_[last + lag] - xx_[first + lag] - sx * sx / n;
    const double vy = yy_[last] - yy_[first] - sy * sy / n;
    // a part that does not move correlates with nothing
    if (!(vx > 1e-9 * xx_[nx_] && vy > 1e-9 * yy_[ny_])) return 0;
    return (sums_[lag + ny_ - 1] - sx * sy / n) / std::sqrt(vx * vy);
  }

 private:
  // indices of y that lie on x
  Eigen::Index begin(Eigen::Index lag) const { return std::max<Eigen::Index>(0, -lag); }
  Eigen::Index end(Eigen::Index lag) const { return std::min(ny_, nx_ - lag); }
  Eigen::Index nx_, ny_;
  Eigen::VectorXd sums_, x_, y_, xx_, yy_;
};

// Where the parabola through three neighbours of the peak has its top, in samples from it.
double topBetween(double before, double peak, double after) {
  const double curvature = before - 2 * peak + after;
  return curvature < 0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0;
}

}  // namespace

Eigen::VectorXd resampled(const Channel& channel, double rate) {
  Eigen::VectorXd values = bridged(channel.values);
  if (rate < channel.rate) {
    values = filterZeroPhase(
        butterworthLowPass(6, 0.4 * rate, channel.rate, Passes::forwardAndBackward), values);
  }
  const double duration = static_cast<double>(values.size() - 1) / channel.rate;
  const auto count = static_cast<Eigen::Index>(std::floor(duration * rate + 1e-9)) + 1;
  const Eigen::VectorXd times = Eigen::VectorXd::NullaryExpr(
      count, [&](Eigen::Index i) { return static_cast<double>(i) / rate; });
  return sampledAt(values, channel.rate, 0, times);
}

Alignment alignmentOf(const Channel& reference, const Channel& other,
                      const AlignmentOptions& options) {
  const auto fail = [&](const std::string& what) {
    throw std::invalid_argument(
        fmt::format("channels '{}' and '{}': {}", reference.name, other.name, what));
  };
  if (!(options.within > 0)) fail(fmt::format("within {} s, must be > 0", options.within));
  const double rate = std::min(reference.rate, other.rate);
  const auto centred = [&](const Channel& channel) {
    const Eigen::VectorXd values = resampled(channel, rate);
    return Eigen::VectorXd(values.array() - values.mean());
  };
  const Eigen::VectorXd x = centred(reference), y = centred(other);
  for (const auto& [values, channel] : {std::pair{&x, &reference}, {&y, &other}}) {
    if (!(values->cwiseAbs().maxCoeff() > 0)) {
      fail(fmt::format("'{}' has one value throughout, must show an event", channel->name));
    }
  }
  const LagCorrelation correlation(x, y);
  const double zeroLag = reference.startTime - other.startTime;  // offset of lag 0
  const Eigen::Index least = std::max<Eigen::Index>(4, std::min(x.size(), y.size()) / 2);
  Eigen::VectorXd r = Eigen::VectorXd::Zero(x.size() + y.size() - 1);  // 0: not asked for
  Eigen::Index best = -1;
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    const Eigen::Index lag = i - (y.size() - 1);
    if (correlation.overlap(lag) < least) continue;
    if (!(std::abs(zeroLag + static_cast<double>(lag) / rate) <= options.within)) continue;
    r[i] = correlation.at(lag);
    if (best < 0 || std::abs(r[i]) > std::abs(r[best])) best = i;
  }
  if (best < 0) {
    fail(fmt::format("do not overlap by half within {:g} s, must do so", options.within));
  }
  Alignment out;
  out.correlation = r[best];
  const double peak = std::abs(r[best]);
  const auto size = [&](Eigen::Index i) { return i < 0 || i >= r.size() ? 0.0 : std::abs(r[i]); };
  // the peak reaches down to half of it
  Eigen::Index low = best, high = best;
  while (size(low) > 0.5 * peak) --low;
  while (size(high) > 0.5 * peak) ++high;
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    if (i < low || i > high) out.rival = std::max(out.rival, size(i));
  }
  if (!(peak >= 0.5)) {
    fail(
        fmt::format("correlate by {:.2f} at best, must reach 0.5 (do both show the event? else "
                    "give offset_s)",
                    peak));
  }
  if (out.rival > 0.95 * peak) {
    fail(
        fmt::format("correlate by {:.3f} at one offset and by {:.3f} at another, must differ (give "
                    "within_s or offset_s)",
                    peak, out.rival));
  }
  const Eigen::Index lag = best - (y.size() - 1);
  const double between = topBetween(size(best - 1), peak, size(best + 1));
  out.offset = zeroLag + (static_cast<double>(lag) + between) / rate;
  out.overlap = static_cast<double>(correlation.overlap(lag)) / rate;
  return out;
}

}  // namespace bio
