#pragma once

#include <string>
#include <string_view>

#include "report/report.h"

namespace app {

/// A table as CSV (RFC 4180), the columns' names in the first row.
std::string csvText(const Table& table);

/// The text for LaTeX: its special characters escaped, Greek letters and signs of mathematics as
/// commands, so that pdfLaTeX knows them. Characters that it may not know stand as they are.
std::string latexText(std::string_view text);

/// latexText() that may be broken behind slashes and underscores, as of paths and names.
std::string latexProse(std::string_view text);

/// A table as a tabular environment with rules of the package booktabs, columns of numbers to the
/// right. One that is wider than a line is set smaller (graphicx), its heads in several lines;
/// texts of one that would be too small wrap, ragged right (array).
std::string latexTable(const Table& table);

}  // namespace app
