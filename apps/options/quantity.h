#pragma once

#include <string>
#include <string_view>

/// Quantities on the command line.
namespace app {

/// A finite number without any other text. @throws std::invalid_argument
double parseNumber(std::string_view text);

/// An angle: degrees when it ends in `deg`, else radians (`rad` may be written). "34deg" → 0.593…
/// @return [rad]
/// @throws std::invalid_argument
double parseAngle(std::string_view text);

/// NAME=VALUE, as --initial and --lock take it.
struct Assignment {
  std::string name;
  double value;          ///< [rad] for an angle, [m] for a translation
  bool isAngle = false;  ///< `deg` or `rad` was written
};

/// @throws std::invalid_argument
Assignment parseAssignment(std::string_view text);

}  // namespace app
