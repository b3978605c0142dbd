#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "command/run_program.h"
#include "ensemble/mpi_launch.h"
#include "output/standard_streams.h"
#include "robot_options/robot_program.h"

#include "program/all_commands.h"

namespace {

// A search allocates some megabytes for each of its thousand simulations. By default the C library
// gives them back to the system each time, which then clears them again: a quarter of the time of
// `discover` on a dynamometer.
void keepFreedMemory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keepFreedMemory();
  app::openStandardStreams();
  app::becomeRankUnderMpi(argc, argv);
  app::becomeRobotProgram(argv);
  return app::runProgram({argv, argv + argc}, app::allCommands());
}
