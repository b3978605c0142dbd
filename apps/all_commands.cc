#include "check.h"
#include "command.h"
#include "emg.h"
#include "robot.h"
#include "moment_arms.h"
#include "replay.h"

namespace app {

std::vector<std::unique_ptr<Command>> allCommands() {
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(checkCommand());
  commands.push_back(emgCommand());
  commands.push_back(robotCommand());
  commands.push_back(momentArmsCommand());
  commands.push_back(replayCommand());
  return commands;
}

}  // namespace app
