#include "output/driven_trials.h"

#include <fmt/format.h>

#include "output/sha256.h"

namespace app {

std::string drivenName(std::size_t number, bool heldOut) {
  return fmt::format("driven_{}{}.sto", heldOut ? "held_out_" : "", number);
}

std::string writeDriven(const bio::FittedTrial& trial, std::size_t number, bio::Model& model,
                        OutputFolder& folder) {
  std::string name = drivenName(number, trial.isHeldOut);
  folder.writeFile(name, [&](const std::filesystem::path& path) {
    bio::writeTable(*trial.driven, path);
    bio::addStarts(model, trial, name, sha256OfFile(path));
  });
  return folder.active() ? folder.path(name).string() : name;
}

}  // namespace app
