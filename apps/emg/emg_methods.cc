#include "emg/emg_methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "output/text.h"

namespace app {
namespace {

/// "2000 Hz", or "1000 and 2000 Hz"
std::string ratesOf(const std::vector<bio::ElectrodeTrace>& electrodes) {
  std::vector<double> rates;
  for (const bio::ElectrodeTrace& trace : electrodes) rates.push_back(trace.rate);
  std::sort(rates.begin(), rates.end());
  rates.erase(std::unique(rates.begin(), rates.end()), rates.end());
  std::vector<std::string> texts;
  for (const double rate : rates) texts.push_back(numberText(rate));
  return listed(texts) + " Hz";
}

void sayStages(const bio::EmgConfig& config, const bio::EmgResult& result, Methods& methods) {
  const std::string electrodes = counted(result.electrodes.size(), "electrode");
  if (config.signal == bio::EmgSignal::envelope) {
    methods.say(Methods::Part::data,
                fmt::format("Envelopes of the EMG of {}, sampled at {}, were used as they "
                            "were recorded, without any filter.",
                            electrodes, ratesOf(result.electrodes)));
    return;
  }
  methods.say(Methods::Part::data,
              fmt::format("The raw EMG of {} was sampled at {}; the mean of each channel was "
                          "removed.",
                          electrodes, ratesOf(result.electrodes)));
  std::string sentence = "It was ";
  if (config.bandPass) {
    sentence +=
        fmt::format("band-passed from {} to {} Hz (order {}), ", numberText(config.bandPass->low),
                    numberText(config.bandPass->high), config.bandPass->order);
  }
  if (!config.notch.lines.empty()) {
    std::vector<std::string> lines;
    for (const double line : config.notch.lines) lines.push_back(numberText(line));
    sentence += fmt::format(
        "filtered by notches of {} Hz width (order {}) at {} Hz{}, ",
        numberText(config.notch.width), config.notch.order, listed(lines),
        config.notch.harmonics > 1
            ? fmt::format(" and the multiples up to the {}-fold", config.notch.harmonics)
            : "");
  }
  sentence += fmt::format("full-wave rectified and low-passed at {} Hz (order {}).",
                          numberText(config.envelope.cutoff), config.envelope.order);
  methods.say(Methods::Part::data, sentence);
  methods.say(Methods::Part::data,
              "All filters are Butterworth filters that run forward and backward, so that they "
              "have no lag; orders are those of one pass, and −3 dB frequencies those of both "
              "passes together.");
}

/// Electrodes that have one kind of normalisation, and what it is.
std::map<std::string, std::vector<std::string>> normalisations(const bio::EmgConfig& config) {
  std::map<std::string, std::vector<std::string>> electrodes;
  for (const bio::Electrode& electrode : config.electrodes) {
    std::string by;
    if (const auto* mvc = std::get_if<bio::MvcValue>(&electrode.full)) {
      by = mvc->recording.empty()
               ? std::string("the value given for a maximum voluntary contraction")
               : fmt::format(
                     "the largest envelope of a maximum voluntary contraction ({}), "
                     "processed alike",
                     std::filesystem::path(mvc->recording).filename().string());
    } else {
      const double percent = std::get<bio::OwnPercentile>(electrode.full).percent;
      by = percent == 100
               ? std::string("its own largest value in this recording")
               : fmt::format("its own percentile {} in this recording", numberText(percent));
    }
    electrodes[by].push_back(electrode.channel);
  }
  return electrodes;
}

void sayNormalisation(const bio::EmgConfig& config, Methods& methods) {
  const auto electrodes = normalisations(config);
  if (electrodes.size() == 1) {
    methods.say(Methods::Part::data,
                fmt::format("Each envelope was divided by {} and clipped to the range from 0 "
                            "to 1.",
                            electrodes.begin()->first));
  } else {
    std::vector<std::string> parts;
    for (const auto& [by, channels] : electrodes)
      parts.push_back(fmt::format("that of {} by {}", listed(channels), by));
    methods.say(Methods::Part::data,
                fmt::format("The envelopes were divided, {}, and clipped to the range from 0 "
                            "to 1.",
                            fmt::join(parts, ", ")));
  }
  if (config.shape < 0) {
    methods.say(Methods::Part::data,
                fmt::format("The excitation follows the normalised envelope u as "
                            "(exp(A u) − 1)/(exp(A) − 1) with A = {} ({}).",
                            numberText(config.shape), citation(Publication::lloydBesier2003)),
                {Publication::lloydBesier2003});
  } else {
    methods.say(Methods::Part::data, "The excitation is the normalised envelope itself.");
  }
  methods.say(Methods::Part::data,
              config.delay > 0
                  ? fmt::format("It was delayed by {} ms, the electromechanical delay, and "
                                "sampled at {} Hz.",
                                numberText(1000 * config.delay), numberText(config.outputRate))
                  : fmt::format("It was sampled at {} Hz, without a delay.",
                                numberText(config.outputRate)));
  const bool anyPercentile =
      std::any_of(config.electrodes.begin(), config.electrodes.end(), [](const auto& electrode) {
        return std::holds_alternative<bio::OwnPercentile>(electrode.full);
      });
  if (anyPercentile) {
    methods.assume(
        "Excitation 1 is a large effort of this recording where no maximum voluntary contraction "
        "was recorded: excitations, and the forces that follow from them, are determined only up "
        "to a factor.");
  }
}

void sayMapping(const bio::EmgConfig& config, Methods& methods) {
  std::vector<std::string> parts;
  std::map<std::string, int> sources;
  for (const bio::Electrode& electrode : config.electrodes) {
    std::vector<std::string> muscles;
    for (const auto& [muscle, weight] : electrode.muscles) {
      ++sources[muscle];
      muscles.push_back(weight == 1 ? muscle
                                    : fmt::format("{} (weight {})", muscle, numberText(weight)));
    }
    parts.push_back(fmt::format("'{}' drives {}", electrode.channel, listed(muscles)));
  }
  const bool sums = std::any_of(sources.begin(), sources.end(),
                                [](const auto& source) { return source.second > 1; });
  methods.say(Methods::Part::data,
              fmt::format("Of the electrodes, {}{}.", fmt::join(parts, "; "),
                          sums ? "; a muscle with several electrodes has the weighted sum of their "
                                 "excitations, at most 1"
                               : ""));
  for (const bio::UnrecordedMuscle& muscle : config.unrecorded) {
    methods.say(Methods::Part::data,
                fmt::format("The excitation of {}, which has no electrode, is {}.", muscle.muscle,
                            sourceOf(muscle)));
  }
}

void sayMeasured(const bio::Recording& recording, const bio::EmgConfig& config, Methods& methods) {
  std::vector<bio::MeasuredOptions> all = config.columns;
  if (config.measured) all.insert(all.begin(), *config.measured);
  for (const bio::MeasuredOptions& options : all) {
    const double rate = bio::findChannel(recording, options.channel).rate;
    const bio::MeasuredOptions used = bio::withoutAliasing(options, rate, config.outputRate);
    methods.say(
        Methods::Part::data,
        fmt::format("{} is channel '{}', recorded at {} Hz{}.", options.coordinate, options.channel,
                    numberText(rate),
                    used.lowPass ? fmt::format(" and low-passed at {} Hz without lag "
                                               "(Butterworth, order {} of each of two passes)",
                                               numberText(*used.lowPass), used.lowPassOrder)
                                 : ""));
  }
}

void sayRecordings(const bio::JoinedRecordings& joined, Methods& methods) {
  for (const bio::JoinedRecordings::Placed& placed : joined.placed) {
    methods.say(Methods::Part::data,
                fmt::format("{} was shifted by {} s to the time of the first recording, {}.",
                            std::filesystem::path(placed.file).filename().string(),
                            numberText(placed.offset),
                            placed.found ? fmt::format("where both correlate best (correlation {})",
                                                       numberText(placed.found->correlation, 3))
                                         : "as given"));
  }
}

}  // namespace

void sayEmg(const bio::JoinedRecordings& joined, const bio::EmgConfig& config,
            const bio::EmgResult& result, Methods& methods) {
  sayRecordings(joined, methods);
  sayStages(config, result, methods);
  sayNormalisation(config, methods);
  sayMapping(config, methods);
  sayMeasured(joined.recording, config, methods);
  methods.assume(
      "The amplitude of the EMG stands for the neural input of the muscle: amplitude cancellation, "
      "electrode placement, fatigue and crosstalk are not modelled.");
}

}  // namespace app
