#include "report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <regex>
#include <stdexcept>

#include "info/version.h"
#include "output/json_text.h"
#include "output/text.h"
#include "report/series_stroke.h"
#include "report/thinned_series.h"
#include "report_assets.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;

/// Six significant digits are more than a screen can show.
Json plotNumber(double value) {
  if (!std::isfinite(value)) return nullptr;
  return numberIn(fmt::format("{:.6g}", value));
}

Json plotNumbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(plotNumber(value));
  return list;
}

const char* styleName(SeriesStyle style) {
  switch (style) {
    case SeriesStyle::line:
      return "line";
    case SeriesStyle::dashed:
      return "dashed";
    case SeriesStyle::points:
      return "points";
    case SeriesStyle::path:
      return "path";
  }
  return "line";
}

void mustBeAsLong(const Figure& figure, const Series& series, const std::vector<double>& values,
                  const char* what) {
  if (values.size() == series.x.size()) return;
  throw std::invalid_argument(
      fmt::format("figure '{}', series '{}': {} has {} values and x has {}, must be as many",
                  figure.title, series.name, what, values.size(), series.x.size()));
}

std::string html(const Section& section) {
  std::string text = fmt::format("<h2>{}</h2>\n", htmlText(section.title));
  if (!section.context.empty())
    text += fmt::format("<p class=\"context\">{}</p>\n", htmlText(section.context));
  return text;
}

std::string html(const Paragraph& paragraph) {
  return fmt::format("<p>{}</p>\n", htmlText(paragraph.text));
}

/// The caption, and what is not drawn.
std::string captionOf(const Figure& figure, const Json& drawn) {
  bool isThinned = false;
  for (std::size_t i = 0; i < figure.series.size(); ++i) {
    isThinned = isThinned || drawn["series"][i]["x"].size() < figure.series[i].x.size();
  }
  if (!isThinned) return figure.caption;
  return fmt::format("{}{}Long curves are drawn by the lowest and highest values of {} intervals.",
                     figure.caption, figure.caption.empty() ? "" : " ", thinnedParts);
}

std::string html(const Figure& figure) {
  std::string text =
      fmt::format("<figure>\n<h3>{}</h3>\n<div class=\"plot\"></div>\n", htmlText(figure.title));
  const Json drawn = figureJson(figure);
  text += fmt::format("<script type=\"application/json\">{}</script>\n", scriptText(drawn));
  const std::string caption = captionOf(figure, drawn);
  if (!caption.empty()) text += fmt::format("<figcaption>{}</figcaption>\n", htmlText(caption));
  return text + "</figure>\n";
}

std::string html(const Picture& picture) {
  if (!picture.png.starts_with("\x89PNG")) {
    throw std::invalid_argument(fmt::format("picture '{}': must be a PNG", picture.title));
  }
  std::string text = "<figure class=\"picture\">\n";
  if (!picture.title.empty()) text += fmt::format("<h3>{}</h3>\n", htmlText(picture.title));
  text += fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">\n",
                      htmlText(picture.title), base64(picture.png));
  if (!picture.caption.empty()) {
    text += fmt::format("<figcaption>{}</figcaption>\n", htmlText(picture.caption));
  }
  return text + "</figure>\n";
}

std::string html(const VectorDrawing& drawing) {
  if (!drawing.svg.starts_with("<svg")) {
    throw std::invalid_argument(fmt::format("drawing '{}': must be an SVG", drawing.title));
  }
  return fmt::format(
      "<figure class=\"picture\">\n<h3>{}</h3>\n{}<figcaption>{}</figcaption>\n</figure>\n",
      htmlText(drawing.title), drawing.svg, htmlText(drawing.caption));
}

std::string html(const Playback& playback) {
  if (!playback.still.starts_with("<svg class=\"still\"")) {
    throw std::invalid_argument(
        fmt::format("playback '{}': must have an SVG of class still", playback.title));
  }
  return fmt::format(
      "<figure class=\"playback\">\n<h3>{}</h3>\n{}<script "
      "type=\"application/json\">{}</script>\n<figcaption>{}</figcaption>\n</figure>\n",
      htmlText(playback.title), playback.still, scriptText(playback.data),
      htmlText(playback.caption));
}

/// A line may break behind a hyphen, which "5.4e-05" has: such numbers are kept together.
std::string cellHtml(const std::string& cell) {
  const std::string text = htmlText(cell);
  if (text.find("e-") == text.npos) return text;
  static const std::regex number("[0-9.]+e-[0-9]+");
  return std::regex_replace(text, number, "<span class=\"number\">$&</span>");
}

std::string html(const Table& table) {
  std::string text = "<div class=\"table\">\n";
  if (!table.title.empty()) text += fmt::format("<h3>{}</h3>\n", htmlText(table.title));
  text += "<table>\n<thead><tr>";
  for (const std::string& column : table.columns) {
    text += fmt::format("<th>{}</th>", htmlText(column));
  }
  text += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    if (row.size() != table.columns.size()) {
      throw std::invalid_argument(
          fmt::format("table '{}': a row has {} cells, must be {} as in the head", table.title,
                      row.size(), table.columns.size()));
    }
    text += "<tr>";
    for (const std::string& cell : row) text += fmt::format("<td>{}</td>", cellHtml(cell));
    text += "</tr>\n";
  }
  return text + "</tbody>\n</table>\n</div>\n";
}

/// Lists are for summary.json and for the report's own tables.
void addFigureRows(Table& table, const std::string& name, const Json& value) {
  if (value.is_object()) {
    for (const auto& [key, part] : value.items()) addFigureRows(table, name + "." + key, part);
  } else if (value.is_number_float()) {
    table.rows.push_back({name, numberText(value.get<double>(), 6)});
  } else if (value.is_string()) {
    table.rows.push_back({name, value.get<std::string>()});
  } else if (!value.is_structured()) {
    table.rows.push_back({name, jsonText(value)});
  }
}

std::string methods(const Methods& methods) {
  if (methods.isEmpty()) return "";
  std::string text = html(Section{"Methods", "May be quoted; it says only what was used here."});
  text += html(Paragraph{methods.paragraph()});
  const auto list = [&](const char* title, const std::vector<std::string>& items) {
    if (items.empty()) return;
    text += fmt::format("<h3>{}</h3>\n<ul>\n", title);
    for (const std::string& item : items) text += fmt::format("<li>{}</li>\n", htmlText(item));
    text += "</ul>\n";
  };
  list("Assumptions", methods.assumptions());
  list("References", methods.references());
  return text;
}

bool hasPlayback(const Report& report) {
  return std::any_of(report.details.begin(), report.details.end(),
                     [](const ReportPart& part) { return std::holds_alternative<Playback>(part); });
}

std::string provenance(const Summary& summary, bool has3d) {
  std::string text = html(Section{"Numbers of this result"});
  Table figures = summaryTable(summary);
  figures.title.clear();
  text += html(figures);

  text += html(Section{"Provenance"});
  text += fmt::format("<p>Command line</p>\n<pre>{}</pre>\n", htmlText(summary.commandLine()));
  Table inputs{"", {"input file", "SHA-256"}, {}};
  for (const auto& input : summary.inputs()) inputs.rows.push_back({input.path, input.sha256});
  if (!inputs.rows.empty()) text += html(inputs);
  text += fmt::format("<p>FisherHill {}. Plots by uPlot 1.6.32{} (MIT licence).</p>\n",
                      htmlText(info::version()), has3d ? ", motions by three.js 0.170.0" : "");
  return text;
}

std::string warningList(const Summary& summary) {
  if (summary.warnings().empty()) return "";
  std::string text = "<div class=\"warnings\"><h2>Warnings</h2>\n<ul>\n";
  for (const std::string& warning : summary.warnings()) {
    text += fmt::format("<li>{}</li>\n", htmlText(warning));
  }
  return text + "</ul></div>\n";
}

}  // namespace

nlohmann::ordered_json figureJson(const Figure& figure) {
  Json json = {{"title", figure.title},
               {"xLabel", figure.xLabel},
               {"yLabel", figure.yLabel},
               {"xLog", figure.xScale == AxisScale::logarithmic},
               {"yLog", figure.yScale == AxisScale::logarithmic},
               {"series", Json::array()}};
  for (std::size_t i = 0; i < figure.series.size(); ++i) {
    const Series& whole = figure.series[i];
    mustBeAsLong(figure, whole, whole.y, "y");
    if (!whole.bandLow.empty() || !whole.bandHigh.empty()) {
      mustBeAsLong(figure, whole, whole.bandLow, "bandLow");
      mustBeAsLong(figure, whole, whole.bandHigh, "bandHigh");
    }
    const Series series = thinned(whole);
    const SeriesStroke stroke = strokeOf(figure, i);
    Json one = {{"name", series.name},        {"style", styleName(series.style)},
                {"colour", stroke.colour},    {"dashes", stroke.dashes},
                {"x", plotNumbers(series.x)}, {"y", plotNumbers(series.y)}};
    if (!series.bandLow.empty() || !series.bandHigh.empty()) {
      one["low"] = plotNumbers(series.bandLow);
      one["high"] = plotNumbers(series.bandHigh);
    }
    json["series"].push_back(std::move(one));
  }
  return json;
}

Table summaryTable(const Summary& summary) {
  Table table{"Numbers of this result", {"name (unit at its end)", "value"}, {}};
  addFigureRows(table, "", summary.figures());
  for (auto& row : table.rows) row.front().erase(0, 1);  // the dot before a top-level name
  return table;
}

std::string renderReport(const Report& report, const Summary& summary) {
  std::string text = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  text +=
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  text += fmt::format("<title>{}</title>\n", htmlText(report.title));
  const bool has3d = hasPlayback(report);
  text += fmt::format("<!-- Contains uPlot 1.6.32.\n{}-->\n", assets::uplotLicence);
  if (has3d) text += fmt::format("<!-- Contains three.js 0.170.0.\n{}-->\n", assets::threeLicence);
  text += fmt::format("<style>{}\n{}</style>\n", assets::uplotCss, assets::reportCss);
  text += "</head>\n<body>\n<main>\n";
  text += fmt::format("<header><h1>{}</h1>\n<p class=\"verdict\">{}</p></header>\n",
                      htmlText(report.title), htmlText(report.verdict));
  if (report.mainPicture) text += html(*report.mainPicture);
  if (report.mainFigure) text += html(*report.mainFigure);
  text += warningList(summary);
  for (const auto& part : report.details) {
    text += std::visit([](const auto& item) { return html(item); }, part);
  }
  text += methods(summary.methods());
  text += provenance(summary, has3d);
  text += "</main>\n";
  text += fmt::format("<script>{}\n{}</script>\n", assets::uplotJs, assets::reportJs);
  if (has3d) {
    text += fmt::format("<script>{}</script>\n<script>{}\n{}\n{}</script>\n", assets::threeJs,
                        assets::sceneJs, assets::playerJs, assets::playbackJs);
  }
  return text + "</body>\n</html>\n";
}

}  // namespace app
