#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/parameters/parameters.h"

namespace app {

/// A model of a page: its document, and how the page calls it.
struct ExploredModel {
  std::string file;   ///< under which the page holds it, and which the command line names
  std::string label;  ///< "with viscous joint damping"
  std::string text;   ///< OpenSim document
  bio::Model model;
  std::vector<std::string> trials;  ///< files, in the order of the page's trials
  bool isShown = true;              ///< false: for comparison only
};

/// What an earlier `discover` says, in its folder.
struct EarlierVerdict {
  std::string sentence;
  std::string effects;  ///< names, "viscous joint damping and …"; empty: none
  std::filesystem::path model;
  std::map<std::string, std::string> replayed;  ///< by trial: the file that the model replays
  /// A trial that the verdict does not know is replayed as it is.
  std::string replayedFor(const std::string& trial) const;
  struct Fitted {
    std::string name;
    double nominal, estimate, sd;
    double shift;  ///< |estimate − nominal| in standard deviations of the prior
  };
  std::vector<Fitted> fitted;
};

/// @throws bio::FileError for a folder without a verdict of a model, or of another form
EarlierVerdict readVerdict(const std::filesystem::path& folder);

/// @throws bio::FileError if it cannot be read
std::string fileText(const std::filesystem::path& file);

/// The document of a file as the page carries it: as it is, or translated if it is a robot
/// description.
std::string documentOf(const std::string& file, const bio::Model& model);

}  // namespace app
