#include "robot/robot_trial.h"

#include <fmt/format.h>

#include <stdexcept>

#include "bio/tables/table_file.h"
#include "robots/robot_recording.h"

namespace app {

info::robot::Trial readRobotTrial(const std::string& file,
                                  const std::vector<info::robot::Channel>& channels,
                                  bool ignoreExtra, std::vector<std::string>& warnings) {
  const bio::Table table = bio::readTable(file);
  return info::robot::recordingOf(
      {file, table.columns, table.values, table.inDegrees}, channels,
      [&](const std::string& column) {
        const std::string what = fmt::format("{}: column {} is unknown", file, column);
        if (!ignoreExtra) throw std::invalid_argument(what + "; --ignore-extra ignores it");
        warnings.push_back(what + " and ignored");
      });
}

}  // namespace app
