#include "mpi_launch.h"
#include "run_program.h"

int main(int argc, char** argv) {
  app::becomeRankUnderMpi(argc, argv);
  return app::runProgram({argv, argv + argc}, app::allCommands());
}
