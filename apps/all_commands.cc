#include "check.h"
#include "command.h"

namespace app {

std::vector<std::unique_ptr<Command>> allCommands() {
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(checkCommand());
  return commands;
}

}  // namespace app
