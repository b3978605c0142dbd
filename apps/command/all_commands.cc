#include "calibrate/calibrate.h"
#include "check/check.h"
#include "command/command.h"
#include "compare/compare.h"
#include "design/design.h"
#include "discover/discover.h"
#include "emg/emg.h"
#include "ensemble/ensemble.h"
#include "moment_arms/moment_arms.h"
#include "muscle_states/muscle_states.h"
#include "render/render.h"
#include "replay/replay.h"
#include "robot/robot.h"
#include "sensitivity/sensitivity.h"
#include "study/study.h"

namespace app {

std::vector<std::unique_ptr<Command>> allCommands() {
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(calibrateCommand());
  commands.push_back(checkCommand());
  commands.push_back(compareCommand());
  commands.push_back(designCommand());
  commands.push_back(discoverCommand());
  commands.push_back(emgCommand());
  commands.push_back(ensembleCommand(threadPool));
  commands.push_back(momentArmsCommand());
  commands.push_back(muscleStatesCommand());
  commands.push_back(renderCommand(drawInOtherProgram));
  commands.push_back(replayCommand());
  commands.push_back(robotCommand());
  commands.push_back(sensitivityCommand());
  commands.push_back(studyCommand(threadPool));
  return commands;
}

}  // namespace app
