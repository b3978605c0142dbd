#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bio/analysis/opensim_paths.h"
#include "bio/path/length_jumps.h"
#include "report/report.h"

namespace app {

/// Jumps of lengths and moment arms for summary.json; angles in degrees, shifts in mm.
nlohmann::ordered_json jumpsAsJson(const std::vector<bio::LengthJump>& jumps);

/// Jumps as a table of a report.
Table jumpTable(const std::vector<bio::LengthJump>& jumps);

/// Differences from OpenSim's paths over ellipsoids for summary.json; angles in degrees, lengths in
/// mm.
nlohmann::ordered_json differencesAsJson(const std::vector<bio::OpenSimDifference>& differences);

/// Differences from OpenSim's paths as a table of a report.
Table differenceTable(const std::vector<bio::OpenSimDifference>& differences);

}  // namespace app
