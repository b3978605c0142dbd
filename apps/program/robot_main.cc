#include "command/run_program.h"
#include "output/standard_streams.h"
#include "robot_options/robot_program.h"

#include "program/all_commands.h"

// `fisherhill robot …` and `fisherhill discover --system …`, which start this program.
int main(int argc, char** argv) {
  app::openStandardStreams();
  return app::runProgram({argv, argv + argc},
                         app::allCommandsWith(app::robotCommand(), app::discoverInRobot));
}
