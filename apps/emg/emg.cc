#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "bio/emg/emg.h"
#include "bio/emg/emg_config.h"
#include "bio/emg/emg_config_draft.h"
#include "bio/emg/emg_recordings.h"
#include "bio/emg/emg_trial.h"
#include "bio/tables/recording.h"
#include "bio/tables/table_file.h"
#include "command/command.h"
#include "emg/emg_methods.h"
#include "output/json_text.h"
#include "output/text.h"
#include "report/result.h"

namespace app {
namespace {

std::vector<double> listOf(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

// A signal drawn with few points: the smallest and the largest value of every stretch, so that no
// peak is lost.
Series drawn(const std::string& name, const Eigen::VectorXd& values, double rate, double startTime,
             SeriesStyle style = SeriesStyle::line) {
  constexpr Eigen::Index stretches = 1500;
  Series out{.name = name, .x = {}, .y = {}, .style = style, .bandLow = {}, .bandHigh = {}};
  const auto add = [&](Eigen::Index i) {
    out.x.push_back(startTime + static_cast<double>(i) / rate);
    out.y.push_back(values[i]);
  };
  const Eigen::Index length = std::max<Eigen::Index>(values.size() / stretches, 1);
  for (Eigen::Index begin = 0; begin < values.size(); begin += length) {
    const auto part = values.segment(begin, std::min(length, values.size() - begin));
    Eigen::Index low = 0;
    Eigen::Index high = 0;
    part.minCoeff(&low);
    part.maxCoeff(&high);
    add(begin + std::min(low, high));
    if (low != high) add(begin + std::max(low, high));
  }
  return out;
}

Figure electrodeFigure(const bio::ElectrodeTrace& trace) {
  Figure figure{
      .title = fmt::format("Electrode {}", trace.channel),
      .xLabel = "Time [s]",
      .yLabel = fmt::format("EMG [{}]", trace.unit.empty() ? "unit not stated" : trace.unit),
      .series = {},
      .caption =
          fmt::format("Filtered signal and its envelope; {:.4g} {} corresponds to excitation 1.",
                      trace.full, trace.unit)};
  if (trace.filtered.size() > 0) {
    figure.series.push_back(drawn("filtered", trace.filtered, trace.rate, trace.startTime));
  }
  figure.series.push_back(drawn("envelope", trace.envelope, trace.rate, trace.startTime));
  return figure;
}

Table electrodeTable(const bio::EmgResult& result) {
  Table table{"",
              {"electrode", "rate [Hz]", "excitation 1 at", "normalised by", "clipped to 1 [%]",
               "set to 0 [%]"},
              {}};
  for (const bio::ElectrodeTrace& trace : result.electrodes) {
    table.rows.push_back({trace.channel, numberText(trace.rate), withUnit(trace.full, trace.unit),
                          trace.fullSource, numberText(100 * trace.fractionAbove, 2),
                          numberText(100 * trace.fractionBelow, 2)});
  }
  return table;
}

/// Whether the table of electrodes says the same.
bool isInTable(const std::string& remark, const bio::EmgResult& result) {
  return std::any_of(result.electrodes.begin(), result.electrodes.end(),
                     [&](const auto& trace) { return remark == bio::remarkOn(trace); });
}

Figure excitationFigure(const bio::EmgResult& result) {
  Figure figure{.title = "Excitations",
                .xLabel = "Time [s]",
                .yLabel = "Excitation [1]",
                .series = {},
                .caption =
                    "As written to excitations.sto; muscles with the same electrode and weight "
                    "share one curve."};
  for (std::size_t k = 0; k < result.muscles.size(); ++k) {
    figure.series.push_back({.name = result.muscles[k],
                             .x = listOf(result.time),
                             .y = listOf(result.excitations.col(static_cast<Eigen::Index>(k)))});
  }
  return figure;
}

Figure measuredFigure(const bio::MeasuredCoordinate& measured) {
  Figure figure{.title = fmt::format("Measured {}", measured.coordinate),
                .xLabel = "Time [s]",
                .yLabel = "Angle [deg]",
                .series = {},
                .caption = "Gaps: not measured, or at the instrument's limits."};
  Series series{.name = measured.coordinate};
  for (Eigen::Index i = 0; i < measured.angle_deg.size(); ++i) {
    series.x.push_back(measured.startTime + static_cast<double>(i) / measured.rate);
    series.y.push_back(measured.angle_deg[i]);
  }
  figure.series.push_back(std::move(series));
  return figure;
}

class Emg : public Command {
 public:
  About about() const override {
    return {"emg", "Convert a raw EMG recording into a trial of excitations",
            "fisherhill emg emg_data/curl_slow_raw.csv --config emg_data/configs/shipped_raw.toml"};
  }

  void addOptions(CLI::App& options) override {
    options
        .add_option("RAW", recordings_,
                    "raw recording: text columns, exports of Trigno, EMGworks, Noraxon, Nexus, "
                    "Biodex, .sto, .mot, .csv, .c3d, .xdf, .edf, .bdf or .trc; "
                    "further recordings of the same movement ([[recording]])")
        ->required()
        ->check(CLI::ExistingFile)
        ->type_name("");
    options
        .add_option("--config", config_,
                    "configuration: channels, filters, electrodes (docs/emg.md); required unless "
                    "--write-config is given")
        ->check(CLI::ExistingFile)
        ->type_name("C.toml");
    options
        .add_option("--write-config", draft_,
                    "write a configuration to begin with, which lists the channels of RAW, and "
                    "exit; an existing file is not overwritten")
        ->type_name("FILE");
  }

  ExitStatus run(const CommandContext& context) override {
    if (!draft_.empty()) return writeDraft(context);
    if (config_.empty()) {
      throw std::invalid_argument(
          "--config is required; --write-config FILE writes one to begin with");
    }
    OutputFolder folder(context, {"excitations.sto"});
    Summary summary(context);
    for (const std::string& recording : recordings_) summary.addInput(recording);
    summary.addInput(config_);
    const bio::EmgConfigFile file = bio::readEmgConfig(config_);
    for (const bio::FullDeclaration& full : file.full) {
      if (!full.mvcFile.empty()) summary.addInput(full.mvcFile);
    }
    const bio::JoinedRecordings joined = bio::readRecordings(file, recordings_);
    const std::vector<std::string> markers = bio::markerNames(file);
    if (file.markers && !file.markers->model.empty()) summary.addInput(file.markers->model);
    const bio::EmgConfig config = bio::emgConfigFor(file, joined.recording, markers);
    const bio::EmgResult result = bio::excitationsFromEmg(joined.recording, config);
    for (const std::string& warning : result.warnings) summary.warn(warning);
    folder.writeFile("excitations.sto", [&](const std::filesystem::path& path) {
      bio::writeTable(bio::excitationTable(result, config), path);
    });
    summary.set("conversions", config.conversions);
    if (!context.json && !context.quiet) {
      for (const std::string& conversion : config.conversions) fmt::print("Unit: {}\n", conversion);
    }
    tell(joined, result, summary);
    tellUnrecorded(config, summary);
    sayEmg(joined, config, result, summary.methods());
    deliver(context, summary, reportOn(result), folder);
    return ExitStatus::done;
  }

 private:
  ExitStatus writeDraft(const CommandContext& context) const {
    if (!config_.empty()) {
      throw std::invalid_argument("--write-config: --config is given, must be left out");
    }
    if (context.out || context.figures) {
      throw std::invalid_argument(
          "--write-config: writes this one file, --out and --figures must be left out");
    }
    const bio::EmgConfigDraft draft = bio::draftEmgConfig(recordings_);
    bio::writeEmgConfig(draft, draft_);
    if (context.json) {
      const nlohmann::ordered_json found = {{"config", draft_},
                                            {"channels", draft.channels},
                                            {"electrodes", draft.electrodes},
                                            {"is_complete", draft.complete}};
      fmt::print("{}\n", jsonText(found, 2));
      return ExitStatus::done;
    }
    fmt::print("{}: {} channel{}, {} electrode{}. {}\n", draft_, draft.channels,
               draft.channels == 1 ? "" : "s", draft.electrodes, draft.electrodes == 1 ? "" : "s",
               draft.complete ? "Muscles are called as their channels: write those of your model."
                              : "Fill in what its comments call needed.");
    return ExitStatus::done;
  }

  void tell(const bio::JoinedRecordings& joined, const bio::EmgResult& result,
            Summary& summary) const {
    summary.set("format", std::string(bio::nameOf(joined.recording.format)));
    if (!joined.placed.empty()) summary.set("further_recordings", placedIn(joined));
    summary.set("rows", result.time.size());
    summary.set("duration_s", result.time[result.time.size() - 1] - result.time[0]);
    summary.set("muscles", result.muscles);
    nlohmann::ordered_json electrodes = nlohmann::ordered_json::array();
    for (const bio::ElectrodeTrace& trace : result.electrodes) {
      electrodes.push_back({{"channel", trace.channel},
                            {"rate_Hz", trace.rate},
                            {"unit", trace.unit},
                            {"excitation_1_at", trace.full},
                            {"normalised_by", trace.fullSource},
                            {"fraction_clipped_above_1", trace.fractionAbove},
                            {"fraction_set_to_0", trace.fractionBelow}});
    }
    summary.set("electrodes", electrodes);
    summary.set("fraction_of_sums_clipped", result.fractionSumAbove);
    if (result.measured) {
      summary.set("measured_values", (!result.measured_deg.array().isNaN()).count());
      summary.set("measured_fraction_missing", result.measured->notMeasured);
    }
    summary.set("remarks", result.remarks);
  }

  static void tellUnrecorded(const bio::EmgConfig& config, Summary& summary) {
    if (config.unrecorded.empty()) return;
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const bio::UnrecordedMuscle& muscle : config.unrecorded) {
      nlohmann::ordered_json json = {{"muscle", muscle.muscle}, {"excitation", sourceOf(muscle)}};
      if (muscle.latent) {
        json["latent_sd"] = muscle.latent->sd;
        json["knots_s"] = muscle.latent->spacing;
      }
      list.push_back(json);
    }
    summary.set("muscles_without_electrode", list);
  }

  static nlohmann::ordered_json placedIn(const bio::JoinedRecordings& joined) {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const bio::JoinedRecordings::Placed& placed : joined.placed) {
      nlohmann::ordered_json one = {{"file", placed.file}, {"offset_s", placed.offset}};
      if (placed.found) {
        one["correlation"] = placed.found->correlation;
        one["next_best_correlation"] = placed.found->rival;
      }
      out.push_back(one);
    }
    return out;
  }

  Report reportOn(const bio::EmgResult& result) const {
    Report report;
    report.title = fmt::format("Excitations from {}", fmt::join(recordings_, ", "));
    report.verdict =
        fmt::format("{} electrode{} drive{} {}.", result.electrodes.size(),
                    result.electrodes.size() == 1 ? "" : "s",
                    result.electrodes.size() == 1 ? "s" : "", fmt::join(result.muscles, ", "));
    report.mainFigure = excitationFigure(result);
    if (!result.warnings.empty()) {
      report.details.emplace_back(
          Section{"Channels that look wrong", "Look at these before the excitations are used."});
      for (const std::string& warning : result.warnings) {
        report.details.emplace_back(Paragraph{warning});
      }
    }
    report.details.emplace_back(
        Section{"Processing steps and limitations",
                "What was done to the recording, and what its excitations cannot show."});
    for (const std::string& remark : result.remarks)
      if (!isInTable(remark, result)) report.details.emplace_back(Paragraph{remark});
    if (result.measured) {
      report.details.emplace_back(
          Section{"Measured motion", "The angle that simulations will be compared with."});
      report.details.emplace_back(measuredFigure(*result.measured));
    }
    report.details.emplace_back(
        Section{"Electrodes",
                "The signal of every electrode and its envelope, before normalisation: bursts "
                "should stand out of the rest, and the envelope should follow them."});
    report.details.emplace_back(electrodeTable(result));
    for (const bio::ElectrodeTrace& trace : result.electrodes) {
      report.details.emplace_back(electrodeFigure(trace));
    }
    return report;
  }

  std::vector<std::string> recordings_;
  std::string config_;
  std::string draft_;  ///< file to write instead; empty: none
};

}  // namespace

/// `fisherhill emg RAW --config C.toml`: raw EMG to excitations; writes excitations.sto, a trial
/// ready for replay, with the measured coordinate if the configuration names one.
std::unique_ptr<Command> emgCommand() {
  return std::make_unique<Emg>();
}

}  // namespace app
