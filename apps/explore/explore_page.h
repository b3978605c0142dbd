#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "output/summary.h"

namespace app {

/// The page as one HTML file that needs nothing else: the simulation core as WebAssembly, models,
/// trials and libraries are inside, and its content policy forbids every request.
/// @param data  what page.js reads, see explore.cc
std::string explorePage(const std::string& title, const std::string& verdict,
                        const nlohmann::ordered_json& data, const Summary& summary);

}  // namespace app
