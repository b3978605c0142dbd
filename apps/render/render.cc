#include "render/render.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "options/number_rules.h"
#include "options/trial_input.h"

namespace app {
namespace {

constexpr int fewestPixels = 64, mostPixels = 8192;

/// One side of a picture; 0 if it is no number.
int pixelsOf(const std::string& text) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end ? value : 0;
}

void parseSize(const std::string& text, RenderOptions& options) {
  const std::size_t cross = text.find('x');
  options.width = pixelsOf(text.substr(0, cross));
  options.height = cross == text.npos ? 0 : pixelsOf(text.substr(cross + 1));
  for (const int side : {options.width, options.height}) {
    if (side < fewestPixels || side > mostPixels) {
      throw CLI::ValidationError(
          "--size", fmt::format("{} must be WIDTHxHEIGHT, each {} to {} pixels", text, fewestPixels,
                                mostPixels));
    }
  }
}

class Render : public Command {
 public:
  explicit Render(Drawing draw) : draw_(std::move(draw)) {}

  About about() const override {
    return {"render", "Draw pictures or a film of the motion, muscles coloured by activation",
            "fisherhill render models/elbow8.osim out/replay/states.sto --film --out out/film"};
  }

  void addOptions(CLI::App& options) override {
    addModelArgument(options, options_.model);
    options
        .add_option("STATES", options_.states,
                    "motion: states.sto of a simulation, or a table of the coordinates; without "
                    "it, one posture: the model's default values, and those of --lock")
        ->check(CLI::ExistingFile)
        ->type_name("");
    auto* time = options.add_option("--time", options_.time,
                                    "time of the picture [s]; default: the middle of the motion");
    time->check(finite())->type_name("SECONDS");
    options.add_flag("--film", options_.film, "film of the whole motion, film.mp4 (needs ffmpeg)")
        ->excludes(time);
    options.add_option("--fps", options_.framesPerSecond, "frames per second of the film")
        ->check(between(1, 240))
        ->type_name("N")
        ->capture_default_str();
    options
        .add_option_function<std::string>(
            "--size", [this](const std::string& text) { parseSize(text, options_); },
            "width and height [pixel]")
        ->type_name("WxH")
        ->default_str("1280x960");
    options.add_option("--camera", options_.camera, "viewpoint; each shows the whole model")
        ->check(CLI::IsMember({"fit", "side", "front", "top", "isometric"}))
        ->capture_default_str();
    options
        .add_option("--geometry", options_.geometry,
                    "folder of the .vtp files that the model names")
        ->check(CLI::ExistingDirectory)
        ->type_name("DIR");
    options
        .add_option("--activation-max", options_.largestActivation,
                    "activation with the last colour, 0 to 1; default: the largest that occurs")
        ->check(CLI::Range(0.001, 1.0))
        ->type_name("ACTIVATION");
    options.add_flag("--show-wraps", options_.showWraps, "draw the wrap surfaces, translucent");
    options
        .add_option_function<std::string>(
            "--thickness",
            [this](const std::string& text) { options_.thicknessByForce = text == "force"; },
            "thickness of the muscles: by tendon force, or fixed")
        ->check(CLI::IsMember({"force", "fixed"}))
        ->default_str("force");
    auto* ghost = options.add_option("--ghost", options_.ghost, "second motion, drawn translucent");
    ghost->check(CLI::ExistingFile)->type_name("STATES");
    options
        .add_option("--ghost-model", options_.ghostModel,
                    "model of the second motion, if different")
        ->check(CLI::ExistingFile)
        ->needs(ghost)
        ->type_name("MODEL");
    options.add_flag("--ignore-extra", options_.ignoreExtra,
                     "ignore columns that match nothing in the model");
    addModelOptions(options, options_.simulation);
  }

  ExitStatus run(const CommandContext& context) override {
    if (!context.out) {
      throw std::invalid_argument("--out is required: pictures are written into this folder");
    }
    if (options_.states.empty()) {
      for (const auto& [isGiven, option] :
           {std::pair(options_.film, "--film"), std::pair(options_.time.has_value(), "--time"),
            std::pair(!options_.ghost.empty(), "--ghost")}) {
        if (isGiven)
          throw std::invalid_argument(fmt::format("{}: needs STATES, a motion to show", option));
      }
    }
    if (options_.film && (options_.width % 2 != 0 || options_.height % 2 != 0)) {
      throw std::invalid_argument(fmt::format("--size {}x{}: must be even numbers for a film",
                                              options_.width, options_.height));
    }
    return draw_(options_, context);
  }

 private:
  Drawing draw_;
  RenderOptions options_;
};

}  // namespace

std::unique_ptr<Command> renderCommand(Drawing draw) {
  return std::make_unique<Render>(std::move(draw));
}

std::filesystem::path pictureProgram() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "fisherhill-render";
}

ExitStatus drawInOtherProgram(const RenderOptions&, const CommandContext& context) {
  const std::filesystem::path program = pictureProgram();
  std::vector<char*> words;
  for (const std::string& word : context.commandLine) {
    words.push_back(const_cast<char*>(word.c_str()));
  }
  words.push_back(nullptr);
  execv(program.c_str(), words.data());
  throw std::runtime_error(fmt::format(
      "{} cannot be started ({}); it is built if VTK is installed and FISHERHILL_VIEW=ON",
      program.string(), std::strerror(errno)));
}

}  // namespace app
