#include "options/quantity.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "bio/model/units.h"

namespace app {

double parseNumber(std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  if ((digits.size() < text.size() && digits.starts_with('-')) || error != std::errc() ||
      stop != end || !std::isfinite(value)) {
    throw std::invalid_argument(fmt::format("'{}' is not a finite number", text));
  }
  return value;
}

double parseAngle(std::string_view text) {
  std::string_view number = text;
  double unit = 1;
  if (text.ends_with("deg")) {
    unit = bio::radiansPerDegree;
    number.remove_suffix(3);
  } else if (text.ends_with("rad")) {
    number.remove_suffix(3);
  }
  try {
    return unit * parseNumber(number);
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(
        fmt::format("'{}' is not a finite number, nor an angle such as 34deg", text));
  }
}

Assignment parseAssignment(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == text.npos || equals == 0) {
    throw std::invalid_argument(fmt::format("'{}' is not NAME=VALUE", text));
  }
  return {std::string(text.substr(0, equals)), parseAngle(text.substr(equals + 1)),
          text.ends_with("deg") || text.ends_with("rad")};
}

}  // namespace app
