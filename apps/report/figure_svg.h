#pragma once

#include <string>

#include "report/report.h"

namespace app {

/// A figure as an SVG file for paper: 140 mm wide, letters of 8 pt, axes with labels and units,
/// bands, the legend below the axes. The title and the caption are in it as text that is not drawn
/// (<title>, <desc>): a paper sets them itself. Points lie below lines, so that neither hides the
/// other. Lines keep only the points that a reader can see.
/// @throws std::invalid_argument if a series' x and y differ in length
std::string figureSvg(const Figure& figure);

}  // namespace app
