#pragma once

#include <string>

#include "output/output_folder.h"
#include "output/summary.h"
#include "report/report.h"

namespace app {

/// @throws std::invalid_argument unless `rsvg-convert` is there, which makes PDF and PNG of an SVG
/// @param option  that needs it, "--figures"
void requireSvgConverter(const std::string& option);

/// The folder of --figures: every figure and drawing of a report as SVG and PDF, every picture as
/// PNG, every table as CSV and LaTeX, named after its title, and figures.tex, which shows them all
/// with their captions. The numbers of the summary are a table, too.
void writeFigureFiles(const Report& report, const Summary& summary, OutputFolder& folder);

/// Every figure of a report as a PNG file beside it, 1280 pixels wide.
void writeFigurePngs(const Report& report, OutputFolder& folder);

}  // namespace app
