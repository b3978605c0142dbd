#include <cstdio>
#include <exception>
#include <string_view>

#include "draw_charts.h"
#include "render.h"
#include "render_pictures.h"
#include "run_program.h"
#include "standard_streams.h"

// `fisherhill-render render …` for people, by way of `fisherhill render`; `charts LIST FOLDER` for
// figurePictures.
int main(int argc, char** argv) {
  app::openStandardStreams();
  if (argc == 4 && std::string_view(argv[1]) == "charts") {
    try {
      app::drawCharts(argv[2], argv[3]);
      return 0;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "fisherhill-render: %s\n", error.what());
      return 2;
    }
  }
  std::vector<std::unique_ptr<app::Command>> commands;
  commands.push_back(app::renderCommand(app::drawPictures));
  return app::runProgram({argv, argv + argc}, std::move(commands));
}
