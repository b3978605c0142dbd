#include "render.h"
#include "render_pictures.h"
#include "run_program.h"

int main(int argc, char** argv) {
  std::vector<std::unique_ptr<app::Command>> commands;
  commands.push_back(app::renderCommand(app::drawPictures));
  return app::runProgram({argv, argv + argc}, std::move(commands));
}
