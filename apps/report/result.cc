#include "report/result.h"

#include <fmt/format.h>

#include "output/json_text.h"
#include "output/text.h"
#include "report/figure_files.h"
#include "report/reproduce_script.h"

namespace app {
namespace {

void printFigure(const std::string& name, const nlohmann::ordered_json& value) {
  if (value.is_object()) {
    for (const auto& [key, part] : value.items()) printFigure(name + "." + key, part);
    return;
  }
  if (value.is_array()) return;  // lists are for the files
  const std::string text = value.is_number_float() ? numberText(value.get<double>())
                           : value.is_string()     ? value.get<std::string>()
                           : value.is_null()       ? "–"
                                                   : jsonText(value);
  fmt::print("  {:<32} {}\n", name, text);
}

}  // namespace

void deliver(const CommandContext& context, const Summary& summary, const Report& report,
             OutputFolder& folder) {
  if (folder.figures() != nullptr) writeFigureFiles(report, summary, *folder.figures());
  deliverPage(context, summary, report.verdict,
              folder.active() ? renderReport(report, summary) : std::string(), folder);
}

void deliverPage(const CommandContext& context, const Summary& summary, const std::string& verdict,
                 const std::string& page, OutputFolder& folder) {
  nlohmann::ordered_json json = summary.toJson();
  folder.write("report.html", [&](std::ostream& out) { out << page; });
  if (const std::string script = reproduceScript(context, summary); !script.empty()) {
    folder.write("reproduce.sh", [&](std::ostream& out) { out << script; });
    folder.makeExecutable("reproduce.sh");
  }
  json["sentence"] = verdict;
  json["files"] = folder.files();
  json["files_sha256"] = nlohmann::ordered_json::object();
  for (const std::string& name : folder.files()) json["files_sha256"][name] = folder.hashOf(name);
  folder.write("summary.json", [&](std::ostream& out) { out << jsonText(json, 2) << '\n'; });
  if (folder.figures() != nullptr) folder.figures()->commit();
  folder.commit();

  if (context.quiet) return;
  if (context.json) {
    fmt::print("{}\n", jsonText(json, 2));
    return;
  }
  fmt::print("{}\n", verdict);
  for (const auto& [name, value] : summary.figures().items()) printFigure(name, value);
  if (folder.active()) fmt::print("Report: {}\n", folder.path("report.html").string());
  if (folder.figures() != nullptr)
    fmt::print("Figures: {}\n", folder.figures()->path("figures.tex").string());
}

}  // namespace app
