#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bio/path/length_jumps.h"
#include "bio/path/opensim_difference.h"
#include "report/report.h"

namespace app {

/// Jumps of lengths and moment arms, and where OpenSim's paths differ, for summary.json; angles in
/// degrees, shifts in mm.
nlohmann::ordered_json jumpsAsJson(const std::vector<bio::LengthJump>& jumps);
nlohmann::ordered_json departuresAsJson(const std::vector<bio::OpenSimDeparture>& departures);

/// The same as tables of a report.
Table jumpTable(const std::vector<bio::LengthJump>& jumps);
Table departureTable(const std::vector<bio::OpenSimDeparture>& departures);

/// A sentence on the largest difference; empty if there is none.
std::string departureWords(const std::vector<bio::OpenSimDeparture>& departures);

}  // namespace app
