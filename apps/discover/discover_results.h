#pragma once

#include <nlohmann/json.hpp>

#include "discover/discover_search.h"
#include "discover/discover_verdict.h"
#include "output/command_context.h"
#include "output/output_folder.h"
#include "output/summary.h"

/// Files and printed findings of a search, in musculoskeletal models and in robots.
namespace app {

/// Sets the values of summary.json and writes verdict.json, which is returned, and parameters.csv
/// if anything was fitted.
nlohmann::ordered_json writeFindings(const DiscoverFindings& findings, Summary& summary,
                                     OutputFolder& folder);

/// Delivers summary and report: status 1 if the time step is too long for a finding.
/// @throws Interrupted after that if the search was
ExitStatus deliverFindings(const DiscoverFindings& findings, const WatchedSearch& watch,
                           const CommandContext& context, Summary& summary, OutputFolder& folder);

}  // namespace app
