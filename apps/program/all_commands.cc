#include "program/all_commands.h"

#include "ensemble/ensemble.h"
#include "render/render.h"
#include "robot_options/robot_program.h"
#include "study/study.h"

namespace app {

// Each is defined in the folder of its subcommand.
std::unique_ptr<Command> calibrateCommand();
std::unique_ptr<Command> checkCommand();
std::unique_ptr<Command> compareCommand();
std::unique_ptr<Command> designCommand();
std::unique_ptr<Command> discoverCommand(RobotDiscovery inRobot);
std::unique_ptr<Command> emgCommand();
std::unique_ptr<Command> exploreCommand();
std::unique_ptr<Command> indexCommand();
std::unique_ptr<Command> momentArmsCommand();
std::unique_ptr<Command> muscleStatesCommand();
std::unique_ptr<Command> replayCommand();
std::unique_ptr<Command> sensitivityCommand();

std::vector<std::unique_ptr<Command>> allCommands() {
  return allCommandsWith(missingRobotCommand(), missingRobotDiscovery);
}

std::vector<std::unique_ptr<Command>> allCommandsWith(std::unique_ptr<Command> robot,
                                                      RobotDiscovery inRobot) {
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(calibrateCommand());
  commands.push_back(checkCommand());
  commands.push_back(compareCommand());
  commands.push_back(designCommand());
  commands.push_back(discoverCommand(std::move(inRobot)));
  commands.push_back(emgCommand());
  commands.push_back(ensembleCommand(threadPool));
  commands.push_back(exploreCommand());
  commands.push_back(indexCommand());
  commands.push_back(momentArmsCommand());
  commands.push_back(muscleStatesCommand());
  commands.push_back(renderCommand(drawInOtherProgram));
  commands.push_back(replayCommand());
  commands.push_back(std::move(robot));
  commands.push_back(sensitivityCommand());
  commands.push_back(studyCommand(threadPool, allCommands));
  return commands;
}

}  // namespace app
