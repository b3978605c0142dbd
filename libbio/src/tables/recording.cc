#include "bio/tables/recording.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "bio/tables/edf_file.h"
#include "bio/tables/file_error.h"
#include "bio/tables/units.h"
#include "tables/cells.h"
#include "tables/formats/c3d_parameters.h"
#include "tables/formats/foreign_format.h"
#include "tables/formats/xdf_chunks.h"
#include "tables/recording_layouts.h"
#include "tables/text_file.h"

namespace bio {
namespace {

std::vector<RawColumn> readColumns(const std::string& file, RecordingFormat format,
                                   ReadingNotes& notes) {
  switch (format) {
    case RecordingFormat::c3d:
      return readC3dColumns(file, notes);
    case RecordingFormat::xdf:
      return readXdfColumns(file, notes);
    case RecordingFormat::edf:
      return readEdfColumns(file, notes);
    case RecordingFormat::trc:
      return readTrcColumns(file, notes);
    case RecordingFormat::columns:
      return readPlainColumns(file);
    case RecordingFormat::trigno:
      return readTrigno(file, notes);
    case RecordingFormat::emgworks:
      return readEmgworks(file, notes);
    case RecordingFormat::noraxon:
      return readNoraxon(file, notes);
    case RecordingFormat::nexus:
      return readNexus(file, notes);
    case RecordingFormat::listing:
      return readListing(file, notes);
    default:
      return readTableColumns(file, notes);
  }
}

bool namesItsChannels(RecordingFormat format) {
  return format == RecordingFormat::c3d || format == RecordingFormat::xdf ||
         format == RecordingFormat::trc || format == RecordingFormat::edf;
}

// Names are what configurations refer to: further channels of one name are numbered.
void numberAlike(std::vector<RawColumn>& columns, ReadingNotes& notes) {
  std::map<std::string, int> uses;
  std::set<std::string> taken;
  for (const RawColumn& column : columns) taken.insert(column.header);
  for (RawColumn& column : columns) {
    const std::string header = column.header;
    if (header.empty() || ++uses[header] == 1) continue;
    int number = uses[header];
    do {
      column.header = fmt::format("{} ({})", header, number++);
    } while (!taken.insert(column.header).second);
    uses[header] = number - 1;
  }
  for (const auto& [header, count] : uses) {
    if (count < 2) continue;
    notes.remarks.push_back(fmt::format(
        "Several channels are called '{0}': the first is '{0}', the further ones are '{0} (2)' …",
        header));
  }
}

std::string calledIn(const RawColumn& column) {
  return column.header.empty() ? fmt::format("column {}", column.number)
                               : fmt::format("column {} '{}'", column.number, column.header);
}

const ColumnDeclaration* declarationOf(const RawColumn& column, const RecordingLayout& layout) {
  for (const ColumnDeclaration& declared : layout.columns) {
    if (declared.number == column.number) return &declared;
    if (declared.number == 0 && !column.header.empty() && declared.header == column.header) {
      return &declared;
    }
  }
  return nullptr;
}

// Every declared column must be in the file, once.
void checkDeclarations(const std::string& file, const std::vector<RawColumn>& columns,
                       const RecordingLayout& layout) {
  for (const ColumnDeclaration& declared : layout.columns) {
    const auto matches =
        std::count_if(columns.begin(), columns.end(), [&](const RawColumn& column) {
          return column.number == declared.number ||
                 (declared.number == 0 && column.header == declared.header);
        });
    if (matches == 1) continue;
    std::vector<std::string> names;
    for (const RawColumn& column : columns) names.push_back(calledIn(column));
    throw FileError(fmt::format("{}: {} is declared, but the file has {}", file,
                                declared.number > 0 ? fmt::format("column {}", declared.number)
                                                    : fmt::format("column '{}'", declared.header),
                                fmt::join(names, ", ")));
  }
}

Channel channelOf(const std::string& file, const RawColumn& column,
                  const ColumnDeclaration& declared) {
  const auto fail = [&](const std::string& what) {
    throw FileError(fmt::format("{}: {}: {}", file, calledIn(column), what));
  };
  Channel channel;
  channel.name = !declared.name.empty() ? declared.name : column.header;
  if (channel.name.empty()) channel.name = fmt::format("column {}", column.number);
  channel.startTime = column.startTime;
  // the file's rate and unit stand unless it is silent
  channel.rate = column.rate;
  if (declared.rate) {
    if (!(*declared.rate > 0 && std::isfinite(*declared.rate))) {
      fail(fmt::format("declared rate {} Hz, must be > 0", *declared.rate));
    }
    if (column.rate > 0 && std::abs(*declared.rate / column.rate - 1) > 1e-3) {
      fail(
          fmt::format("declared rate {} Hz, but the file says {} Hz", *declared.rate, column.rate));
    }
    if (column.rate <= 0) channel.rate = *declared.rate;
  }
  if (!(channel.rate > 0)) fail("has no rate in the file and none is declared (rate_Hz)");
  channel.nominalRate = column.nominalRate;
  channel.largestGap = column.largestGap;
  channel.unit = !declared.unit.empty() ? plainUnit(declared.unit) : column.unit;
  double toDeclared = 1;  // mV of the file as the V that is declared
  if (!column.unit.empty() && !areSameUnit(channel.unit, column.unit) && !declared.scale) {
    const auto from = knownUnit(column.unit), to = knownUnit(channel.unit);
    if (from && to && from->si == to->si) toDeclared = from->factor / to->factor;
  }
  if (!column.unit.empty() && !areSameUnit(channel.unit, column.unit) && !declared.scale &&
      toDeclared == 1) {
    fail(fmt::format("declared unit '{}', but the file says '{}' (give a scale to convert)",
                     channel.unit, column.unit));
  }
  if (column.values.size() < 2) {
    fail(fmt::format("has {} values, a recording needs at least 2", column.values.size()));
  }
  const double scale = declared.scale.value_or(toDeclared);
  if (!std::isfinite(scale) || scale == 0) fail(fmt::format("scale {}, must not be 0", scale));
  channel.values = (scale * column.values.array() + declared.offset).matrix();
  return channel;
}

}  // namespace

double endTime(const Channel& channel) {
  return channel.startTime + static_cast<double>(channel.values.size() - 1) / channel.rate;
}

std::string_view nameOf(RecordingFormat format) {
  switch (format) {
    case RecordingFormat::columns:
      return "columns";
    case RecordingFormat::trigno:
      return "trigno";
    case RecordingFormat::table:
      return "table";
    case RecordingFormat::c3d:
      return "c3d";
    case RecordingFormat::xdf:
      return "xdf";
    case RecordingFormat::trc:
      return "trc";
    case RecordingFormat::emgworks:
      return "emgworks";
    case RecordingFormat::noraxon:
      return "noraxon";
    case RecordingFormat::nexus:
      return "nexus";
    case RecordingFormat::listing:
      return "listing";
    case RecordingFormat::edf:
      return "edf";
    default:
      return "automatic";
  }
}

RecordingFormat detectFormat(const std::string& file) {
  {
    const std::string bytes = readTextFile(file);
    if (file.ends_with(".xdf") || tables::isXdf(bytes)) return RecordingFormat::xdf;
    if (file.ends_with(".c3d") || tables::isC3d(bytes)) return RecordingFormat::c3d;
    if (tables::isEdf(bytes)) return RecordingFormat::edf;
    std::string_view text = bytes;
    while (text.starts_with(tables::byteOrderMark))
      text.remove_prefix(tables::byteOrderMark.size());
    if (tables::trimmed(text.substr(0, 200)).starts_with("PathFileType")) {
      return RecordingFormat::trc;
    }
    const std::string foreign = tables::foreignFormat(file, bytes);
    if (!foreign.empty()) throw FileError(foreign);
  }
  const std::vector<std::string> lines = linesOf(file);
  if (isNexus(lines)) return RecordingFormat::nexus;
  if (discoverRates(lines) > 0) return RecordingFormat::trigno;
  // line 7 of a Trigno export: nothing but rates
  if (lines.size() >= 7) {
    const std::vector<std::string> rates = cellsOf(lines[6], ',');
    const auto isRate = [](const std::string& cell) { return cell.ends_with("Hz"); };
    if (std::all_of(rates.begin(), rates.end(), isRate)) return RecordingFormat::trigno;
  }
  if (emgworksNames(lines) > 0) return RecordingFormat::emgworks;
  if (noraxonNames(lines) > 0) return RecordingFormat::noraxon;
  if (listingNames(lines) > 0) return RecordingFormat::listing;
  // first line with anything in it: nothing but numbers
  for (const std::string& line : lines) {
    std::string cells = line;
    for (char& c : cells) {
      if (c == '\t' || c == ',' || c == ';') c = ' ';
    }
    bool any = false;
    bool onlyNumbers = true;
    for (const std::string& cell : cellsOf(cells, ' ')) {
      if (cell.empty()) continue;
      any = true;
      onlyNumbers = onlyNumbers && isNumber(cell);
    }
    if (any) return onlyNumbers ? RecordingFormat::columns : RecordingFormat::table;
  }
  throw FileError(fmt::format("{}: has only empty lines", file));
}

Recording readRecording(const std::string& file, const RecordingLayout& layout) {
  Recording out;
  out.file = file;
  out.format = layout.format == RecordingFormat::automatic ? detectFormat(file) : layout.format;
  ReadingNotes notes;
  std::vector<RawColumn> columns = readColumns(file, out.format, notes);
  numberAlike(columns, notes);
  out.remarks = std::move(notes.remarks);
  out.warnings = std::move(notes.warnings);
  checkDeclarations(file, columns, layout);
  for (RawColumn& column : columns) {
    const ColumnDeclaration* declared = declarationOf(column, layout);
    const std::string written = column.unit;
    column.unit = plainUnit(written);
    if (declared == nullptr && out.format == RecordingFormat::columns) {
      out.remarks.push_back(fmt::format(
          "Column {} is not declared in the configuration and was not read.", column.number));
      continue;
    }
    if (declared == nullptr && column.values.size() < 2) {
      out.remarks.push_back(fmt::format("{} holds no signal and was not read.", calledIn(column)));
      continue;
    }
    out.channels.push_back(channelOf(file, column, declared ? *declared : ColumnDeclaration{}));
    if (out.channels.back().unit == column.unit) out.channels.back().writtenUnit = written;
  }
  // names are what configurations refer to
  for (std::size_t i = 0; i < out.channels.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (out.channels[i].name == out.channels[k].name) {
        throw FileError(fmt::format("{}: two channels are called '{}'; declare other names", file,
                                    out.channels[i].name));
      }
    }
  }
  if (out.channels.empty() && namesItsChannels(out.format)) {
    throw FileError(fmt::format("{}: holds no {}, a recording needs some", file,
                                out.format == RecordingFormat::xdf
                                    ? "stream of numbers at a steady rate"
                                    : "analog channels or points that were seen"));
  }
  if (out.channels.empty() && out.format != RecordingFormat::columns) {
    throw FileError(
        fmt::format("{}: none of its columns holds a signal, a recording needs some", file));
  }
  if (out.channels.empty()) {
    throw FileError(
        fmt::format("{}: no channel is declared; a file without a header needs its "
                    "columns declared ([[channel]])",
                    file));
  }
  return out;
}

const Channel& findChannel(const Recording& recording, const std::string& name) {
  std::vector<std::string> names;
  for (const Channel& channel : recording.channels) {
    if (channel.name == name) return channel;
    names.push_back(fmt::format("'{}'", channel.name));
  }
  throw std::invalid_argument(fmt::format("{}: no channel '{}'; the file has {}", recording.file,
                                          name, fmt::join(names, ", ")));
}

}  // namespace bio
