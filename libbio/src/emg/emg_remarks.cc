#include "emg/emg_remarks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace bio {
namespace {

std::string percent(double fraction) {
  return fmt::format("{:.2g} %", 100 * fraction);
}

std::string listed(const std::vector<std::string>& names) {
  if (names.size() == 1) return names.front();
  return fmt::format("{} and {}", fmt::join(names.begin(), names.end() - 1, ", "), names.back());
}

std::string stages(const EmgConfig& config) {
  if (config.signal == EmgSignal::envelope)
    return "The channels are envelopes and were not filtered";
  std::string out = "Offset removed";
  if (config.bandPass) {
    out += fmt::format(", band-pass {:g}–{:g} Hz", config.bandPass->low, config.bandPass->high);
  }
  if (!config.notch.lines.empty()) {
    out += fmt::format(", notch at {:g} Hz", fmt::join(config.notch.lines, " and "));
    if (config.notch.harmonics > 1) {
      out += fmt::format(" and multiples up to {}", config.notch.harmonics);
    }
  }
  return out + fmt::format(", rectified, low-pass {:g} Hz (all zero-lag Butterworth)",
                           config.envelope.cutoff);
}

void addLimits(const EmgConfig& config, const EmgResult& result, std::vector<std::string>& out) {
  bool anyPercentile = false;
  for (const Electrode& electrode : config.electrodes) {
    anyPercentile = anyPercentile || std::holds_alternative<OwnPercentile>(electrode.full);
    if (electrode.muscles.size() < 2) continue;
    std::vector<std::string> names;
    for (const auto& [muscle, weight] : electrode.muscles) names.push_back(muscle);
    out.push_back(
        fmt::format("One electrode ('{}') drives {}: they share one time course, so this recording "
                    "does not show how they share the load or which of them was active when.",
                    electrode.channel, listed(names)));
  }
  out.push_back(
      fmt::format("Only {} {} an excitation. All other muscles, antagonists included, have none: "
                  "co-contraction is not represented, and torque that balanced an unrecorded "
                  "antagonist is simulated as movement.",
                  listed(result.muscles), result.muscles.size() == 1 ? "has" : "have"));
  if (anyPercentile) {
    out.push_back(
        "Without a maximum voluntary contraction, excitation 1 is a large effort of this recording "
        "and not the muscle's maximum: excitations, and the resulting forces, are determined only "
        "up to a factor.");
  }
}

void addUnrecorded(const EmgConfig& config, std::vector<std::string>& out) {
  for (const UnrecordedMuscle& muscle : config.unrecorded) {
    std::string text =
        fmt::format("{} has no electrode: its excitation is {}", muscle.muscle, sourceOf(muscle));
    if (muscle.latent) {
      text += fmt::format(
          ", which a calibration may correct at knots every {:g} s at most, the log-odds by {:g} "
          "(standard deviation)",
          muscle.latent->spacing, muscle.latent->sd);
    }
    out.push_back(text + ".");
  }
}

}  // namespace

std::string sourceOf(const UnrecordedMuscle& muscle) {
  if (muscle.synergy.empty()) return fmt::format("a constant {:g}", muscle.constant);
  const std::string times = muscle.factor == 1 ? "" : fmt::format("{:g} of ", muscle.factor);
  if (muscle.synergy.size() == 1) {
    return fmt::format("{}that of electrode '{}'", times, muscle.synergy.front().first);
  }
  double sum = 0;
  for (const auto& [channel, weight] : muscle.synergy) sum += weight;
  std::vector<std::string> parts;
  for (const auto& [channel, weight] : muscle.synergy) {
    parts.push_back(fmt::format("{:.3g} of '{}'", weight / sum, channel));
  }
  return fmt::format("{}the mean of {}", times, listed(parts));
}

std::string remarkOn(const ElectrodeTrace& trace) {
  std::string out =
      fmt::format("'{}': {:g} Hz, {:.4g} {} corresponds to excitation 1 ({})", trace.channel,
                  trace.rate, trace.full, trace.unit, trace.fullSource);
  out += fmt::format("; {} of the samples were above and were clipped to 1",
                     percent(trace.fractionAbove));
  if (trace.fractionBelow > 0) {
    out += fmt::format(", {} were below 0 and were set to 0", percent(trace.fractionBelow));
  }
  return out + ".";
}

std::vector<std::string> remarksOn(const Recording& recording, const EmgConfig& config,
                                   const EmgResult& result) {
  std::vector<std::string> out;
  out.push_back(stages(config) + ".");
  for (const ElectrodeTrace& trace : result.electrodes) out.push_back(remarkOn(trace));
  if (config.shape < 0) {
    out.push_back(fmt::format("Excitation = (e^(A·u) − 1)/(e^A − 1) with A = {:g}.", config.shape));
  }
  out.push_back(
      fmt::format("Excitations are delayed by {:g} ms against the EMG and sampled at {:g} Hz.",
                  1000 * config.delay, config.outputRate));
  if (result.fractionSumAbove > 0) {
    out.push_back(fmt::format("{} of the weighted sums were above 1 and were clipped.",
                              percent(result.fractionSumAbove)));
  }
  if (result.measured) {
    out.push_back(
        fmt::format("Measured {}: channel '{}' at {:g} Hz; {} of its samples were at the "
                    "instrument's limits or missing and are not used.",
                    result.measured->coordinate, config.measured->channel, result.measured->rate,
                    percent(result.measured->notMeasured)));
    if (result.measured->rate > config.outputRate) {
      out.push_back(fmt::format(
          "It was low-passed at {:g} Hz or below before rows were taken from it at {:g} Hz.",
          0.4 * config.outputRate, config.outputRate));
    }
  }
  out.insert(out.end(), config.conversions.begin(), config.conversions.end());
  addUnrecorded(config, out);
  addLimits(config, result, out);
  out.insert(out.end(), recording.remarks.begin(), recording.remarks.end());
  return out;
}

}  // namespace bio
