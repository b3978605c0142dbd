#include "bio/tables/edf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tables/cells.h"
#include "tables/formats/bytes.h"
#include "tables/recording_layouts.h"
#include "tables/text_file.h"

namespace bio {
namespace {

using tables::Bytes;

constexpr std::size_t edfHeader = 256;  // bytes, and again for each signal

// One signal, as the header describes it.
struct EdfSignal {
  std::string label, unit;
  double physicalMin = 0, physicalMax = 0, digitalMin = 0, digitalMax = 0;
  std::size_t samples = 0;  // in a record
  std::size_t offset = 0;   // of its first sample in a record [byte]
  bool isAnnotations() const {
    return label.starts_with("EDF Annotations") || label.starts_with("BDF Annotations");
  }
};

class EdfReader {
 public:
  EdfReader(std::string_view content, const std::string& name)
      : bytes_(name, content), width_(content.front() == '0' ? 2 : 3) {}

  EdfFile read() {
    readHeader();
    readSignals();
    countRecords();
    placeRecords();
    takeChannels();
    return std::move(out_);
  }

 private:
  std::string text(std::size_t at, std::size_t length) const {
    const std::string raw(bytes_.text(at, length, "header"));
    return onOneLine(tables::inUtf8(std::string(tables::trimmed(raw))));
  }
  double number(std::size_t at, std::size_t length, const std::string& what) const {
    const std::string cell = text(at, length);
    double value = 0;
    if (!tables::NumberReader(true).read(cell, value).empty() || !std::isfinite(value)) {
      bytes_.fail(fmt::format("{} = '{}', must be a number", what, cell));
    }
    return value;
  }
  std::size_t count(std::size_t at, std::size_t length, const std::string& what) const {
    const double value = number(at, length, what);
    if (!(value >= 1 && value <= 1e8 && value == std::floor(value))) {
      bytes_.fail(fmt::format("{} = {:g}, must be a whole number ≥ 1", what, value));
    }
    return static_cast<std::size_t>(value);
  }

  void readHeader() {
    bytes_.require(0, edfHeader, "header");
    interrupted_ = text(192, 44).find("+D") == 3;
    data_ = count(184, 8, "bytes of the header");
    promised_ = number(236, 8, "number of records");
    duration_ = number(244, 8, "duration of a record");
    signals_.resize(count(252, 4, "number of signals"));
    bytes_.require(edfHeader, edfHeader * signals_.size(), "header of the signals");
    if (data_ != edfHeader * (signals_.size() + 1)) {
      out_.warnings.push_back(
          fmt::format("The header says that it has {} bytes, {} signals need {}: these were taken.",
                      data_, signals_.size(), edfHeader * (signals_.size() + 1)));
      data_ = edfHeader * (signals_.size() + 1);
    }
  }

  void readSignals() {
    const std::size_t n = signals_.size();
    for (std::size_t k = 0; k < n; ++k) {
      EdfSignal& signal = signals_[k];
      // fields one after another, each for all signals
      const auto at = [&](std::size_t before, std::size_t length) {
        return edfHeader + before * n + k * length;
      };
      signal.label = text(at(0, 16), 16);
      const std::string name = fmt::format("signal {} '{}'", k + 1, signal.label);
      if (signal.label.empty()) signal.label = fmt::format("signal {}", k + 1);
      signal.unit = text(at(96, 8), 8);
      signal.samples = count(at(216, 8), 8, name + ": samples in a record");
      signal.offset = record_;
      record_ += signal.samples * width_;
      if (signal.isAnnotations()) continue;
      signal.physicalMin = number(at(104, 8), 8, name + ": physical minimum");
      signal.physicalMax = number(at(112, 8), 8, name + ": physical maximum");
      signal.digitalMin = number(at(120, 8), 8, name + ": digital minimum");
      signal.digitalMax = number(at(128, 8), 8, name + ": digital maximum");
      if (signal.digitalMin == signal.digitalMax || signal.physicalMin == signal.physicalMax) {
        bytes_.fail(fmt::format("{}: {:g} to {:g} {} as {:g} to {:g}, must be ranges", name,
                                signal.physicalMin, signal.physicalMax, signal.unit,
                                signal.digitalMin, signal.digitalMax));
      }
    }
  }

  void countRecords() {
    const std::size_t held = (bytes_.size() - data_) / record_;
    records_ = held;
    if (promised_ >= 0 && promised_ != static_cast<double>(held)) {
      // what stands behind the last record is none
      const bool more = promised_ < static_cast<double>(held);
      out_.warnings.push_back(
          fmt::format("The header promises {:g} records, the file holds {}: {} were read.",
                      promised_, held, more ? "all that it holds" : "these"));
    }
    if (records_ == 0) bytes_.fail("holds no complete record");
    const auto isData = [](const EdfSignal& s) { return !s.isAnnotations(); };
    if (std::none_of(signals_.begin(), signals_.end(), isData)) {
      bytes_.fail("holds annotations only, a recording needs signals");
    }
    if (!(duration_ > 0)) {
      bytes_.fail(fmt::format("duration of a record = {:g} s, must be > 0", duration_));
    }
  }

  // "+12.5", the time of a record [s], at the start of its annotations
  std::optional<double> stampOf(std::size_t record) const {
    for (const EdfSignal& signal : signals_) {
      if (!signal.isAnnotations()) continue;
      const std::string_view all = bytes_.text(data_ + record * record_ + signal.offset,
                                               signal.samples * width_, "annotations");
      double value = 0;
      const std::string_view stamp = all.substr(0, all.find_first_of("\x14\x15"));
      if (!tables::NumberReader(false).read(stamp, value).empty()) return std::nullopt;
      return value;
    }
    return std::nullopt;
  }

  // Records of an interrupted recording begin when their annotations say.
  void placeRecords() {
    for (std::size_t r = 0; r < records_; ++r)
      starts_.push_back(static_cast<double>(r) * duration_);
    if (!interrupted_) return;
    const std::optional<double> first = stampOf(0);
    double last = -duration_;
    std::size_t gaps = 0;
    for (std::size_t r = 0; r < records_; ++r) {
      const std::optional<double> stamp = stampOf(r);
      if (!first || !stamp || !(*stamp - *first >= last + 0.5 * duration_)) {
        bytes_.fail(
            fmt::format("record {}: has no time stamp behind that of the one before, an "
                        "interrupted recording needs one",
                        r + 1));
      }
      starts_[r] = *stamp - *first;
      if (r > 0 && starts_[r] > last + 1.5 * duration_) ++gaps;
      last = starts_[r];
    }
    if (!(last <= duration_ * (4 * static_cast<double>(records_) + 10))) {
      bytes_.fail(fmt::format("{} records over {:g} s: most are missing, must be there", records_,
                              last + duration_));
    }
    if (gaps > 0) {
      out_.warnings.push_back(fmt::format(
          "The recording was interrupted {} times; nothing was measured in between.", gaps));
    }
  }

  double valueAt(std::size_t at) const {
    const auto bits = static_cast<std::int64_t>(bytes_.uintWithin(at, width_));
    const std::int64_t half = std::int64_t{1} << (8 * width_ - 1);
    return static_cast<double>(bits >= half ? bits - 2 * half : bits);
  }

  void takeChannels() {
    for (const EdfSignal& signal : signals_) {
      if (signal.isAnnotations()) {
        out_.remarks.push_back(fmt::format("Signal '{}' was not read.", signal.label));
        continue;
      }
      Channel channel;
      channel.name = signal.label;
      channel.unit = plainUnit(signal.unit);
      channel.writtenUnit = signal.unit;
      channel.rate = static_cast<double>(signal.samples) / duration_;
      const double gain =
          (signal.physicalMax - signal.physicalMin) / (signal.digitalMax - signal.digitalMin);
      const auto place = [&](std::size_t r) {
        return static_cast<Eigen::Index>(std::llround(starts_[r] * channel.rate));
      };
      const auto length = static_cast<Eigen::Index>(signal.samples);
      channel.values.setConstant(place(records_ - 1) + length,
                                 std::numeric_limits<double>::quiet_NaN());
      for (std::size_t r = 0; r < records_; ++r) {
        const std::size_t begin = data_ + r * record_ + signal.offset;
        for (Eigen::Index i = 0; i < length; ++i) {
          const double number = valueAt(begin + static_cast<std::size_t>(i) * width_);
          channel.values[place(r) + i] = signal.physicalMin + (number - signal.digitalMin) * gain;
        }
      }
      out_.channels.push_back(std::move(channel));
    }
  }

  Bytes bytes_;
  std::size_t width_;  ///< bytes of a number
  bool interrupted_ = false;
  std::size_t data_ = 0;    ///< byte of the first record
  std::size_t record_ = 0;  ///< bytes of a record
  std::size_t records_ = 0;
  double promised_ = 0;  ///< records; −1: not known when it was written
  double duration_ = 0;  ///< of a record [s]
  std::vector<EdfSignal> signals_;
  std::vector<double> starts_;  ///< of the records, behind the first [s]
  EdfFile out_;
};

}  // namespace

bool tables::isEdf(std::string_view bytes) {
  if (bytes.size() < edfHeader) return false;
  if (bytes.starts_with("\xFF"
                        "BIOSEMI"))
    return true;
  const std::string_view length = tables::trimmed(bytes.substr(184, 8));
  const bool digits = !length.empty() && std::all_of(length.begin(), length.end(),
                                                     [](char c) { return c >= '0' && c <= '9'; });
  return bytes.starts_with("0       ") && digits;
}

EdfFile readEdf(const std::filesystem::path& file) {
  return edfFrom(readTextFile(file), file.string());
}

EdfFile edfFrom(std::string_view content, const std::string& name) {
  if (!tables::isEdf(content)) {
    Bytes(name, content).fail("is no EDF or BDF file, must begin with its header");
  }
  return EdfReader(content, name).read();
}

}  // namespace bio
