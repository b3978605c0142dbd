#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "summary.h"

/// report.html: one self-contained file with interactive plots, readable without a network.
namespace app {

enum class SeriesStyle {
  line,
  dashed,
  points,
  path  ///< drawn in the order given, so that it may turn back; a NaN in y lifts the pen
};

/// The numbers of a vector, as the series of a report take them.
inline std::vector<double> asList(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

/// One curve. A NaN in y means "not measured": the line has a gap there, a point is left out.
struct Series {
  std::string name = {};
  std::vector<double> x = {};  ///< any order; drawn from left to right
  std::vector<double> y = {};  ///< as long as x
  SeriesStyle style = SeriesStyle::line;
  std::vector<double> bandLow = {};   ///< lower edge of a shaded band, as long as x; empty: no band
  std::vector<double> bandHigh = {};  ///< upper edge
};

enum class AxisScale { linear, logarithmic };

/// Curves over one axis. At most eight are told apart by colour; values ≤ 0 on a logarithmic axis
/// are left out.
struct Figure {
  std::string title = {};
  std::string xLabel = {};  ///< with its unit: "Time [s]"
  std::string yLabel = {};  ///< with its unit: "Elbow flexion [deg]"
  std::vector<Series> series = {};
  std::string caption = {};  ///< what to see, one or two sentences; may be empty
  AxisScale xScale = AxisScale::linear;
  AxisScale yScale = AxisScale::linear;
};

/// What draws a figure: title, labels, scales and series with at most six digits, NaN as null; of
/// very long ones the highest and lowest values (thinned_series.h); the report says so.
/// @throws std::invalid_argument if a series' x and y differ in length
nlohmann::ordered_json figureJson(const Figure& figure);

struct Table {
  std::string title = {};
  std::vector<std::string> columns = {};            ///< with units
  std::vector<std::vector<std::string>> rows = {};  ///< each as long as columns
};

/// A picture, kept inside the page.
struct Picture {
  std::string title = {};
  std::string png = {};      ///< the bytes of a PNG file
  std::string caption = {};  ///< what to see, one or two sentences; may be empty
};

/// A drawing, which may move by itself; kept inside the page as it is.
struct VectorDrawing {
  std::string title = {};
  std::string svg = {};  ///< an <svg> element, written by us
  std::string caption = {};
};

struct Paragraph {
  std::string text = {};
};

struct Section {
  std::string title = {};
};

using ReportPart = std::variant<Section, Paragraph, Figure, Table, Picture, VectorDrawing>;

/// First what was run, the verdict in a sentence and the main picture or figure; then the details
/// in their order; then where it all came from, which is taken from the summary.
struct Report {
  std::string title = {};    ///< what was run: "Replay of trial_a.sto on elbow8.osim"
  std::string verdict = {};  ///< the answer in one sentence
  std::optional<Picture> mainPicture = {};  ///< above the figure where there are both
  std::optional<Figure> mainFigure = {};
  std::vector<ReportPart> details = {};
};

/// @throws std::invalid_argument if a series' x and y, or a table's columns and row, differ in
/// length, or a picture is no PNG, or a drawing no SVG
std::string renderReport(const Report& report, const Summary& summary);

}  // namespace app
