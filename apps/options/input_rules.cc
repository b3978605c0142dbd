#include "options/input_rules.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

namespace app {

void inputsMustDiffer(const Summary& summary, std::size_t training, std::size_t first) {
  const auto& inputs = summary.inputs();
  for (std::size_t i = first; i < inputs.size(); ++i) {
    for (std::size_t j = i + 1; j < inputs.size(); ++j) {
      if (inputs[i].sha256 != inputs[j].sha256) continue;
      const bool between = i < first + training && j >= first + training;
      throw std::invalid_argument(
          between ? fmt::format("{}: is held out and also used for estimation, as {}",
                                inputs[j].path, inputs[i].path)
                  : fmt::format("{}: is the same trial as {}", inputs[j].path, inputs[i].path));
    }
  }
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
