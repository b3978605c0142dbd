#pragma once

#include <filesystem>

namespace app {

/// Counterpart of figurePictures: draws the figures of a JSON list into a folder, as 0.png, 1.png,
/// …
/// @throws std::runtime_error without a display; nlohmann::json::exception for another list
void drawCharts(const std::filesystem::path& jsonFile, const std::filesystem::path& folder);

}  // namespace app
