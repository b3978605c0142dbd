#include "options/input_rules.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "bio/tables/different_trials.h"

namespace app {

void inputsMustDiffer(const Summary& summary, std::size_t training, std::size_t first) {
  std::vector<bio::TrialIdentity> trials;
  for (std::size_t i = first; i < summary.inputs().size(); ++i) {
    trials.push_back({summary.inputs()[i].path, summary.inputs()[i].sha256});
  }
  bio::requireDifferentTrials(trials, training);
}

void resultsMustNotBeInputs(const Summary& summary, const OutputFolder& folder,
                            const std::vector<std::string>& results) {
  if (!folder.active()) return;
  for (const std::string& name : results) {
    for (const Summary::InputFile& input : summary.inputs()) {
      std::error_code ignored;
      if (std::filesystem::equivalent(folder.path(name), input.path, ignored)) {
        throw std::invalid_argument(fmt::format(
            "{}: is an input and would be overwritten; choose another --out", input.path));
      }
    }
  }
}

}  // namespace app
