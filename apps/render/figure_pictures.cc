#include "render/figure_pictures.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "output/json_text.h"
#include "render/render.h"

namespace app {
namespace {

namespace fs = std::filesystem;

/// A folder that ends with this object.
struct TemporaryFolder {
  fs::path path;
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "fisherhill-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw std::runtime_error("a temporary folder cannot be created");
    path = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

std::string fileNameOf(const std::string& title) {
  std::string name;
  for (const char c : title) {
    if (std::isalnum(static_cast<unsigned char>(c))) {
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (name.ends_with('_')) name.pop_back();
  return name + ".png";
}

void runAndWait(std::vector<std::string> words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawn(&child, words[0].c_str(), nullptr, nullptr, pointers.data(), environ) != 0) {
    throw std::runtime_error(fmt::format(
        "--png: {} cannot be started; it is built if VTK is installed and FISHERHILL_VIEW=ON",
        words[0]));
  }
  int state = 0;
  while (waitpid(child, &state, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(state) || WEXITSTATUS(state) != 0) {
    throw std::runtime_error(fmt::format("--png: {} could not draw the figures", words[0]));
  }
}

}  // namespace

std::vector<FigurePicture> figurePictures(const Report& report) {
  std::vector<FigurePicture> pictures;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const auto add = [&](const Figure& figure) {
    list.push_back(figureJson(figure));
    pictures.push_back({fileNameOf(figure.title), ""});
  };
  if (report.mainFigure) add(*report.mainFigure);
  for (const ReportPart& part : report.details) {
    if (const auto* figure = std::get_if<Figure>(&part)) add(*figure);
  }
  const TemporaryFolder folder;
  const fs::path file = folder.path / "figures.json";
  std::ofstream(file) << jsonText(list);
  runAndWait({pictureProgram().string(), "charts", file.string(), folder.path.string()});
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    std::ifstream stream(folder.path / fmt::format("{}.png", i), std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    pictures[i].png = bytes.str();
  }
  return pictures;
}

}  // namespace app
