#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace app {

/// A figure as a file.
struct FigurePicture {
  std::string file;  ///< a name made of the figure's title: work_and_precision.png
  std::string png;   ///< its bytes
};

/// Every figure of a report, drawn as a VTK chart by fisherhill-render, the only program that links
/// VTK.
/// @throws std::runtime_error if that program is missing or fails
std::vector<FigurePicture> figurePictures(const Report& report);

}  // namespace app
