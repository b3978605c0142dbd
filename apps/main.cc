#include "run_program.h"

int main(int argc, char** argv) {
  return app::runProgram({argv, argv + argc}, app::allCommands());
}
