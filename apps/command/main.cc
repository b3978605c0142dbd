#include "command/run_program.h"
#include "ensemble/mpi_launch.h"
#include "output/standard_streams.h"

int main(int argc, char** argv) {
  app::openStandardStreams();
  app::becomeRankUnderMpi(argc, argv);
  return app::runProgram({argv, argv + argc}, app::allCommands());
}
