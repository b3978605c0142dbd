#include <cstdio>
#include <exception>
#include <string_view>

#include "command/run_program.h"
#include "output/standard_streams.h"
#include "render/render.h"
#include "render/render_pictures.h"
#include "report/draw_charts.h"

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
