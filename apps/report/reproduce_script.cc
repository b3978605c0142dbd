#include "report/reproduce_script.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "info/version.h"
#include "output/text.h"
#include "report_assets.h"

namespace app {
namespace {

namespace fs = std::filesystem;

struct RepeatedWords {
  std::string command;  ///< quoted, but "$new" stands for the folder of --out
  std::string out;      ///< what was typed there
};

RepeatedWords repeatedWords(const std::vector<std::string>& typed) {
  RepeatedWords repeated;
  const std::string_view out = "--out", figures = "--figures";
  for (std::size_t i = 1; i < typed.size(); ++i) {
    const std::string& word = typed[i];
    const auto isValueOf = [&](std::string_view option) { return i > 1 && typed[i - 1] == option; };
    const auto holds = [&](std::string_view option) {
      return word.starts_with(option) && word.size() > option.size() && word[option.size()] == '=';
    };
    if (word == "--force" || word == out || word == figures || holds(figures) || isValueOf(figures))
      continue;
    if (holds(out) || isValueOf(out)) {
      repeated.out = holds(out) ? word.substr(out.size() + 1) : word;
      repeated.command += " --out \"$new\"";
    } else {
      repeated.command += " " + shellWord(word);
    }
  }
  return repeated;
}

/// A line for `sha256sum --check`, which wants line breaks and backslashes escaped.
std::string checkedLine(const Summary::InputFile& input) {
  std::string name;
  for (const char c : input.path)
    name += c == '\\' ? "\\\\" : c == '\n' ? "\\n" : c == '\r' ? "\\r" : std::string(1, c);
  return fmt::format("{}{}  {}\n", name == input.path ? "" : "\\", input.sha256, name);
}

/// Quoted even if it needs no quotes.
std::string quoted(const std::string& text) {
  const std::string word = shellWord(text);
  return word.starts_with('\'') ? word : "'" + word + "'";
}

}  // namespace

std::string reproduceScript(const CommandContext& context, const Summary& summary) {
  const RepeatedWords repeated = repeatedWords(context.commandLine);
  if (!context.out || repeated.out != context.out->string()) return "";
  std::string inputs;
  for (const auto& input : summary.inputs()) inputs += checkedLine(input);
  const fs::path here = fs::current_path();
  std::error_code failed;
  const std::string back = fs::relative(here, fs::canonical(*context.out, failed), failed).string();
  return filled(assets::reproduceSh,
                {{"inputs", inputs},
                 {"version", quoted(fmt::format("fisherhill {}", info::version()))},
                 {"then_in", quoted(here.string())},
                 {"back", quoted(back.empty() ? "." : back)},
                 {"command", repeated.command}});
}

}  // namespace app
