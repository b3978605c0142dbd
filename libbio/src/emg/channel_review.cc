#include "bio/emg/channel_review.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "emg/bridged.h"
#include "emg/spectrum.h"

namespace bio {
namespace {

constexpr double emgFrom = 20;          // [Hz]
constexpr double whiteNoiseAt = 0.39;   // of the rate: median of white noise's second differences
constexpr double lowPassedBelow = 0.6;  // of that

// A channel and what is measured on it.
struct Sight {
  const Channel* channel = nullptr;
  ChannelUse use = ChannelUse::rawEmg;
  Eigen::VectorXd values;     // without gaps
  std::size_t levels = 0;     // different values, counted up to 17
  double rms = 0;             // about the mean
  double above = 0;           // share of power above 20 Hz
  double noiseFrequency = 0;  // median of the second differences' power [Hz]
  bool dead() const { return levels < 4; }
  // Of a low-pass: the median lies at 0.9 (steep) to 1.7 times (second order, both ways) of it.
  double cutoff() const { return 0.8 * noiseFrequency; }
};

std::size_t levelsOf(const Eigen::VectorXd& values) {
  std::set<double> seen;
  for (const double value : values) {
    seen.insert(value);
    if (seen.size() > 16) break;
  }
  return seen.size();
}

// The frequency below which half of the second differences' power lies. They are taken before the
// spectrum, so that a large slow motion does not leak into it.
double medianOfSecondDifferences(const Eigen::VectorXd& x, double rate) {
  const Eigen::Index n = x.size() - 2;
  if (n < 4) return 0;
  const Spectrum spectrum = spectrumOf(x.tail(n) - 2 * x.segment(1, n) + x.head(n), rate);
  const double half = spectrum.power.sum() / 2;
  if (!(half > 0)) return 0;
  double sum = 0;
  Eigen::Index k = 0;
  while (k + 1 < spectrum.power.size() && (sum += spectrum.power[k]) < half) ++k;
  return static_cast<double>(k) * spectrum.spacing;
}

Sight sightOf(const ReviewedChannel& reviewed) {
  Sight out;
  out.channel = reviewed.channel;
  out.use = reviewed.use;
  out.values = bridged(reviewed.channel->values);
  out.levels = levelsOf(out.values);
  const double mean = out.values.mean();
  out.rms = std::sqrt((out.values.array() - mean).square().mean());
  const double rate = reviewed.channel->rate;
  const Spectrum spectrum = spectrumOf(out.values, rate);
  const double all = spectrum.power.sum();
  if (all > 0) {
    const auto first = std::min(static_cast<Eigen::Index>(std::ceil(emgFrom / spectrum.spacing)),
                                spectrum.power.size());
    out.above = spectrum.power.tail(spectrum.power.size() - first).sum() / all;
    out.noiseFrequency = medianOfSecondDifferences(out.values, rate);
  }
  return out;
}

// Runs of three or more samples at one value.
struct Runs {
  double share = 0;     // of all samples
  double meanStep = 0;  // by which they are entered and left
};

Runs runsAt(const Eigen::VectorXd& values, double limit) {
  Runs out;
  double inRuns = 0, steps = 0, sumOfSteps = 0;
  Eigen::Index run = 0;
  const auto step = [&](Eigen::Index i) {
    if (i < 0 || i >= values.size()) return;
    ++steps;
    sumOfSteps += std::abs(values[i] - limit);
  };
  for (Eigen::Index i = 0; i <= values.size(); ++i) {
    if (i < values.size() && values[i] == limit) {
      ++run;
      continue;
    }
    if (run >= 3) {
      inRuns += static_cast<double>(run);
      step(i - run - 1);
      step(i);
    }
    run = 0;
  }
  out.share = inRuns / static_cast<double>(values.size());
  out.meanStep = steps > 0 ? sumOfSteps / steps : 0;
  return out;
}

// The smallest step between neighbours that differ.
double resolutionOf(const Eigen::VectorXd& values) {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 1; i < values.size(); ++i) {
    const double step = std::abs(values[i] - values[i - 1]);
    if (step > 0) least = std::min(least, step);
  }
  return least;
}

void addClipped(const Sight& sight, std::vector<std::string>& out) {
  if (sight.levels < 16) return;
  for (const double limit : {sight.values.maxCoeff(), sight.values.minCoeff()}) {
    const Runs runs = runsAt(sight.values, limit);
    if (!(runs.share > 1e-3)) continue;
    // what comes to rest does so step by step
    const bool measured = sight.use == ChannelUse::measured;
    if (measured && runs.meanStep < 5 * resolutionOf(sight.values)) continue;
    const char* then =
        measured ? "the true values lie beyond: exclude them with clip_above or clip_below"
                 : "the amplifier was at its limit there, and the excitation is too small: record "
                   "with less gain";
    const std::string unit = sight.channel->unit.empty() ? "" : " " + sight.channel->unit;
    out.push_back(
        fmt::format("Channel '{}' looks clipped: {:.2g} % of its samples stay at "
                    "{:.6g}{}; {}.",
                    sight.channel->name, 100 * runs.share, limit, unit, then));
  }
}

void addDead(const Sight& sight, const std::vector<Sight>& all, std::vector<std::string>& out) {
  if (sight.dead()) {
    out.push_back(fmt::format("Channel '{}' looks dead: it has only {} different value{}.",
                              sight.channel->name, sight.levels, sight.levels == 1 ? "" : "s"));
    return;
  }
  if (sight.use != ChannelUse::rawEmg) return;
  std::vector<double> others;
  for (const Sight& other : all) {
    const bool alike = other.use == sight.use && other.channel->unit == sight.channel->unit;
    if (&other != &sight && alike) others.push_back(other.rms);
  }
  if (others.empty()) return;
  const auto middle = others.begin() + static_cast<std::ptrdiff_t>(others.size() / 2);
  std::nth_element(others.begin(), middle, others.end());
  if (!(sight.rms < 0.01 * *middle)) return;
  out.push_back(
      fmt::format("Channel '{}' looks dead: its RMS is {:.3g} {}, {:.2g} % of the other "
                  "electrodes' (cable off, or another unit?).",
                  sight.channel->name, sight.rms, sight.channel->unit, 100 * sight.rms / *middle));
}

bool isSlow(const Sight& sight) {
  return sight.use == ChannelUse::rawEmg && !sight.dead() && sight.above < 0.05;
}

bool isEmgLike(const Sight& sight) {
  return sight.use == ChannelUse::measured && !sight.dead() && sight.above > 0.5;
}

void addSmoothed(const Sight& sight, std::vector<std::string>& out) {
  if (sight.use != ChannelUse::rawEmg || sight.dead()) return;
  const std::string& name = sight.channel->name;
  if (isSlow(sight)) {
    out.push_back(
        fmt::format("Channel '{}' looks like no raw EMG: {:.3g} % of its power lies below "
                    "20 Hz (an envelope? then set signal = \"envelope\").",
                    name, 100 * (1 - sight.above)));
  } else if (sight.values.minCoeff() >= 0) {
    out.push_back(
        fmt::format("Channel '{}' looks rectified: it is never negative; the band-pass of "
                    "a rectified signal is no EMG.",
                    name));
  } else if (sight.noiseFrequency < 150 && sight.channel->rate > 300) {
    out.push_back(
        fmt::format("Channel '{}' looks already low-passed at about {:.3g} Hz: an EMG "
                    "reaches 400 Hz, so its envelope follows fewer of the muscle's "
                    "potentials and is less certain.",
                    name, sight.cutoff()));
  }
}

void addLowPassed(const Sight& sight, std::vector<std::string>& out) {
  if (sight.use != ChannelUse::measured || sight.dead()) return;
  const double rate = sight.channel->rate, at = sight.cutoff();
  if (!(sight.noiseFrequency < lowPassedBelow * whiteNoiseAt * rate)) return;
  out.push_back(
      fmt::format("Channel '{}' looks already low-passed at about {:.3g} Hz: its noise is alike in "
                  "neighbouring "
                  "samples. Only about {:.3g} of its {:.4g} samples per second count; taken as "
                  "independent they "
                  "make standard deviations too small by a factor of about {:.2g}.",
                  sight.channel->name, at, 2 * at, rate, std::sqrt(rate / (2 * at))));
}

double correlationOf(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const Eigen::ArrayXd a = x.array() - x.mean(), b = y.array() - y.mean();
  return (a * b).sum() / std::sqrt(a.square().sum() * b.square().sum());
}

void addPairs(const std::vector<Sight>& all, std::vector<std::string>& out) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (isSlow(all[i]) && isEmgLike(all[k])) {
        out.push_back(
            fmt::format("Channels '{}' and '{}' look swapped: the first is slow, the "
                        "second looks like an EMG.",
                        all[i].channel->name, all[k].channel->name));
      }
      const bool electrodes = k < i && all[i].use == all[k].use && !all[i].dead() &&
                              !all[k].dead() && all[i].use != ChannelUse::measured;
      if (!electrodes || all[i].values.size() != all[k].values.size()) continue;
      const double r = correlationOf(all[i].values, all[k].values);
      if (!(std::abs(r) > 0.999)) continue;
      out.push_back(fmt::format(
          "Channels '{}' and '{}' show the same signal{}: one electrode in two "
          "columns?",
          all[k].channel->name, all[i].channel->name, r < 0 ? " with opposite signs" : ""));
    }
  }
}

}  // namespace

std::vector<std::string> reviewChannels(const std::vector<ReviewedChannel>& channels) {
  std::vector<Sight> all;
  for (const ReviewedChannel& each : channels) all.push_back(sightOf(each));
  std::vector<std::string> out;
  for (const Sight& sight : all) {
    addDead(sight, all, out);
    addClipped(sight, out);
    addSmoothed(sight, out);
    addLowPassed(sight, out);
  }
  addPairs(all, out);
  return out;
}

}  // namespace bio
