#include "calibrate.h"
#include "check.h"
#include "command.h"
#include "compare.h"
#include "design.h"
#include "discover.h"
#include "emg.h"
#include "ensemble.h"
#include "moment_arms.h"
#include "render.h"
#include "replay.h"
#include "robot.h"
#include "sensitivity.h"

namespace app {

std::vector<std::unique_ptr<Command>> allCommands() {
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(calibrateCommand());
  commands.push_back(checkCommand());
  commands.push_back(compareCommand());
  commands.push_back(designCommand());
  commands.push_back(discoverCommand());
  commands.push_back(emgCommand());
  commands.push_back(ensembleCommand(threadCrew));
  commands.push_back(momentArmsCommand());
  commands.push_back(renderCommand(drawInOtherProgram));
  commands.push_back(replayCommand());
  commands.push_back(robotCommand());
  commands.push_back(sensitivityCommand());
  return commands;
}

}  // namespace app
