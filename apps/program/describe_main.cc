#include <iostream>
#include <string>

#include "command/command_line.h"
#include "command/command_tree.h"
#include "command/completion.h"
#include "command/described_commands.h"
#include "command/manual_page.h"
#include "info/version.h"
#include "program/all_commands.h"
#include "robot_options/robot_program.h"

// describe_commands man|man-mpi|man-render|man-robot|bash|zsh: what is installed beside the
// program, read off its command line. describe_commands json: the command line itself, from which
// its documents are made.
int main(int count, char** arguments) {
  const std::string what = count == 2 ? arguments[1] : "";
  app::CommandLine line(app::allCommandsWith(app::robotCommand(), app::discoverInRobot));
  const app::DescribedCommand program = app::describe(line.program());
  if (what == "man") {
    std::cout << app::manualPage(program, info::version());
  } else if (what == "man-mpi") {
    std::cout << app::helperPage(program, info::version(), "fisherhill-mpi", "ensemble",
                                 "fisherhill ensemble starts this program under mpirun: the ranks "
                                 "share the work, and the result does not depend on their number.",
                                 "mpirun -n N");
  } else if (what == "man-render") {
    std::cout << app::helperPage(
        program, info::version(), "fisherhill-render", "render",
        "fisherhill render starts this program, which alone needs the graphics libraries.", "");
  } else if (what == "man-robot") {
    std::cout << app::helperPage(
        program, info::version(), "fisherhill-robot", "robot",
        "fisherhill robot starts this program, and fisherhill discover where --system is given.",
        "");
  } else if (what == "bash") {
    std::cout << app::bashCompletion(program);
  } else if (what == "zsh") {
    std::cout << app::zshCompletion(program);
  } else if (what == "json") {
    std::cout << app::commandTree(program).dump(1) << '\n';
  } else {
    std::cerr
        << "describe_commands: argument must be man, man-mpi, man-render, man-robot, bash, zsh or "
           "json\n";
    return 2;
  }
  std::cout.flush();
  return std::cout ? 0 : 1;
}
