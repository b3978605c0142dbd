#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "output/summary.h"

/// report.html: one self-contained file with interactive plots, readable without a network.
namespace app {

enum class SeriesStyle {
  line,
  dashed,
  points,
  path  ///< drawn in the given order, so x may decrease; a NaN in y interrupts the line
};

/// The numbers of a vector, as the series of a report take them.
inline std::vector<double> asList(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

/// One curve. A NaN in y means "not measured": a gap in the line, or a missing point.
struct Series {
  std::string name = {};
  std::vector<double> x = {};  ///< any order; drawn from left to right
  std::vector<double> y = {};  ///< as long as x
  SeriesStyle style = SeriesStyle::line;
  std::vector<double> bandLow = {};   ///< lower edge of a shaded band, as long as x; empty: no band
  std::vector<double> bandHigh = {};  ///< upper edge
};

enum class AxisScale { linear, logarithmic };

/// Curves over one axis. At most eight are distinguished by colour; values ≤ 0 on a logarithmic
/// axis are left out.
struct Figure {
  std::string title = {};
  std::string xLabel = {};  ///< with its unit: "Time [s]"
  std::string yLabel = {};  ///< with its unit: "Elbow flexion [deg]"
  std::vector<Series> series = {};
  std::string caption = {};  ///< one or two sentences; may be empty
  AxisScale xScale = AxisScale::linear;
  AxisScale yScale = AxisScale::linear;
};

/// The data of a figure for the page's script: title, labels, scales and series with at most six
/// digits, NaN as null. Very long series are reduced to their highest and lowest values
/// (thinned_series.h), and the report says so.
/// @throws std::invalid_argument if a series' x and y differ in length
nlohmann::ordered_json figureJson(const Figure& figure);

struct Table {
  std::string title = {};
  std::vector<std::string> columns = {};            ///< with units
  std::vector<std::vector<std::string>> rows = {};  ///< each as long as columns
};

/// A picture, embedded in the page.
struct Picture {
  std::string title = {};
  std::string png = {};      ///< the bytes of a PNG file
  std::string caption = {};  ///< what to see, one or two sentences; may be empty
};

/// A drawing, possibly animated, embedded in the page.
struct VectorDrawing {
  std::string title = {};
  std::string svg = {};  ///< an <svg> element, written by us
  std::string caption = {};
};

/// Motions in three dimensions that a reader plays: what playback.js reads, see playback.h.
struct Playback {
  std::string title = {};
  nlohmann::ordered_json data = {};
  std::string still =
      {};  ///< an <svg> element with class "still": shown on paper and without WebGL
  std::string caption = {};
};

struct Paragraph {
  std::string text = {};
};

/// The parts that follow belong to it, up to the next one.
struct Section {
  std::string title = {};
  std::string context =
      {};  ///< what it shows, and how to read it; one or two sentences; may be empty
};

using ReportPart =
    std::variant<Section, Paragraph, Figure, Table, Picture, VectorDrawing, Playback>;

/// A report: title, verdict and main picture or figure, then the details in their order, then
/// methods, numbers and provenance, which are taken from the summary.
struct Report {
  std::string title = {};    ///< what was run: "Replay of trial_a.sto on elbow8.osim"
  std::string verdict = {};  ///< the answer in one sentence
  std::optional<Picture> mainPicture = {};  ///< above the figure if there are both
  std::optional<Figure> mainFigure = {};
  std::vector<ReportPart> details = {};
};

/// The numbers and texts of a summary, by their names.
Table summaryTable(const Summary& summary);

/// @throws std::invalid_argument if a series' x and y, or a table's columns and row, differ in
///   length, or a picture is not a PNG, or a drawing not an SVG
std::string renderReport(const Report& report, const Summary& summary);

}  // namespace app
