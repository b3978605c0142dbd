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

/// A table as a tabular environment with rules of the package booktabs, columns of numbers to the
/// right. One that is too wide for a page has heads of two lines and, if that is not enough, is a
/// tabularx of the line's width whose longest texts wrap, set ragged right.
std::string latexTable(const Table& table);

}  // namespace app
