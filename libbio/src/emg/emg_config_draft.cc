#include "bio/emg/emg_config_draft.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "bio/tables/file_error.h"
#include "bio/tables/recording.h"
#include "bio/tables/units.h"
#include "tables/cells.h"
#include "tables/recording_layouts.h"
#include "tables/text_file.h"

namespace bio {
namespace {

/// TOML's basic string.
std::string tomlString(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string siUnitOf(const Channel& channel) {
  const auto unit = knownUnit(channel.unit);
  return unit ? std::string(unit->si) : "";
}

bool isElectrode(const Channel& channel) {
  return siUnitOf(channel) == "V" ||
         (channel.unit.empty() && tables::lowered(channel.name).find("emg") != std::string::npos);
}

/// "TRIlong_uV", "biceps [mV]": the channel's name without the unit.
std::string withoutUnit(const std::string& name) {
  std::size_t end = name.rfind('_');
  if (end != name.npos && end > 0 && knownUnit(name.substr(end + 1))) return name.substr(0, end);
  end = name.find_first_of("[(");
  if (end == name.npos || end == 0) return name;
  end = name.find_last_not_of(' ', end - 1);
  return end == name.npos ? name : name.substr(0, end + 1);
}

/// Names of the points whose coordinates NAME.x, NAME.y and NAME.z are among the channels.
std::set<std::string> pointsIn(const Recording& recording) {
  std::set<std::string> names, points;
  for (const Channel& channel : recording.channels) names.insert(channel.name);
  for (const std::string& name : names) {
    if (!name.ends_with(".x")) continue;
    const std::string point = name.substr(0, name.size() - 2);
    if (names.contains(point + ".y") && names.contains(point + ".z")) points.insert(point);
  }
  return points;
}

std::vector<Channel> signalsIn(const Recording& recording) {
  const std::set<std::string> points = pointsIn(recording);
  std::vector<Channel> signals = recording.channels;
  std::erase_if(signals, [&](const Channel& channel) {
    return channel.name.size() > 2 &&
           points.contains(channel.name.substr(0, channel.name.size() - 2));
  });
  return signals;
}

/// One line of the list of channels.
std::string channelLine(const Channel& channel) {
  double low = INFINITY, high = -INFINITY;
  bool hasGaps = false;
  for (const double value : channel.values) {
    hasGaps = hasGaps || std::isnan(value);
    low = std::fmin(low, value);
    high = std::fmax(high, value);
  }
  return fmt::format("#   {:<24} {:<8} {:g} Hz, {:.4g} to {:.4g} s, {:.4g} to {:.4g}{}\n",
                     tomlString(channel.name), channel.unit.empty() ? "(no unit)" : channel.unit,
                     channel.rate, channel.startTime, endTime(channel), low, high,
                     hasGaps ? ", with gaps" : "");
}

std::string channelList(const Recording& recording, const std::vector<Channel>& signals) {
  std::string text = fmt::format("# Channels of {}:\n", onOneLine(recording.file));
  for (const Channel& channel : signals) text += channelLine(channel);
  const std::set<std::string> points = pointsIn(recording);
  if (!points.empty()) {
    text += fmt::format("# Points ([markers] in docs/emg.md): {}\n",
                        onOneLine(fmt::format("{}", fmt::join(points, ", "))));
  }
  for (const std::string& remark : recording.remarks) text += "# " + onOneLine(remark) + '\n';
  return text;
}

/// A file without a header: what every column is has to be declared.
std::string declarationsOf(const std::vector<RawColumn>& columns, const std::string& table) {
  std::string text;
  for (const RawColumn& column : columns) {
    text += fmt::format(
        "\n[[{}]]\ncolumn = {}              # {} numbers, {:.4g} to {:.4g}\nname = \"column{}\"\n"
        "# rate_Hz =             # needed: the file does not say\n"
        "# unit =                # \"mV\", \"deg\", … of value = scale · number\n# scale = 1\n",
        table, column.number, column.values.size(), column.values.minCoeff(),
        column.values.maxCoeff(), column.number);
  }
  return text;
}

/// Settings of the filters; a band below half the rate of every electrode.
std::string filtersFor(const std::vector<Channel>& electrodes) {
  double rate = 1000;
  for (const Channel& channel : electrodes) rate = std::min(rate, channel.rate);
  const double high = std::round(0.45 * rate);
  const bool hasBand = high > 20;
  return fmt::format(
      "\n[bandpass]\nenabled = {}\nlow_Hz = 20\nhigh_Hz = {:g}           # below half the rate{}\n"
      "\n[notch]\nlines_Hz = []           # of the mains: [50] or [60]\n"
      "\n[envelope]\ncutoff_Hz = 6\n"
      "\n[normalise]\npercentile = 99         # of an electrode's own envelope, which counts as 1\n"
      "\n[excitation]\ndelay_s = 0             # electromechanical delay, 0 to 0.5\n"
      "rate_Hz = 200           # rows per second\n",
      hasBand, hasBand ? high : 450, hasBand ? "" : ", which leaves no band here");
}

std::string electrodesOf(const std::vector<Channel>& electrodes) {
  std::string text =
      "\n# One table per electrode. Its muscles are those of the model that it drives, with "
      "weights "
      "> 0 and ≤ 1.\n# What counts as excitation 1 is the percentile above, or of a maximum "
      "voluntary contraction\n# mvc = 1.2 with unit = \"mV\", or mvc_file = \"max.csv\".\n";
  for (const Channel& channel : electrodes) {
    text += fmt::format(
        "[[electrode]]\nchannel = {}\nmuscles = {{ {} = 1.0 }}  # called as the channel\n\n",
        tomlString(channel.name), tomlString(withoutUnit(channel.name)));
  }
  if (!electrodes.empty()) return text;
  return text +
         "# [[electrode]]\n# channel =             # needed: one of the channels\n"
         "# muscles = { BIClong = 1.0, BRA = 0.8 }\n\n";
}

/// What else may have been measured.
std::string measuredOf(const std::vector<Channel>& signals) {
  std::string text;
  bool hasAngle = false;
  for (const Channel& channel : signals) {
    if (isElectrode(channel)) continue;
    if (siUnitOf(channel) == "rad" && !hasAngle) {
      hasAngle = true;
      text += fmt::format(
          "# The measured angle; take the # away.\n# [measured]\n# channel = {}\n# coordinate = "
          "\"elbow_flexion\"  # of the model\n# sign = 1              # -1 if the reading falls "
          "with flexion\n# zero = 0              # reading at 0°\n\n",
          tomlString(channel.name));
      continue;
    }
    text += fmt::format(
        "# [[column]]\n# channel = {}\n# name =                # of the trial's column, e.g. "
        "\"elbow_flexion.moment\"\n\n",
        tomlString(channel.name));
  }
  return text;
}

}  // namespace

EmgConfigDraft draftEmgConfig(const std::vector<std::string>& recordings) {
  if (recordings.empty()) throw std::invalid_argument("no recording is given");
  EmgConfigDraft draft;
  std::string lists, inputs;
  std::vector<Channel> electrodes, all;
  bool hasHeaders = true;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const std::string& file = recordings[i];
    const RecordingFormat format = detectFormat(file);
    inputs += i == 0 ? fmt::format(
                           "\n[input]\nformat = \"{}\"\nsignal = \"raw\"          # or "
                           "envelope: rectified and smoothed already\n",
                           nameOf(format))
                     : fmt::format(
                           "\n[[recording]]           # {}\nformat = \"{}\"\n"
                           "# offset_s = 0          # needed: what is added to its times "
                           "(0: same clock); or\n# match =               # its channel "
                           "and …\n# with =                # … an earlier one that show "
                           "the same event\n",
                           onOneLine(file), nameOf(format));
    if (format == RecordingFormat::columns) {
      hasHeaders = false;
      const std::vector<RawColumn> columns = readPlainColumns(file);
      draft.channels += static_cast<int>(columns.size());
      inputs += declarationsOf(columns, i == 0 ? "channel" : "recording.channel");
      continue;
    }
    const Recording recording = readRecording(file);
    const std::vector<Channel> signals = signalsIn(recording);
    draft.channels += static_cast<int>(signals.size());
    lists += channelList(recording, signals);
    for (const Channel& channel : signals) {
      all.push_back(channel);
      if (isElectrode(channel)) electrodes.push_back(channel);
    }
  }
  draft.electrodes = static_cast<int>(electrodes.size());
  draft.complete = recordings.size() == 1 && hasHeaders && !electrodes.empty();
  draft.text = fmt::format(
      "# Configuration of `fisherhill emg` for {}.\n# What it says beyond the recording are "
      "defaults; docs/emg.md explains every key.\n{}{}{}{}{}",
      onOneLine(fmt::format("{}", fmt::join(recordings, ", "))), lists, inputs,
      filtersFor(electrodes), electrodesOf(electrodes), measuredOf(all));
  while (draft.text.ends_with("\n\n")) draft.text.pop_back();
  return draft;
}

void writeEmgConfig(const EmgConfigDraft& draft, const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::exists(std::filesystem::symlink_status(file, error))) {
    throw FileError(fmt::format("{}: is there already and is not overwritten", file.string()));
  }
  writeTextFile(file, draft.text);
}

}  // namespace bio
