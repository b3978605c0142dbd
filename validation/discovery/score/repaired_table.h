#pragma once

#include <filesystem>
#include <string>

namespace hidden {

/// A line for every label: what was hidden, what was found with its estimate, how much of the gap
/// it closed on the held-out trial, and what the same tool says of the model repaired with it
/// ("none" is right). As Markdown.
/// @param labels, verdicts  as readOutcomes() wants them
/// @param repaired  folder of NAME/verdict.json on the repaired models; none where there is none
/// @throws std::runtime_error as readOutcomes()
std::string repairedTable(const std::filesystem::path& labels,
                          const std::filesystem::path& verdicts,
                          const std::filesystem::path& repaired);

}  // namespace hidden
