#include "tables/formats/xdf_chunks.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <map>

#include "tables/cells.h"
#include "tables/text_file.h"

namespace bio::tables {
namespace {

enum Tag : std::uint16_t { fileHeader = 1, streamHeader, samples, clockOffset, boundary, footer };

// The bytes of one chunk behind its tag.
struct Chunk {
  std::size_t number = 0;  // counted from 1
  std::uint16_t tag = 0;
  std::size_t at = 0, end = 0;
};

class ChunkReader {
 public:
  explicit ChunkReader(const Bytes& bytes) : bytes_(bytes) {}

  RawXdf read() {
    std::size_t at = 4;
    for (Chunk chunk; at < bytes_.size(); at = chunk.end) {
      ++chunk.number;
      if (!begin(chunk, at)) {
        out_.unread = bytes_.size() - at;
        break;
      }
      readChunk(chunk);
    }
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const Chunk& chunk, const std::string& what) const {
    bytes_.fail(fmt::format("chunk {}: {}", chunk.number, what));
  }
  void require(const Chunk& chunk, std::size_t at, std::size_t count) const {
    if (at <= chunk.end && count <= chunk.end - at) return;
    fail(chunk, fmt::format("needs {} bytes from byte {} on, it ends at {}", count, at, chunk.end));
  }
  double number(std::size_t at) const { return std::bit_cast<double>(bytes_.uintWithin(at, 8)); }

  // A length in 1, 4 or 8 bytes, with its own length before it.
  std::uint64_t length(const Chunk& chunk, std::size_t& at) const {
    require(chunk, at, 1);
    const auto count = static_cast<std::size_t>(bytes_.uintWithin(at, 1));
    if (count != 1 && count != 4 && count != 8) {
      fail(chunk, fmt::format("length in {} bytes, must be in 1, 4 or 8", count));
    }
    require(chunk, at + 1, count);
    const std::uint64_t value = bytes_.uintWithin(at + 1, count);
    at += 1 + count;
    return value;
  }

  // False for samples that the file's end cuts off: a recorder that was killed.
  bool begin(Chunk& chunk, std::size_t at) const {
    chunk.end = bytes_.size();
    const std::uint64_t size = length(chunk, at);
    if (size < 2) fail(chunk, fmt::format("length {}, must be ≥ 2", size));
    require(chunk, at, 2);
    chunk.tag = bytes_.uint16Within(at);
    chunk.at = at + 2;
    if (size > bytes_.size() - at) {
      if (chunk.tag == Tag::samples && !out_.streams.empty()) return false;
      fail(chunk, fmt::format("has {} bytes from byte {} on, the file has {} (cut off?)", size, at,
                              bytes_.size()));
    }
    chunk.end = at + static_cast<std::size_t>(size);
    return true;
  }

  void readChunk(const Chunk& chunk) {
    switch (chunk.tag) {
      case Tag::streamHeader:
        return readHeader(chunk);
      case Tag::samples:
        return readSamples(chunk);
      case Tag::clockOffset:
        return readOffset(chunk);
      case Tag::fileHeader:
      case Tag::boundary:
      case Tag::footer:
        return;
      default:
        fail(chunk, fmt::format("tag {}, must be 1 to 6", chunk.tag));
    }
  }

  std::uint32_t idOf(const Chunk& chunk) const {
    require(chunk, chunk.at, 4);
    return static_cast<std::uint32_t>(bytes_.uintWithin(chunk.at, 4));
  }
  RawXdfStream& streamOf(const Chunk& chunk) {
    const auto found = indexOf_.find(idOf(chunk));
    if (found == indexOf_.end()) {
      fail(chunk, fmt::format("stream {}, must have a header before", idOf(chunk)));
    }
    return out_.streams[found->second];
  }

  void readHeader(const Chunk& chunk);
  void readFormat(const Chunk& chunk, const std::string& format, RawXdfStream& stream) const;
  void readSamples(const Chunk& chunk);
  double valueAt(std::size_t at, const RawXdfStream& stream) const;
  void readOffset(const Chunk& chunk) {
    RawXdfStream& stream = streamOf(chunk);
    require(chunk, chunk.at + 4, 16);
    const double at = number(chunk.at + 4), by = number(chunk.at + 12);
    if (!std::isfinite(at) || !std::isfinite(by)) {
      fail(chunk, fmt::format("clock offset {} s at {} s, must be finite", by, at));
    }
    stream.offsets.push_back({at, by, stream.stamps.size()});
  }

  const Bytes& bytes_;
  RawXdf out_;
  std::map<std::uint32_t, std::size_t> indexOf_;
};

std::string wordIn(const tinyxml2::XMLElement* parent, const char* name) {
  const auto* element = parent->FirstChildElement(name);
  const char* text = element != nullptr ? element->GetText() : nullptr;
  return text != nullptr ? onOneLine(std::string(trimmed(text))) : "";
}

void readLabels(const tinyxml2::XMLElement* info, RawXdfStream& stream) {
  const auto* desc = info->FirstChildElement("desc");
  const auto* all = desc != nullptr ? desc->FirstChildElement("channels") : nullptr;
  if (all == nullptr) return;
  for (const auto* each = all->FirstChildElement("channel"); each != nullptr;
       each = each->NextSiblingElement("channel")) {
    stream.labels.push_back(wordIn(each, "label"));
    stream.units.push_back(wordIn(each, "unit"));
  }
}

void ChunkReader::readFormat(const Chunk& chunk, const std::string& format,
                             RawXdfStream& stream) const {
  static const std::map<std::string, std::pair<std::size_t, bool>> formats = {
      {"float32", {4, true}}, {"double64", {8, true}}, {"int8", {1, false}},  {"int16", {2, false}},
      {"int32", {4, false}},  {"int64", {8, false}},   {"string", {0, false}}};
  const auto found = formats.find(format);
  if (found == formats.end()) {
    fail(chunk, fmt::format("stream '{}': channel_format = '{}', must be float32, double64, int8, "
                            "int16, int32, int64 or string",
                            stream.name, format));
  }
  stream.width = found->second.first;
  stream.floats = found->second.second;
}

void ChunkReader::readHeader(const Chunk& chunk) {
  const std::uint32_t id = idOf(chunk);
  const std::string_view xml = bytes_.text(chunk.at + 4, chunk.end - chunk.at - 4, "stream header");
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
    fail(chunk, "header of a stream, must be XML");
  }
  const auto* info = document.FirstChildElement("info");
  if (info == nullptr) fail(chunk, "header of a stream, must hold an element 'info'");
  RawXdfStream stream;
  stream.name = wordIn(info, "name");
  stream.type = wordIn(info, "type");
  if (stream.name.empty()) stream.name = fmt::format("stream {}", id);
  const auto numberIn = [&](const char* key) {
    const std::string text = wordIn(info, key);
    double value = 0;
    if (!NumberReader(false).read(text, value).empty() || !(value >= 0 && value < 1e9)) {
      fail(chunk,
           fmt::format("stream '{}': {} = '{}', must be a number ≥ 0", stream.name, key, text));
    }
    return value;
  };
  const double channels = numberIn("channel_count");
  if (channels < 1 || channels != std::floor(channels)) {
    fail(chunk, fmt::format("stream '{}': channel_count = {:g}, must be a whole number ≥ 1",
                            stream.name, channels));
  }
  stream.channels = static_cast<std::size_t>(channels);
  stream.nominalRate = numberIn("nominal_srate");
  readFormat(chunk, wordIn(info, "channel_format"), stream);
  readLabels(info, stream);
  if (!indexOf_.emplace(id, out_.streams.size()).second) {
    fail(chunk, fmt::format("second header of stream {}, must be one", id));
  }
  out_.streams.push_back(std::move(stream));
}

double ChunkReader::valueAt(std::size_t at, const RawXdfStream& stream) const {
  if (stream.floats) {
    return stream.width == 8 ? number(at) : static_cast<double>(bytes_.float32Within(at));
  }
  // with its sign
  const auto unused = static_cast<int>(64 - 8 * stream.width);
  const auto bits = static_cast<std::int64_t>(bytes_.uintWithin(at, stream.width) << unused);
  return static_cast<double>(bits >> unused);
}

void ChunkReader::readSamples(const Chunk& chunk) {
  RawXdfStream& stream = streamOf(chunk);
  if (stream.width == 0 || stream.nominalRate == 0) {
    return;  // texts and events are not read
  }
  std::size_t at = chunk.at + 4;
  const std::uint64_t count = length(chunk, at);
  for (std::uint64_t i = 0; i < count; ++i) {
    require(chunk, at, 1);
    const std::uint64_t stampBytes = bytes_.uintWithin(at++, 1);
    if (stampBytes != 0 && stampBytes != 8) {
      fail(chunk, fmt::format("stream '{}': time stamp in {} bytes, must be in 0 or 8", stream.name,
                              stampBytes));
    }
    double stamp = 0;
    if (stampBytes == 8) {
      require(chunk, at, 8);
      stamp = number(at);
      at += 8;
    } else if (!stream.stamps.empty()) {
      stamp = stream.stamps.back() + 1 / stream.nominalRate;
    } else {
      fail(chunk,
           fmt::format("stream '{}': first sample has no time stamp, must have one", stream.name));
    }
    if (!(std::abs(stamp) < 1e12)) {
      fail(chunk,
           fmt::format("stream '{}': time stamp {} s, must be a finite time", stream.name, stamp));
    }
    stream.stamps.push_back(stamp);
    require(chunk, at, stream.channels * stream.width);
    for (std::size_t c = 0; c < stream.channels; ++c, at += stream.width) {
      stream.values.push_back(valueAt(at, stream));
    }
  }
  if (at != chunk.end) {
    fail(chunk, fmt::format("stream '{}': {} samples end at byte {}, must end at {}", stream.name,
                            count, at, chunk.end));
  }
}

}  // namespace

bool isXdf(std::string_view bytes) {
  return bytes.starts_with("XDF:");
}

RawXdf readXdfChunks(const Bytes& bytes) {
  if (!isXdf(bytes.text(0, std::min<std::size_t>(4, bytes.size()), "header"))) {
    bytes.fail("is no XDF file, must begin with 'XDF:'");
  }
  return ChunkReader(bytes).read();
}

}  // namespace bio::tables
