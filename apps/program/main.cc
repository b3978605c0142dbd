#include "command/run_program.h"
#include "ensemble/mpi_launch.h"
#include "output/standard_streams.h"
#include "robot_options/robot_program.h"

#include "program/all_commands.h"

int main(int argc, char** argv) {
  app::openStandardStreams();
  app::becomeRankUnderMpi(argc, argv);
  app::becomeRobotProgram(argv);
  return app::runProgram({argv, argv + argc}, app::allCommands());
}
