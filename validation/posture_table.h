#pragma once

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace validation {

/// A table of postures as OpenSim computed them: a column for each coordinate, and for each path
/// NAME.length_m, NAME.wrapped (words) and NAME.dlength_d.COORDINATE.
struct PostureTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;

  bool has(const std::string& column) const {
    return std::find(columns.begin(), columns.end(), column) != columns.end();
  }
  /// Null if there is no such column.
  const std::string* find(std::size_t row, const std::string& column) const {
    const auto at = std::find(columns.begin(), columns.end(), column);
    if (at == columns.end()) return nullptr;
    return &rows[row][static_cast<std::size_t>(at - columns.begin())];
  }
  double number(std::size_t row, const std::string& column) const {
    const std::string* text = find(row, column);
    if (text == nullptr) throw std::runtime_error("no column " + column);
    return std::stod(*text);
  }
};

inline std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(line);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

inline PostureTable readPostures(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file);
  PostureTable table;
  std::string line;
  std::getline(in, line);
  table.columns = split(line, ',');
  while (std::getline(in, line)) table.rows.push_back(split(line, ','));
  return table;
}

}  // namespace validation
