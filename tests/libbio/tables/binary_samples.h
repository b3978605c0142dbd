#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// Small C3D and XDF files, written from their specifications and independent of the readers.
namespace support {

enum class Processor : std::uint8_t { intel = 84, dec = 85, mips = 86 };

/// Bytes of numbers as a processor writes them.
class BinaryWriter {
 public:
  explicit BinaryWriter(Processor processor = Processor::intel) : processor_(processor) {}
  std::string bytes;

  void u8(unsigned value) { bytes.push_back(static_cast<char>(value & 0xFF)); }
  void u16(unsigned value) { whole(value, 2); }
  void u32(std::uint32_t value) { whole(value, 4); }
  void f64(double value) { whole(std::bit_cast<std::uint64_t>(value), 8); }
  void f32(float value) {
    if (processor_ != Processor::dec) return whole(std::bit_cast<std::uint32_t>(value), 4);
    // F_floating: 0.1fraction·2^(exponent − 128), the word with the sign first
    int exponent = 0;
    const double part = std::frexp(std::abs(static_cast<double>(value)), &exponent);
    std::uint32_t bits = 0;
    if (value != 0) {
      const auto fraction = static_cast<std::uint32_t>(std::ldexp(2 * part - 1, 23));
      bits =
          static_cast<std::uint32_t>(exponent + 128) << 23 | fraction | (value < 0 ? 1U << 31 : 0);
    }
    u16(bits >> 16);
    u16(bits & 0xFFFF);
  }
  void text(const std::string& value, std::size_t length) {
    std::string filled = value;
    filled.resize(length, ' ');
    bytes += filled;
  }
  void fillTo(std::size_t size) { bytes.resize(std::max(size, bytes.size()), '\0'); }
  void fillBlock() { fillTo((bytes.size() + 511) / 512 * 512); }

 private:
  void whole(std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) {
      const int k = processor_ == Processor::mips ? count - 1 - i : i;
      u8(static_cast<unsigned>(value >> (8 * k)));
    }
  }
  Processor processor_;
};

/// A C3D file of points and analog channels.
struct C3dSample {
  struct Parameter {
    std::string group, name;
    int type = 2;  // bytes, −1: text
    std::vector<unsigned> dimensions;
    std::vector<double> numbers;
    std::string text;
  };
  Processor processor = Processor::intel;
  bool floats = false;
  float pointScale = 0.1F;
  unsigned points = 2, channels = 2, samplesPerFrame = 4, frames = 5, firstFrame = 1;
  float rate = 100;
  std::vector<Parameter> more;       // behind the usual ones
  std::vector<std::string> without;  // names of usual ones that are left out
  /// Instead of the usual positions, in floats, and which are seen.
  std::function<double(unsigned frame, unsigned point, unsigned axis)> position = {};
  std::function<bool(unsigned frame, unsigned point)> isSeen = {};

  /// Numbers as they stand in the file: coordinate `axis` of a point, sample of a channel.
  static int pointNumber(unsigned frame, unsigned point, unsigned axis) {
    return static_cast<int>(100 * frame + 10 * point + axis) - 150;
  }
  static int analogNumber(unsigned frame, unsigned sample, unsigned channel) {
    return static_cast<int>(40 * frame + 10 * sample + channel) - 77;
  }
  static bool seen(unsigned frame, unsigned point) { return !(frame == 2 && point == 1); }

  static Parameter textOf(const std::string& group, const std::string& name,
                          const std::vector<std::string>& texts, unsigned length = 8) {
    Parameter out{group, name, -1, {length, static_cast<unsigned>(texts.size())}, {}, {}};
    for (std::string text : texts) {
      text.resize(length, ' ');
      out.text += text;
    }
    return out;
  }
  static Parameter wholeOf(const std::string& group, const std::string& name,
                           const std::vector<double>& numbers) {
    return {group, name, 2, {static_cast<unsigned>(numbers.size())}, numbers, {}};
  }
  static Parameter realOf(const std::string& group, const std::string& name,
                          const std::vector<double>& numbers) {
    return {group, name, 4, {static_cast<unsigned>(numbers.size())}, numbers, {}};
  }
  static Parameter scalarOf(const std::string& group, const std::string& name, int type,
                            double value) {
    return {group, name, type, {}, {value}, {}};
  }

  std::string write() const {
    BinaryWriter parameters = parameterSection(0);
    const auto data = static_cast<unsigned>(2 + parameters.bytes.size() / 512);
    parameters = parameterSection(data);
    BinaryWriter out(processor);
    out.u8(2);
    out.u8(0x50);
    out.u16(points);
    out.u16(channels * samplesPerFrame);
    out.u16(firstFrame);
    out.u16(std::min(firstFrame + frames - 1, 65535U));
    out.u16(10);
    out.f32(scale());
    out.u16(data);
    out.u16(samplesPerFrame);
    out.f32(rate);
    out.fillTo(512);
    out.bytes += parameters.bytes;
    for (unsigned f = 0; f < frames; ++f) writeFrame(out, f);
    return out.bytes;
  }

 private:
  float scale() const { return floats ? -pointScale : pointScale; }
  void value(BinaryWriter& out, int number, float factor) const {
    if (floats) {
      out.f32(static_cast<float>(number) * factor);
    } else {
      out.u16(static_cast<unsigned>(number));
    }
  }
  void writeFrame(BinaryWriter& out, unsigned f) const {
    for (unsigned p = 0; p < points; ++p) {
      for (unsigned axis = 0; axis < 3; ++axis) {
        if (position) {
          out.f32(static_cast<float>(position(f, p, axis)));
        } else {
          value(out, pointNumber(f, p, axis), 0.5F);
        }
      }
      value(out, (isSeen ? isSeen(f, p) : seen(f, p)) ? 0x0302 : -1, 1);
    }
    for (unsigned s = 0; s < samplesPerFrame; ++s) {
      for (unsigned c = 0; c < channels; ++c) value(out, analogNumber(f, s, c), 1);
    }
  }

  BinaryWriter parameterSection(unsigned data) const {
    std::vector<Parameter> all = {
        scalarOf("POINT", "USED", 2, points),
        scalarOf("POINT", "SCALE", 4, static_cast<double>(scale())),
        scalarOf("POINT", "RATE", 4, static_cast<double>(rate)),
        scalarOf("POINT", "DATA_START", 2, data),
        scalarOf("POINT", "FRAMES", 2, frames),
        textOf("POINT", "LABELS", {"HEAD", "ELBOW"}),
        textOf("POINT", "UNITS", {"mm"}, 4),
        scalarOf("ANALOG", "USED", 2, channels),
        textOf("ANALOG", "LABELS", {"BIC", "TRI"}),
        textOf("ANALOG", "UNITS", {"mV", "V"}, 4),
        realOf("ANALOG", "SCALE", {0.5, 2}),
        scalarOf("ANALOG", "GEN_SCALE", 4, 0.25),
        wholeOf("ANALOG", "OFFSET", {4, -8}),
    };
    std::erase_if(all, [&](const Parameter& p) {
      for (const std::string& name : without) {
        if (name == p.group + ":" + p.name) return true;
      }
      return false;
    });
    all.insert(all.end(), more.begin(), more.end());
    BinaryWriter out(processor);
    for (const unsigned byte : {1U, 0x50U, 0U, static_cast<unsigned>(processor)}) out.u8(byte);
    const std::vector<std::string> groups = {"POINT", "ANALOG", "TRIAL"};
    for (std::size_t g = 0; g < groups.size(); ++g) {
      begin(out, groups[g], -static_cast<int>(g) - 1, 3 + 4);
      out.u8(4);
      out.text("text", 4);
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      std::size_t g = 0;
      while (groups[g] != all[i].group) ++g;
      BinaryWriter body(processor);
      writeValue(body, all[i]);
      begin(out, all[i].name, static_cast<int>(g) + 1,
            i + 1 == all.size() ? 0 : 2 + static_cast<unsigned>(body.bytes.size()));
      out.bytes += body.bytes;
    }
    out.fillBlock();
    return out;
  }
  static void begin(BinaryWriter& out, const std::string& name, int group, unsigned next) {
    out.u8(static_cast<unsigned>(name.size()));
    out.u8(static_cast<unsigned>(group));
    out.bytes += name;
    out.u16(next);
  }
  static void writeValue(BinaryWriter& out, const Parameter& parameter) {
    out.u8(static_cast<unsigned>(parameter.type));
    out.u8(static_cast<unsigned>(parameter.dimensions.size()));
    for (const unsigned dimension : parameter.dimensions) out.u8(dimension);
    out.bytes += parameter.text;
    for (const double number : parameter.numbers) {
      if (parameter.type == 4) {
        out.f32(static_cast<float>(number));
      } else if (parameter.type == 2) {
        out.u16(static_cast<unsigned>(static_cast<int>(number)));
      } else {
        out.u8(static_cast<unsigned>(static_cast<int>(number)));
      }
    }
    out.u8(0);  // no description
  }
};

/// XDF chunks one after the other.
class XdfSample {
 public:
  std::string bytes = "XDF:";

  void chunk(unsigned tag, const std::string& content) {
    BinaryWriter out;
    out.u8(4);
    out.u32(static_cast<std::uint32_t>(content.size() + 2));
    out.u16(tag);
    bytes += out.bytes + content;
  }
  void fileHeader() { chunk(1, "<?xml version='1.0'?><info><version>1.0</version></info>"); }
  void streamHeader(std::uint32_t id, const std::string& name, unsigned channels, double rate,
                    const std::string& format, const std::string& labels = "") {
    chunk(2, idOf(id) + "<?xml version='1.0'?><info><name>" + name + "</name><type>EMG</type>" +
                 "<channel_count>" + std::to_string(channels) + "</channel_count><nominal_srate>" +
                 std::to_string(rate) + "</nominal_srate><channel_format>" + format +
                 "</channel_format><desc><channels>" + labels + "</channels></desc></info>");
  }
  static std::string label(const std::string& name, const std::string& unit) {
    return "<channel><label>" + name + "</label><unit>" + unit + "</unit></channel>";
  }
  /// Samples of content `values`, each with a stamp or (NaN) without.
  static std::string samples(std::uint32_t id, const std::vector<double>& stamps,
                             const std::vector<std::string>& values) {
    BinaryWriter out;
    out.u8(1);
    out.u8(static_cast<unsigned>(stamps.size()));
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      out.u8(std::isnan(stamps[i]) ? 0 : 8);
      if (!std::isnan(stamps[i])) out.f64(stamps[i]);
      out.bytes += values[i];
    }
    return idOf(id) + out.bytes;
  }
  void offset(std::uint32_t id, double at, double by) {
    BinaryWriter out;
    out.f64(at);
    out.f64(by);
    chunk(4, idOf(id) + out.bytes);
  }
  static std::string idOf(std::uint32_t id) {
    BinaryWriter out;
    out.u32(id);
    return out.bytes;
  }
  static std::string int16(const std::vector<int>& values) {
    BinaryWriter out;
    for (const int value : values) out.u16(static_cast<unsigned>(value));
    return out.bytes;
  }
  static std::string float32(const std::vector<float>& values) {
    BinaryWriter out;
    for (const float value : values) out.f32(value);
    return out.bytes;
  }
};

}  // namespace support
