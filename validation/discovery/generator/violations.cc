#include "generator/violations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace hidden {
namespace {

using Series = std::vector<double>;

constexpr double leadIn = 1;  // what a start in motion may cut off [s]

// Butterworth's low-pass of second order, by the bilinear transform.
Series lowPassed(const Series& x, double cutoff, double rate) {
  const double w = std::tan(std::numbers::pi * cutoff / rate);
  const double scale = 1 / (1 + std::numbers::sqrt2 * w + w * w);
  const double b = w * w * scale;
  const double a1 = 2 * (w * w - 1) * scale, a2 = (1 - std::numbers::sqrt2 * w + w * w) * scale;
  Series y(x.size());
  double x1 = x[0], x2 = x[0], y1 = x[0], y2 = x[0];  // as if it had been there for long
  for (std::size_t k = 0; k < x.size(); ++k) {
    y[k] = b * (x[k] + 2 * x1 + x2) - a1 * y1 - a2 * y2;
    x2 = x1, x1 = x[k];
    y2 = y1, y1 = y[k];
  }
  return y;
}

// Without a shift: forth and back.
Series smoothed(Series x, double cutoff, double rate) {
  x = lowPassed(x, cutoff, rate);
  std::reverse(x.begin(), x.end());
  x = lowPassed(x, cutoff, rate);
  std::reverse(x.begin(), x.end());
  return x;
}

Series whiteNoise(std::size_t n, double deviation, RandomNumbers& random) {
  Series noise(n);
  for (double& e : noise) e = deviation * random.normal();
  return noise;
}

// Low-passed at 6 Hz, with the deviation that white noise would have.
Series correlatedNoise(std::size_t n, double deviation, double rate, RandomNumbers& random) {
  constexpr std::size_t settling = 100;
  Series impulse(400, 0.0);
  impulse[1] = 1;
  double power = 0;
  for (const double h : lowPassed(impulse, 6, rate)) power += h * h;
  const Series all =
      lowPassed(whiteNoise(n + settling, deviation / std::sqrt(power), random), 6, rate);
  return {all.begin() + settling, all.end()};
}

// Student's t with three degrees of freedom, scaled to the deviation.
Series heavyNoise(std::size_t n, double deviation, RandomNumbers& random) {
  Series noise(n);
  for (double& e : noise) {
    double square = 0;
    const double above = random.normal();
    for (int i = 0; i < 3; ++i) square += std::pow(random.normal(), 2);
    e = deviation / std::sqrt(3.0) * above / std::sqrt(square / 3);
  }
  return noise;
}

// What a sensor of first order shows [deg].
Series late(const Series& angle, double time, double rate) {
  const double stays = std::exp(-1 / (rate * time));
  Series y(angle.size(), angle[0]);
  for (std::size_t k = 1; k < angle.size(); ++k) {
    // exact for a straight line between the rows
    const double slope = (angle[k] - angle[k - 1]) * rate;
    y[k] = angle[k] - slope * time + stays * (y[k - 1] - angle[k - 1] + slope * time);
  }
  return y;
}

// Blocks of 0.1 to 0.4 s without samples until a fifth is missing; the first 0.2 s are there.
void loseBlocks(Series& measured, double rate, RandomNumbers& random) {
  const auto n = measured.size();
  const auto first = static_cast<std::size_t>(0.2 * rate);
  std::size_t missing = 0;
  while (5 * missing < n) {
    const auto from =
        first + static_cast<std::size_t>(random.between(0, static_cast<double>(n - first)));
    const auto length = static_cast<std::size_t>(random.between(0.1, 0.4) * rate);
    for (std::size_t k = from; k < std::min(from + length, n) && 5 * missing < n; ++k) {
      if (std::isnan(measured[k])) continue;
      measured[k] = std::numeric_limits<double>::quiet_NaN();
      ++missing;
    }
  }
}

// The trial from its fastest row between 0.3 s and the lead-in's end on.
void startInMotion(Trial& trial, double rate) {
  const Series& q = trial.angle;
  auto first = static_cast<std::size_t>(0.3 * rate), best = first;
  const auto end = static_cast<std::size_t>(leadIn * rate);
  const auto fast = [&](std::size_t k) { return std::abs(q[k + 1] - q[k - 1]); };
  for (std::size_t k = first; k <= end; ++k) {
    if (fast(k) > fast(best)) best = k;
  }
  const auto rows = q.size() - end;
  const auto cut = [&](auto& series) {
    if (series.empty()) return;
    series.erase(series.begin(), series.begin() + static_cast<std::ptrdiff_t>(best));
    series.resize(rows);
  };
  Recording& made = trial.truth;
  cut(made.emg), cut(made.unfaith), cut(made.torque), cut(trial.recorded);
  cut(trial.angle), cut(trial.measured_deg);
  made.times.resize(rows);  // they begin at 0 again
}

void smoothRecords(Trial& trial, double rate) {
  for (std::size_t i = 0; i < 8; ++i) {
    Series channel;
    for (const auto& row : trial.recorded) channel.push_back(row[i]);
    channel = smoothed(channel, 3, rate);
    for (std::size_t k = 0; k < channel.size(); ++k) {
      trial.recorded[k][i] = std::clamp(std::round(channel[k] * 1e5) / 1e5, 0.0, 1.0);
    }
  }
}

}  // namespace

const std::vector<Violation>& violations() {
  static const std::vector<Violation> all = {
      {"correlated_noise", "noise of the angle low-passed at 6 Hz (second order), 0.5 deg"},
      {"outliers", "one sample in twenty 10 deg off"},
      {"quantised", "the angle in steps of 1 deg"},
      {"moving_start", "the arm moves already where the trial starts"},
      {"lag", "the angle's sensor lags by 30 ms (first order)"},
      {"heavy_tails", "noise of Student's t with 3 degrees of freedom, 0.5 deg"},
      {"gaps", "a fifth of the samples missing, in blocks"},
      {"emg_noise", "10 % of EMG noise in every muscle"},
      {"drift", "the angle's sensor drifts by 1 deg over the trial"},
      {"slow_emg", "the EMG written down is low-passed at 3 Hz, what the muscles get is not"}};
  return all;
}

const Violation& violation(const std::string& id) {
  for (const Violation& v : violations()) {
    if (v.id == id) return v;
  }
  throw std::invalid_argument("no violation is called '" + id + "'");
}

TrialPlan planFor(const Violation& violation, TrialPlan plan) {
  if (violation.id == "moving_start") plan.duration += leadIn;
  if (violation.id == "emg_noise") plan.emgNoise = 0.1;
  return plan;
}

void violate(const Violation& violation, const Truth& truth, const TrialPlan& plan, Trial& trial,
             RandomNumbers& random) {
  const std::string& id = violation.id;
  const double deviation = plan.angleNoise, rate = plan.rate;
  Series shown = throughSensor(truth.sensor, trial.truth, trial.angle);
  for (double& y : shown) y /= degree;
  const std::size_t n = shown.size();
  if (id == "lag") shown = late(shown, 0.03, rate);
  const Series noise = id == "correlated_noise" ? correlatedNoise(n, deviation, rate, random)
                       : id == "heavy_tails"    ? heavyNoise(n, deviation, random)
                                                : whiteNoise(n, deviation, random);
  const double drift = id == "drift" ? (random.between(0, 1) < 0.5 ? -1 : 1) : 0;
  const double unit = id == "quantised" ? 1 : 0.01;
  for (std::size_t k = 0; k < n; ++k) {
    double y = shown[k] + noise[k] + drift * static_cast<double>(k) / static_cast<double>(n - 1);
    if (id == "outliers" && random.between(0, 1) < 0.05) {
      y += random.between(0, 1) < 0.5 ? -10 : 10;
    }
    trial.measured_deg[k] = std::round(y / unit) * unit;
  }
  if (id == "gaps") loseBlocks(trial.measured_deg, rate, random);
  if (id == "slow_emg") smoothRecords(trial, rate);
  if (id == "moving_start") startInMotion(trial, rate);
}

}  // namespace hidden
