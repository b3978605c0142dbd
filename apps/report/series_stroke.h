#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "report/report.h"

namespace app {

/// How a curve is drawn, on the screen and on paper.
struct SeriesStroke {
  std::string colour = {};          ///< "#0072B2"
  std::vector<double> dashes = {};  ///< lengths of dash and gap in turn [px]; empty: solid
  std::size_t marker = 0;           ///< of points: which shape, counted from 0
};

/// The colours of M. Okabe and K. Ito (2008), which colour-blind readers tell apart; grey stands
/// for their yellow, too pale on white. Lines differ by their dashes as well, points by their
/// markers, so that the legend can be read in black and white: no two of forty lines agree in both.
/// @param index < number of series
SeriesStroke strokeOf(const Figure& figure, std::size_t index);

}  // namespace app
