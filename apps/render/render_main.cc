#include "command/run_program.h"
#include "output/standard_streams.h"
#include "render/render.h"
#include "render/render_pictures.h"

// `fisherhill-render render …` for people, by way of `fisherhill render`.
int main(int argc, char** argv) {
  app::openStandardStreams();
  std::vector<std::unique_ptr<app::Command>> commands;
  commands.push_back(app::renderCommand(app::drawPictures));
  return app::runProgram({argv, argv + argc}, std::move(commands));
}
