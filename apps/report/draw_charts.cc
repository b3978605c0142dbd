#include "report/draw_charts.h"

#include <fmt/format.h>

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "view/chart.h"
#include "view/system_scene.h"
#include "view/virtual_display.h"

namespace app {
namespace {

namespace view = bio::view;

std::vector<double> numbersOf(const nlohmann::json& list) {
  std::vector<double> numbers;
  for (const auto& value : list) {
    numbers.push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN()
                                      : value.get<double>());
  }
  return numbers;
}

view::Chart chartOf(const nlohmann::json& figure) {
  view::Chart chart{.title = figure.at("title"),
                    .xLabel = figure.at("xLabel"),
                    .yLabel = figure.at("yLabel"),
                    .xLogarithmic = figure.at("xLog"),
                    .yLogarithmic = figure.at("yLog"),
                    .curves = {}};
  for (const auto& series : figure.at("series")) {
    const std::string style = series.at("style");
    chart.curves.push_back({series.at("name"), numbersOf(series.at("x")), numbersOf(series.at("y")),
                            style == "points"   ? view::CurveStyle::points
                            : style == "dashed" ? view::CurveStyle::dashed
                                                : view::CurveStyle::line});
  }
  return chart;
}

}  // namespace

void drawCharts(const std::filesystem::path& jsonFile, const std::filesystem::path& folder) {
  std::ifstream stream(jsonFile);
  const nlohmann::json list = nlohmann::json::parse(stream);
  const view::VirtualDisplay display;
  for (std::size_t i = 0; i < list.size(); ++i) {
    std::ofstream(folder / fmt::format("{}.png", i), std::ios::binary)
        << view::pngOf(view::drawChart(chartOf(list[i])));
  }
}

}  // namespace app
