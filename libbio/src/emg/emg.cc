#include "bio/emg/emg.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/emg/channel_review.h"
#include "emg/bridged.h"
#include "emg/emg_remarks.h"
#include "model/require.h"

namespace bio {
namespace {

void check(const EmgConfig& config) {
  require(!config.electrodes.empty(),
          "EMG: no electrode is mapped to a muscle, must have at least one");
  require(config.shape >= -3 && config.shape <= 0,
          fmt::format("EMG shape factor A = {}: must lie within -3 and 0", config.shape));
  require(config.delay >= 0 && config.delay <= 0.5,
          fmt::format("electromechanical delay {} s: must lie within 0 and 0.5", config.delay));
  require(config.outputRate > 2 * config.envelope.cutoff && std::isfinite(config.outputRate),
          fmt::format("output rate {} Hz: must be more than twice the envelope's cut-off, {} Hz",
                      config.outputRate, config.envelope.cutoff));
  for (std::size_t i = 0; i < config.electrodes.size(); ++i) {
    const Electrode& electrode = config.electrodes[i];
    for (std::size_t k = 0; k < i; ++k) {
      require(
          electrode.channel != config.electrodes[k].channel,
          fmt::format("EMG channel '{}': is mapped twice, must be mapped once", electrode.channel));
    }
    require(!electrode.muscles.empty(),
            fmt::format("EMG channel '{}': drives no muscle, must drive at least one",
                        electrode.channel));
    for (const auto& [muscle, weight] : electrode.muscles) {
      require(weight > 0 && weight <= 1,
              fmt::format("EMG channel '{}', muscle '{}': weight {}, must be > 0 and ≤ 1",
                          electrode.channel, muscle, weight));
    }
  }
}

void checkUnrecorded(const EmgConfig& config) {
  std::vector<std::string> taken;
  for (const Electrode& electrode : config.electrodes) {
    for (const auto& [muscle, weight] : electrode.muscles) taken.push_back(muscle);
  }
  for (const UnrecordedMuscle& muscle : config.unrecorded) {
    require(std::find(taken.begin(), taken.end(), muscle.muscle) == taken.end(),
            fmt::format("muscle '{}': has an electrode or is given twice, must be once without one",
                        muscle.muscle));
    taken.push_back(muscle.muscle);
    require(
        muscle.factor > 0 && muscle.factor <= 1,
        fmt::format("muscle '{}': factor {}, must be > 0 and ≤ 1", muscle.muscle, muscle.factor));
    require(
        muscle.constant >= 0 && muscle.constant <= 1,
        fmt::format("muscle '{}': constant {}, must be 0 to 1", muscle.muscle, muscle.constant));
    for (const auto& [channel, weight] : muscle.synergy) {
      const bool isKnown =
          std::any_of(config.electrodes.begin(), config.electrodes.end(),
                      [&, &name = channel](const Electrode& e) { return e.channel == name; });
      require(isKnown, fmt::format("muscle '{}': no electrode has the channel '{}', must be one",
                                   muscle.muscle, channel));
      require(weight > 0 && std::isfinite(weight),
              fmt::format("muscle '{}', electrode '{}': weight {}, must be > 0", muscle.muscle,
                          channel, weight));
    }
  }
}

// What counts as 1.
void setFull(const Electrode& electrode, ElectrodeTrace& trace) {
  if (const auto* mvc = std::get_if<MvcValue>(&electrode.full)) {
    trace.full = mvc->value;
    trace.fullSource = fmt::format("maximum voluntary contraction ({})", mvc->source);
  } else {
    const double percent = std::get<OwnPercentile>(electrode.full).percent;
    require(percent > 0 && percent <= 100,
            fmt::format("EMG channel '{}': percentile {}, must be > 0 and ≤ 100", electrode.channel,
                        percent));
    trace.full = percentile(trace.envelope, percent);
    trace.fullSource = fmt::format("percentile {:g} of its own envelope", percent);
  }
  require(trace.full > 0 && std::isfinite(trace.full),
          fmt::format("EMG channel '{}': {} {} ({}) for excitation 1, must be > 0",
                      electrode.channel, trace.full, trace.unit, trace.fullSource));
}

constexpr int mostRows = 10'000'000;

// Rows common to all electrodes and inside the span that was asked for.
Eigen::VectorXd rowTimes(const std::vector<ElectrodeTrace>& traces, const EmgConfig& config) {
  double first = -std::numeric_limits<double>::infinity();
  double last = std::numeric_limits<double>::infinity();
  for (const ElectrodeTrace& trace : traces) {
    first = std::max(first, trace.startTime);
    last = std::min(last,
                    trace.startTime + static_cast<double>(trace.envelope.size() - 1) / trace.rate);
  }
  const double begin = config.start.value_or(first);
  const double end = config.end.value_or(last);
  require(
      begin >= first && end <= last + 1e-9,
      fmt::format(
          "output from {} s to {} s: must lie within the recording of the electrodes, {} s to {} s",
          begin, end, first, last));
  const double count = std::floor((end - begin) * config.outputRate + 1e-6);
  require(count >= 1,
          fmt::format(
              "output from {} s to {} s: has fewer than two rows at {} Hz, must have at least two",
              begin, end, config.outputRate));
  require(count < mostRows,
          fmt::format("output from {} s to {} s at {} Hz: must have at most {} rows", begin, end,
                      config.outputRate, mostRows));
  const auto rows = static_cast<Eigen::Index>(count) + 1;
  return Eigen::VectorXd::NullaryExpr(
      rows, [&](Eigen::Index i) { return begin + static_cast<double>(i) / config.outputRate; });
}

Eigen::MatrixXd columnsAt(const Recording& recording, const EmgConfig& config,
                          const Eigen::VectorXd& times) {
  Eigen::MatrixXd out(times.size(), static_cast<Eigen::Index>(config.columns.size()));
  for (std::size_t k = 0; k < config.columns.size(); ++k) {
    const Channel& channel = findChannel(recording, config.columns[k].channel);
    const MeasuredOptions options =
        withoutAliasing(config.columns[k], channel.rate, config.outputRate);
    out.col(static_cast<Eigen::Index>(k)) =
        angleAtRows(measuredCoordinate(channel, options), times);
  }
  return out;
}

// Columns of the muscles without an electrode.
void addUnrecorded(const EmgConfig& config, const Eigen::MatrixXd& byElectrode, EmgResult& out) {
  for (const UnrecordedMuscle& muscle : config.unrecorded) {
    Eigen::VectorXd rows = Eigen::VectorXd::Constant(out.time.size(), muscle.constant);
    double sum = 0;
    for (const auto& [channel, weight] : muscle.synergy) sum += weight;
    if (sum > 0) rows.setZero();
    for (const auto& [channel, weight] : muscle.synergy) {
      const auto at =
          std::find_if(config.electrodes.begin(), config.electrodes.end(),
                       [&, &name = channel](const Electrode& e) { return e.channel == name; });
      rows += muscle.factor * weight / sum * byElectrode.col(at - config.electrodes.begin());
    }
    out.muscles.push_back(muscle.muscle);
    out.excitations.conservativeResize(Eigen::NoChange, out.excitations.cols() + 1);
    out.excitations.rightCols<1>() = rows.cwiseMin(1.0);  // rounding
  }
}

std::vector<std::string> warningsOn(const Recording& recording, const EmgConfig& config) {
  std::vector<ReviewedChannel> channels;
  const ChannelUse use =
      config.signal == EmgSignal::raw ? ChannelUse::rawEmg : ChannelUse::envelope;
  for (const Electrode& electrode : config.electrodes) {
    channels.push_back({&findChannel(recording, electrode.channel), use});
  }
  const auto add = [&](const MeasuredOptions& options) {
    channels.push_back({&findChannel(recording, options.channel), ChannelUse::measured});
  };
  if (config.measured) add(*config.measured);
  for (const MeasuredOptions& column : config.columns) add(column);
  std::vector<std::string> out = recording.warnings;
  for (const ReviewedChannel& channel : channels) {
    const std::string& name = channel.channel->name;
    const bool further = std::any_of(recording.channels.begin(), recording.channels.end(),
                                     [&](const Channel& c) { return c.name == name + " (2)"; });
    if (!further) continue;
    out.push_back(
        fmt::format("Several channels of {} are called '{}'; the first was used (the further ones "
                    "are '{} (2)' …).",
                    recording.file, name, name));
  }
  const std::vector<std::string> looks = reviewChannels(channels);
  out.insert(out.end(), looks.begin(), looks.end());
  return out;
}

// A channel that was resampled may have gaps that the envelope does not show: up to a quarter of
// the period of its cut-off.
Channel withoutShortGaps(const Channel& channel, const EmgConfig& config) {
  if (channel.largestGap == 0) return channel;
  const double most = 0.25 / config.envelope.cutoff;
  require(
      channel.largestGap <= most,
      fmt::format("EMG channel '{}': no sample for {:.4g} ms, must be at most {:.4g} ms, a quarter "
                  "of the period of the envelope's cut-off, {:g} Hz",
                  channel.name, 1e3 * channel.largestGap, 1e3 * most, config.envelope.cutoff));
  Channel out = channel;
  out.values = bridged(channel.values);
  return out;
}

}  // namespace

MeasuredOptions withoutAliasing(MeasuredOptions options, double rate, double outputRate) {
  const double limit = 0.4 * outputRate;
  if (rate <= outputRate || (options.lowPass && *options.lowPass <= limit)) return options;
  options.lowPass = limit;
  options.lowPassOrder = 6;
  return options;
}

ElectrodeTrace emgEnvelope(const Channel& recorded, const EmgConfig& config) {
  const Channel channel = withoutShortGaps(recorded, config);
  checkWithoutGaps(channel);
  const double length = static_cast<double>(channel.values.size()) / channel.rate;
  require(length * config.envelope.cutoff >= 1,
          fmt::format("EMG channel '{}': {:.3f} s long, must last at least one period of the "
                      "envelope's cut-off, {:.3f} s",
                      channel.name, length, 1 / config.envelope.cutoff));
  ElectrodeTrace out;
  out.channel = channel.name;
  out.unit = channel.unit;
  out.rate = channel.rate;
  out.startTime = channel.startTime;
  if (config.signal == EmgSignal::envelope) {
    out.envelope = channel.values;
    return out;
  }
  try {
    out.offset = channel.values.mean();
    out.filtered = (channel.values.array() - out.offset).matrix();
    if (config.bandPass) out.filtered = bandPassed(out.filtered, channel.rate, *config.bandPass);
    out.filtered = notched(out.filtered, channel.rate, config.notch);
    out.envelope = envelope(out.filtered.cwiseAbs(), channel.rate, config.envelope);
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(fmt::format("EMG channel '{}': {}", channel.name, e.what()));
  }
  return out;
}

EmgResult excitationsFromEmg(const Recording& recording, const EmgConfig& config) {
  check(config);
  checkUnrecorded(config);
  EmgResult out;
  // each electrode by itself, at its own rate
  for (const Electrode& electrode : config.electrodes) {
    ElectrodeTrace trace = emgEnvelope(findChannel(recording, electrode.channel), config);
    setFull(electrode, trace);
    const Clipped clipped = clippedToUnit(trace.envelope / trace.full);
    trace.fractionBelow = clipped.fractionBelow;
    trace.fractionAbove = clipped.fractionAbove;
    trace.excitation =
        clipped.values.unaryExpr([&](double u) { return shapedExcitation(u, config.shape); });
    out.electrodes.push_back(std::move(trace));
    for (const auto& [muscle, weight] : electrode.muscles) {
      if (std::find(out.muscles.begin(), out.muscles.end(), muscle) == out.muscles.end()) {
        out.muscles.push_back(muscle);
      }
    }
  }
  // delayed, on common rows, spread over the muscles
  out.time = rowTimes(out.electrodes, config);
  out.excitations =
      Eigen::MatrixXd::Zero(out.time.size(), static_cast<Eigen::Index>(out.muscles.size()));
  Eigen::MatrixXd byElectrode(out.time.size(), static_cast<Eigen::Index>(out.electrodes.size()));
  for (std::size_t i = 0; i < out.electrodes.size(); ++i) {
    const ElectrodeTrace& trace = out.electrodes[i];
    const Eigen::VectorXd rows = sampledAt(trace.excitation, trace.rate, trace.startTime,
                                           (out.time.array() - config.delay).matrix());
    byElectrode.col(static_cast<Eigen::Index>(i)) = rows;
    for (const auto& [muscle, weight] : config.electrodes[i].muscles) {
      const auto column = std::find(out.muscles.begin(), out.muscles.end(), muscle);
      out.excitations.col(column - out.muscles.begin()) += weight * rows;
    }
  }
  // 1 is exact for a weight of 1; rounding of a sum of weights must not count
  out.fractionSumAbove = (out.excitations.array() > 1 + 1e-12).cast<double>().mean();
  out.excitations = out.excitations.cwiseMin(1.0);
  addUnrecorded(config, byElectrode, out);
  if (config.measured) {
    const Channel& channel = findChannel(recording, config.measured->channel);
    out.measured = measuredCoordinate(
        channel, withoutAliasing(*config.measured, channel.rate, config.outputRate));
    out.measured_deg = angleAtRows(*out.measured, out.time);
  }
  out.columns = columnsAt(recording, config, out.time);
  out.warnings = warningsOn(recording, config);
  out.remarks = remarksOn(recording, config, out);
  return out;
}

}  // namespace bio
