#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bio/path/length_jumps.h"
#include "report/report.h"

namespace app {

/// Jumps of lengths and moment arms for summary.json; angles in degrees, shifts in mm.
nlohmann::ordered_json jumpsAsJson(const std::vector<bio::LengthJump>& jumps);

/// The same as a table of a report.
Table jumpTable(const std::vector<bio::LengthJump>& jumps);

}  // namespace app
