#include "explore/explored_models.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "bio/opensim/osim_file.h"
#include "bio/robot_description/robot_description.h"
#include "bio/tables/file_error.h"

namespace app {
namespace fs = std::filesystem;

std::string fileText(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  if (!stream) throw bio::FileError(fmt::format("{}: cannot be read", file.string()));
  return bytes.str();
}

std::string documentOf(const std::string& file, const bio::Model& model) {
  if (bio::modelFormat(file) == bio::ModelFormat::openSim) return fileText(file);
  return bio::rewrittenOsim(file, model, file);
}

std::string EarlierVerdict::replayedFor(const std::string& trial) const {
  for (const auto& [recorded, driven] : replayed) {
    std::error_code isElsewhere;
    if (recorded == trial || fs::equivalent(recorded, trial, isElsewhere)) return driven;
  }
  return trial;
}

EarlierVerdict readVerdict(const fs::path& folder) {
  const fs::path file = folder / "verdict.json";
  const nlohmann::json json = nlohmann::json::parse(fileText(file), nullptr, false);
  const auto fail = [&](const std::string& why) {
    throw bio::FileError(fmt::format("{}: {}", file.string(), why));
  };
  if (json.is_discarded() || !json.is_object()) fail("is not JSON of a verdict");
  EarlierVerdict verdict;
  try {
    verdict.sentence = json.at("sentence").get<std::string>();
    const std::string model = json.contains("model") && json["model"].is_string()
                                  ? json["model"].get<std::string>()
                                  : std::string();
    if (model.empty()) fail("has no model that was written, must have one to be explored");
    verdict.model = folder / fs::path(model).filename();
    for (const auto& effect : json.at("effects")) {
      if (!verdict.effects.empty()) verdict.effects += " and ";
      verdict.effects += effect.at("name").get<std::string>();
    }
    for (const auto& trial : json.at("trials")) {
      const std::string recorded = trial.at("file").get<std::string>();
      const fs::path driven = trial.at("replay_file").get<std::string>();
      // a corrected recording is beside the verdict, wherever that is now
      if (driven != recorded) verdict.replayed[recorded] = folder / driven.filename();
    }
    for (const auto& one : json.at("fitted_parameters")) {
      const double sd = one.at("sd").is_number() ? one["sd"].get<double>() : 0;
      const double shift = one.at("prior_z").is_number() ? one["prior_z"].get<double>() : 0;
      verdict.fitted.push_back({one.at("name").get<std::string>(), one.at("nominal").get<double>(),
                                one.at("estimate").get<double>(), sd, std::abs(shift)});
    }
  } catch (const nlohmann::json::exception& error) {
    fail(fmt::format("is not a verdict of a model ({})", error.what()));
  }
  return verdict;
}

}  // namespace app
