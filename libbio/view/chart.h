#pragma once

#include <string>
#include <vector>

#include "view/film_writer.h"

namespace bio::view {

enum class CurveStyle { line, dashed, points };

/// One curve; NaN leaves a gap.
struct ChartCurve {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;  ///< as long as x
  CurveStyle style = CurveStyle::line;
};

/// Curves over one axis. Values ≤ 0 on a logarithmic axis are left out.
struct Chart {
  std::string title;
  std::string xLabel, yLabel;  ///< with their units
  bool xLogarithmic = false, yLogarithmic = false;
  std::vector<ChartCurve> curves;
};

/// The chart as a picture, its legend beside it. Eight colours that colour-blind readers tell apart
/// (M. Okabe and K. Ito, 2008, grey for their yellow); dashes from the ninth curve on. There must
/// be a display (VirtualDisplay).
/// @param width, height  [pixel] > 0
/// @throws std::invalid_argument if a curve's x and y differ in length
Image drawChart(const Chart& chart, int width = 1280, int height = 800);

}  // namespace bio::view
