#include "mpi_launch.h"
#include "run_program.h"
#include "standard_streams.h"

int main(int argc, char** argv) {
  app::openStandardStreams();
  app::becomeRankUnderMpi(argc, argv);
  return app::runProgram({argv, argv + argc}, app::allCommands());
}
