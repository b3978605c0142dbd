#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace bio::tables {

/// How a binary file writes its numbers.
///   little  Intel: lowest byte first, IEEE 754
///   big     MIPS: highest byte first, IEEE 754
///   dec     DEC: integers as Intel; floats of VAX (F_floating), its 16-bit words lowest byte first
enum class NumberFormat { little, big, dec };

/// A binary file in memory; no access outside it.
class Bytes {
 public:
  Bytes(std::string file, std::string_view bytes, NumberFormat format = NumberFormat::little)
      : file_(std::move(file)), bytes_(bytes), format_(format) {}

  std::size_t size() const { return bytes_.size(); }
  const std::string& file() const { return file_; }
  NumberFormat format() const { return format_; }

  /// @throws FileError "file: …"
  [[noreturn]] void fail(const std::string& what) const;
  /// @throws FileError unless the file holds `count` bytes from `at` on
  void require(std::size_t at, std::size_t count, std::string_view what) const;

  /// Numbers at a place that is checked.
  std::uint8_t uint8(std::size_t at, std::string_view what) const;
  std::uint16_t uint16(std::size_t at, std::string_view what) const;
  std::int16_t int16(std::size_t at, std::string_view what) const;
  float float32(std::size_t at, std::string_view what) const;
  std::string_view text(std::size_t at, std::size_t count, std::string_view what) const;

  /// Numbers at a place inside what require() has passed.
  std::uint16_t uint16Within(std::size_t at) const;
  float float32Within(std::size_t at) const;
  /// Whole number of `count` ≤ 8 bytes, without sign.
  std::uint64_t uintWithin(std::size_t at, std::size_t count) const;

 private:
  std::string file_;
  std::string_view bytes_;
  NumberFormat format_;
};

}  // namespace bio::tables
