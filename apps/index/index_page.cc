#include "index/index_page.h"

#include <fmt/format.h>

#include <fstream>

#include "output/json_text.h"
#include "output/text.h"
#include "report_assets.h"

namespace app {
namespace {

constexpr const char* generator = "<meta name=\"generator\" content=\"fisherhill index\">";

/// Relative, whatever the names are.
std::string linkTo(const std::string& path) {
  std::string link = "./";
  for (const char c : path) {
    const bool isPlain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '/' || c == '-' || c == '_' || c == '.';
    link += isPlain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return link;
}

std::string nameIn(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

/// @param label  its column, shown where the page is narrow
std::string cell(const char* label, const std::string& text) {
  return fmt::format("<td data-label=\"{}\">{}</td>", label, htmlText(text.empty() ? "–" : text));
}

std::string row(const FoundResult& result, std::size_t index, const std::string& way) {
  std::string trials;
  for (const std::string& trial : result.trials)
    trials += (trials.empty() ? "" : ", ") + nameIn(trial);
  const std::string shown = htmlText(result.folder);
  std::string text =
      fmt::format("<tr><td><input type=\"checkbox\" value=\"{}\" aria-label=\"compare {}\"></td>",
                  index, shown);
  text += result.hasReport
              ? fmt::format("<td><a href=\"{}\">{}</a></td>",
                            htmlText(linkTo(way + result.folder + "/report.html")), shown)
              : fmt::format("<td>{}</td>", shown);
  return text + cell("command", result.subcommand) + cell("model", nameIn(result.model)) +
         cell("inputs", trials) + cell("answer", result.sentence) +
         cell("warnings", std::to_string(result.warnings)) + cell("date", result.date) +
         cell("version", result.version) + "</tr>\n";
}

/// JSON inside a script element that cannot end it.
std::string indexData(const FoundResults& found) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const FoundResult& result : found.results) {
    nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
    for (const auto& [name, value] : result.numbers) numbers.push_back({name, value});
    list.push_back(
        {{"folder", result.folder}, {"sentence", result.sentence}, {"numbers", numbers}});
  }
  return scriptText(list);
}

}  // namespace

std::string indexPage(const FoundResults& found, const std::string& folder,
                      const std::string& way) {
  const std::string title = htmlText("Results in " + folder);
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "script-src 'unsafe-inline'; style-src 'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\">\n{}\n<title>{}</title>\n"
      "<style>{}</style>\n</head>\n<body>\n<main>\n<h1>{}</h1>\n",
      generator, title, assets::indexCss, title);
  text += fmt::format("<p>{} result{}. Choose two to see their numbers side by side.</p>\n",
                      found.results.size(), found.results.size() == 1 ? "" : "s");
  if (!found.unreadable.empty()) {
    text += "<div class=\"warnings\"><h2>Not listed</h2>\n<ul>\n";
    for (const std::string& line : found.unreadable) text += "<li>" + htmlText(line) + "</li>\n";
    text += "</ul></div>\n";
  }
  text +=
      "<label class=\"filter\">Show rows with <input type=\"search\"></label>\n"
      "<div class=\"table\"><table id=\"results\">\n<thead><tr><th>compare</th>";
  for (const char* column : {"result", "command", "model", "trials and other inputs", "answer",
                             "warnings", "date (UTC)", "version"})
    text += fmt::format("<th aria-sort=\"none\"><button type=\"button\">{}</button></th>", column);
  text += "</tr></thead>\n<tbody>\n";
  for (std::size_t i = 0; i < found.results.size(); ++i) text += row(found.results[i], i, way);
  text +=
      "</tbody>\n</table></div>\n<section id=\"comparison\" "
      "aria-live=\"polite\"></section>\n</main>\n";
  text += fmt::format(
      "<script type=\"application/json\" id=\"data\">{}</script>\n<script>{}</script>\n",
      indexData(found), assets::indexJs);
  return text + "</body>\n</html>\n";
}

bool isIndexPage(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string begin(1000, '\0');
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin.find(generator) != begin.npos;
}

}  // namespace app
