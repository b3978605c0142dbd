#include "tables/formats/bytes.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>

#include "bio/tables/file_error.h"

namespace bio::tables {
namespace {

// VAX F_floating: sign, 8 bits of exponent e, 23 of fraction; (0.5 + fraction/2)·2^(e − 128).
float fromVax(std::uint32_t bits) {
  const auto exponent = static_cast<int>((bits >> 23) & 0xFF);
  const bool negative = (bits >> 31) != 0;
  if (exponent == 0) return negative ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
  const auto fraction = static_cast<double>((bits & 0x7FFFFF) | 0x800000);
  const double value = std::ldexp(fraction, exponent - 128 - 24);
  return static_cast<float>(negative ? -value : value);
}

}  // namespace

void Bytes::fail(const std::string& what) const {
  throw FileError(fmt::format("{}: {}", file_, what));
}

void Bytes::require(std::size_t at, std::size_t count, std::string_view what) const {
  if (at <= bytes_.size() && count <= bytes_.size() - at) return;
  fail(fmt::format("{} needs {} bytes from byte {} on, the file has {} (cut off?)", what, count, at,
                   bytes_.size()));
}

std::uint64_t Bytes::uintWithin(std::size_t at, std::size_t count) const {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = format_ == NumberFormat::big ? i : count - 1 - i;
    value = value << 8 | static_cast<std::uint8_t>(bytes_[at + k]);
  }
  return value;
}

std::uint16_t Bytes::uint16Within(std::size_t at) const {
  return static_cast<std::uint16_t>(uintWithin(at, 2));
}

float Bytes::float32Within(std::size_t at) const {
  if (format_ != NumberFormat::dec) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(uintWithin(at, 4)));
  }
  return fromVax(static_cast<std::uint32_t>(uintWithin(at, 2) << 16 | uintWithin(at + 2, 2)));
}

std::uint8_t Bytes::uint8(std::size_t at, std::string_view what) const {
  require(at, 1, what);
  return static_cast<std::uint8_t>(bytes_[at]);
}

std::uint16_t Bytes::uint16(std::size_t at, std::string_view what) const {
  require(at, 2, what);
  return uint16Within(at);
}

std::int16_t Bytes::int16(std::size_t at, std::string_view what) const {
  return static_cast<std::int16_t>(uint16(at, what));
}

float Bytes::float32(std::size_t at, std::string_view what) const {
  require(at, 4, what);
  return float32Within(at);
}

std::string_view Bytes::text(std::size_t at, std::size_t count, std::string_view what) const {
  require(at, count, what);
  return bytes_.substr(at, count);
}

}  // namespace bio::tables
