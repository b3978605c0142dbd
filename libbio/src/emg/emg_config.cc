#include "bio/emg/emg_config.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "bio/model/units.h"
#include "bio/tables/file_error.h"
#include "bio/tables/units.h"
#include "emg/column_units.h"
#include "emg/emg_config_parts.h"
#include "tables/toml_table.h"

namespace bio {
namespace {

const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
const auto finite = [](double x) { return std::isfinite(x); };

int orderOf(TomlTable& table, int standard) {
  const int order = table.integer("order").value_or(standard);
  if (order < 1 || order > 10) table.fail("order", "must be 1 to 10");
  return order;
}

constexpr std::array recordingFormats = {
    RecordingFormat::automatic, RecordingFormat::columns,  RecordingFormat::trigno,
    RecordingFormat::table,     RecordingFormat::c3d,      RecordingFormat::xdf,
    RecordingFormat::trc,       RecordingFormat::emgworks, RecordingFormat::noraxon,
    RecordingFormat::nexus,     RecordingFormat::listing,  RecordingFormat::edf};

RecordingFormat readFormat(TomlTable& table) {
  std::vector<std::string> words;
  for (const RecordingFormat format : recordingFormats) words.emplace_back(nameOf(format));
  const std::string word = table.word("format", words).value_or("automatic");
  for (const RecordingFormat format : recordingFormats) {
    if (word == nameOf(format)) return format;
  }
  return RecordingFormat::automatic;
}

std::vector<ColumnDeclaration> readChannels(TomlTable& owner) {
  std::vector<ColumnDeclaration> out;
  for (TomlTable& channel : owner.tables("channel")) {
    ColumnDeclaration column;
    if (!channel.has("column")) channel.required<double>("column", std::nullopt);
    try {
      column.header = *channel.text("column");
    } catch (const FileError&) {
      column.number = *channel.integer("column");
      if (column.number < 1) channel.fail("column", "columns are counted from 1");
    }
    column.name = channel.text("name").value_or("");
    column.unit = channel.text("unit").value_or("");
    column.rate = channel.number("rate_Hz", positive, "must be > 0");
    column.scale = channel.number(
        "scale", [](double x) { return std::isfinite(x) && x != 0; }, "must not be 0");
    column.offset = channel.number("offset", finite, "must be finite").value_or(0);
    channel.finish();
    out.push_back(column);
  }
  return out;
}

void readInput(TomlTable& root, EmgConfigFile& out) {
  TomlTable input = root.table("input");
  out.layout.format = readFormat(input);
  if (input.word("signal", {"raw", "envelope"}).value_or("raw") == "envelope") {
    out.emg.signal = EmgSignal::envelope;
  }
  input.finish();
  out.layout.columns = readChannels(root);
  for (TomlTable& table : root.tables("recording")) {
    FurtherRecording further;
    further.line = table.line();
    further.layout.format = readFormat(table);
    further.layout.columns = readChannels(table);
    further.offset = table.number("offset_s", finite, "must be finite");
    further.match = table.text("match").value_or("");
    further.with = table.text("with").value_or("");
    further.within = table.number("within_s", positive, "must be > 0");
    if (further.offset && !further.match.empty()) {
      table.fail("offset_s", "must be alone: match finds the offset");
    }
    if (!further.offset) {
      if (further.match.empty()) table.required<double>("offset_s", std::nullopt);
      if (further.with.empty()) table.required<double>("with", std::nullopt);
    }
    table.finish();
    out.further.push_back(std::move(further));
  }
}

void readFilters(TomlTable& root, EmgConfig& emg) {
  if (emg.signal == EmgSignal::envelope) {
    for (const char* key : {"bandpass", "notch", "envelope"}) {
      if (root.has(key)) root.fail(key, "has no effect on a signal that is an envelope");
    }
  }
  TomlTable bandPass = root.table("bandpass");
  BandPassOptions band;
  band.low = bandPass.number("low_Hz", positive, "must be > 0").value_or(band.low);
  band.high = bandPass
                  .number(
                      "high_Hz", [&](double x) { return x > band.low && std::isfinite(x); },
                      fmt::format("must be above low_Hz = {:g}", band.low))
                  .value_or(band.high);
  if (!(band.low < band.high)) {
    bandPass.fail("low_Hz", fmt::format("must be below high_Hz = {:g}", band.high));
  }
  band.order = orderOf(bandPass, band.order);
  emg.bandPass.reset();
  if (bandPass.flag("enabled").value_or(true)) emg.bandPass = band;
  bandPass.finish();

  TomlTable notch = root.table("notch");
  emg.notch.lines = notch.numbers("lines_Hz").value_or(std::vector<double>{});
  emg.notch.harmonics = notch.integer("harmonics").value_or(emg.notch.harmonics);
  if (emg.notch.harmonics < 1) notch.fail("harmonics", "must be ≥ 1 (1 is the line itself)");
  emg.notch.width = notch.number("width_Hz", positive, "must be > 0").value_or(emg.notch.width);
  emg.notch.order = orderOf(notch, emg.notch.order);
  for (const double line : emg.notch.lines) {
    if (!(line > emg.notch.width / 2 && std::isfinite(line))) {
      notch.fail("lines_Hz", fmt::format("{:g} Hz must be > width_Hz/2", line));
    }
  }
  notch.finish();

  TomlTable envelope = root.table("envelope");
  emg.envelope.cutoff =
      envelope.number("cutoff_Hz", positive, "must be > 0").value_or(emg.envelope.cutoff);
  emg.envelope.order = orderOf(envelope, emg.envelope.order);
  envelope.finish();
}

const auto percentRange = [](double x) { return x > 0 && x <= 100; };

void readElectrodes(TomlTable& root, EmgConfigFile& out) {
  TomlTable normalise = root.table("normalise");
  const double standard =
      normalise.number("percentile", percentRange, "must be > 0 and ≤ 100").value_or(99);
  normalise.finish();
  for (TomlTable& table : root.tables("electrode")) {
    Electrode electrode;
    electrode.channel = table.required("channel", table.text("channel"));
    electrode.muscles = table.weights("muscles");
    if (electrode.muscles.empty()) table.fail("muscles", "must name at least one muscle");
    for (const auto& [muscle, weight] : electrode.muscles) {
      if (!(weight > 0 && weight <= 1)) {
        table.fail("muscles", fmt::format("weight of '{}' must be > 0 and ≤ 1", muscle));
      }
    }
    FullDeclaration full;
    full.mvc = table.number("mvc", positive, "must be > 0");
    full.unit = table.text("unit").value_or("");
    full.mvcFile = table.text("mvc_file").value_or("");
    full.percentile = table.number("percentile", percentRange, "must be > 0 and ≤ 100");
    if (full.mvc.has_value() + !full.mvcFile.empty() + full.percentile.has_value() > 1) {
      table.fail(full.mvc ? "mvc" : "mvc_file",
                 "only one of mvc, mvc_file and percentile can be given");
    }
    if (full.mvc && full.unit.empty()) table.fail("mvc", "needs its unit (unit = \"mV\")");
    if (!full.mvc && !full.unit.empty()) table.fail("unit", "is the unit of mvc, which is absent");
    if (!full.mvcFile.empty()) {
      full.mvcFile = (std::filesystem::path(out.file).parent_path() / full.mvcFile).string();
    }
    if (!full.mvc && full.mvcFile.empty() && !full.percentile) full.percentile = standard;
    table.finish();
    out.emg.electrodes.push_back(electrode);
    out.full.push_back(full);
    out.electrodeLines.push_back(table.line());
  }
  if (out.emg.electrodes.empty()) {
    throw FileError(
        fmt::format("{}: needs at least one [[electrode]] with channel and muscles", out.file));
  }
}

void readExcitation(TomlTable& root, EmgConfig& emg) {
  TomlTable table = root.table("excitation");
  emg.delay =
      table
          .number(
              "delay_s", [](double x) { return x >= 0 && x <= 0.5; }, "must lie within 0 and 0.5 s")
          .value_or(emg.delay);
  emg.shape =
      table
          .number(
              "shape", [](double x) { return x >= -3 && x <= 0; }, "must lie within -3 and 0")
          .value_or(emg.shape);
  emg.outputRate =
      table
          .number(
              "rate_Hz", [&](double x) { return x > 2 * emg.envelope.cutoff && std::isfinite(x); },
              fmt::format("must be more than twice the envelope's cutoff_Hz = {:g}",
                          emg.envelope.cutoff))
          .value_or(emg.outputRate);
  emg.start = table.number("start_s", finite, "must be finite");
  emg.end = table.number("end_s", finite, "must be finite");
  if (emg.start && emg.end && !(*emg.start < *emg.end)) {
    table.fail("end_s", fmt::format("must be after start_s = {:g}", *emg.start));
  }
  table.finish();
}

void readMeasured(TomlTable& root, EmgConfigFile& out) {
  if (!root.has("measured")) return;
  TomlTable table = root.table("measured");
  MeasuredOptions options;
  options.channel = table.required("channel", table.text("channel"));
  options.coordinate = table.text("coordinate").value_or(options.coordinate);
  out.degreesPerUnit = table.number("degrees_per_unit", positive, "must be > 0 (see sign)");
  options.sign = table
                     .number(
                         "sign", [](double x) { return x == 1 || x == -1; }, "must be 1 or -1")
                     .value_or(options.sign);
  options.zero = table.number("zero", finite, "must be finite").value_or(options.zero);
  options.clipBelow =
      table.number("clip_below", finite, "must be finite").value_or(options.clipBelow);
  options.clipAbove = table
                          .number(
                              "clip_above", [&](double x) { return x > options.clipBelow; },
                              fmt::format("must be above clip_below = {:g}", options.clipBelow))
                          .value_or(options.clipAbove);
  options.lowPass = table.number("lowpass_Hz", positive, "must be > 0");
  table.finish();
  out.measuredLine = table.line();
  out.emg.measured = options;
}

void readColumns(TomlTable& root, EmgConfigFile& out) {
  for (TomlTable& table : root.tables("column")) {
    MeasuredOptions options;
    options.channel = table.required("channel", table.text("channel"));
    options.coordinate = table.required("name", table.text("name"));
    const double scale =
        table
            .number(
                "scale", [](double x) { return std::isfinite(x) && x != 0; }, "must not be 0")
            .value_or(1);
    out.columnScales.push_back(std::abs(scale) != 1);
    const double offset = table.number("offset", finite, "must be finite").value_or(0);
    options.degreesPerUnit = std::abs(scale);
    options.sign = scale < 0 ? -1 : 1;
    options.zero = -offset / scale;
    options.lowPass = table.number("lowpass_Hz", positive, "must be > 0");
    table.finish();
    if (options.coordinate.empty() || options.coordinate == "time" ||
        options.coordinate.find_first_of("\t\",") != std::string::npos) {
      table.fail("name", "must be a name without tab, comma or quote, and not 'time'");
    }
    out.columnLines.push_back(table.line());
    out.emg.columns.push_back(options);
  }
}

const Channel& channelAt(const EmgConfigFile& config, int line, const Recording& recording,
                         const std::string& name) {
  try {
    return findChannel(recording, name);
  } catch (const std::invalid_argument& e) {
    throw FileError(fmt::format("{}:{}: {}", config.file, line, e.what()));
  }
}

// A contraction's envelope in `unit` as one in the unit of the channel.
double envelopeIn(const Channel& channel, double envelope, const std::string& unit,
                  const std::string& source, std::vector<std::string>& conversions) {
  if (areSameUnit(unit, channel.unit)) return envelope;
  const auto given = knownUnit(unit), its = knownUnit(channel.unit);
  if (!given || !its || given->si != its->si) {
    throw FileError(fmt::format("{} {}, but channel '{}' is in '{}'", source, unit, channel.name,
                                channel.unit));
  }
  conversions.push_back(fmt::format("{}: its maximum contraction, {:.4g} {}, was converted to {}.",
                                    channel.name, envelope, unit, channel.unit));
  return envelope * given->factor / its->factor;
}

MvcValue mvcFromFile(const EmgConfigFile& config, std::size_t i, const Channel& its,
                     std::vector<std::string>& conversions) {
  const std::string& file = config.full[i].mvcFile;
  const Recording recording = readRecording(file, config.layout);
  const Channel& channel =
      channelAt(config, config.electrodeLines[i], recording, config.emg.electrodes[i].channel);
  const double most = emgEnvelope(channel, config.emg).envelope.maxCoeff();
  const std::string source = fmt::format("{}:{}: mvc_file {} has {:.4g}", config.file,
                                         config.electrodeLines[i], file, most);
  return {envelopeIn(its, most, channel.unit, source, conversions), "from " + file, file};
}

}  // namespace

EmgConfigFile readEmgConfig(const std::string& file) {
  EmgConfigFile out;
  out.file = file;
  TomlTable root = TomlTable::read(file);
  readInput(root, out);
  readFilters(root, out.emg);
  readElectrodes(root, out);
  readExcitation(root, out.emg);
  readMeasured(root, out);
  readColumns(root, out);
  readUnrecorded(root, out);
  readMarkers(root, out);
  root.finish();
  return out;
}

EmgConfig emgConfigFor(const EmgConfigFile& config, const Recording& recording,
                       const std::vector<std::string>& markers) {
  EmgConfig out = config.emg;
  for (std::size_t i = 0; i < out.electrodes.size(); ++i) {
    const FullDeclaration& full = config.full[i];
    const int line = config.electrodeLines[i];
    const Channel& channel = channelAt(config, line, recording, out.electrodes[i].channel);
    if (full.mvc) {
      const std::string at = fmt::format("{}:{}", config.file, line);
      const std::string source = fmt::format("{}: mvc = {:g}", at, *full.mvc);
      out.electrodes[i].full =
          MvcValue{envelopeIn(channel, *full.mvc, full.unit, source, out.conversions), at};
    } else if (!full.mvcFile.empty()) {
      out.electrodes[i].full = mvcFromFile(config, i, channel, out.conversions);
    } else {
      out.electrodes[i].full = OwnPercentile{full.percentile.value()};
    }
  }
  for (std::size_t k = 0; k < out.columns.size(); ++k) {
    const Channel& channel =
        channelAt(config, config.columnLines[k], recording, out.columns[k].channel);
    try {
      const std::string said = config.columnScales[k] ? scaledUnit(channel, out.columns[k])
                                                      : setUnit(channel, out.columns[k]);
      if (!said.empty()) out.conversions.push_back(said);
    } catch (const std::invalid_argument& rule) {
      throw FileError(
          fmt::format("{}:{}: column {}", config.file, config.columnLines[k], rule.what()));
    }
  }
  addMarkerColumns(config, recording, markers, out);
  if (out.measured) {
    const Channel& channel =
        channelAt(config, config.measuredLine, recording, out.measured->channel);
    const auto unit = knownUnit(channel.unit);
    const bool isAngle = unit && unit->si == "rad";
    if (config.degreesPerUnit && isAngle) {
      throw FileError(fmt::format(
          "{}:{}: degrees_per_unit = {:g}, but channel '{}' is an angle in {}", config.file,
          config.measuredLine, *config.degreesPerUnit, channel.name, channel.unit));
    }
    if (!config.degreesPerUnit && !isAngle) {
      throw FileError(fmt::format("{}:{}: channel '{}' is in '{}', needs degrees_per_unit",
                                  config.file, config.measuredLine, channel.name, channel.unit));
    }
    const bool degrees = isAngle && unit->name == "deg";
    out.measured->degreesPerUnit =
        config.degreesPerUnit.value_or(isAngle && !degrees ? unit->factor * degreesPerRadian : 1.0);
  }
  return out;
}

}  // namespace bio
