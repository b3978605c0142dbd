#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "command/command.h"
#include "index/found_results.h"
#include "index/index_page.h"
#include "output/json_text.h"
#include "output/summary.h"

namespace app {
namespace {

namespace fs = std::filesystem;

/// Written aside first, so that a reader finds the older page or the new one.
void writeAtOnce(const fs::path& file, const std::string& text) {
  const fs::path aside = fmt::format("{}.unfinished-{}", file.string(), getpid());
  std::ofstream stream(aside, std::ios::binary);
  stream << text;
  stream.close();
  std::error_code error;
  if (stream) fs::rename(aside, file, error);
  if (stream && !error) return;
  std::error_code ignored;
  fs::remove(aside, ignored);
  throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
}

class Index : public Command {
 public:
  About about() const override {
    return {"index", "List the results of a folder on one page, two of them side by side",
            "fisherhill index out"};
  }

  void addOptions(CLI::App& options) override {
    options.add_option("DIR", folder_, "folder of results: of folders with a summary.json")
        ->required()
        ->check(CLI::ExistingDirectory)
        ->type_name("");
  }

  ExitStatus run(const CommandContext& context) override {
    if (context.figures) throw std::invalid_argument("--figures: an index has no figures");
    const fs::path place = context.out.value_or(folder_), file = place / "index.html";
    if (!fs::is_directory(place))
      throw std::invalid_argument(fmt::format("--out {}: is not a folder", place.string()));
    if (fs::exists(fs::symlink_status(file)) && !context.force && !isIndexPage(file)) {
      throw std::runtime_error(fmt::format(
          "{}: exists already and is not an index; --force overwrites it", file.string()));
    }
    const FoundResults found = resultsBelow(folder_);
    if (found.results.empty())
      throw std::invalid_argument(
          fmt::format("{}: holds no result (a folder with a summary.json)", folder_));
    std::string way = fs::relative(fs::canonical(folder_), fs::canonical(place)).string() + "/";
    if (way == "./") way.clear();
    Summary summary(context);
    for (const std::string& line : found.unreadable) summary.warn(line);
    writeAtOnce(file, indexPage(found, folder_, way));
    tell(found, summary);
    if (context.json) {
      nlohmann::ordered_json json = summary.toJson();
      json["files"] = {"index.html"};
      json["sentence"] = sentence(found);
      fmt::print("{}\n", jsonText(json, 2));
      return ExitStatus::done;
    }
    fmt::print("{}\n", sentence(found));
    fmt::print("Index: {}\n", file.string());
    return ExitStatus::done;
  }

 private:
  std::string sentence(const FoundResults& found) const {
    return fmt::format("{} result{} in {}.", found.results.size(),
                       found.results.size() == 1 ? "" : "s", folder_);
  }

  static void tell(const FoundResults& found, Summary& summary) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const FoundResult& result : found.results) {
      list.push_back({{"folder", result.folder},
                      {"subcommand", result.subcommand},
                      {"model", result.model},
                      {"inputs", result.trials},
                      {"sentence", result.sentence},
                      {"warnings", result.warnings},
                      {"date", result.date},
                      {"version", result.version}});
    }
    summary.set("results", std::move(list));
  }

  std::string folder_;
};

}  // namespace

/// `index`: a page over a folder of results.
std::unique_ptr<Command> indexCommand() {
  return std::make_unique<Index>();
}

}  // namespace app
