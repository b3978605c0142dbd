#include "sensitivity/named_covariance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "options/quantity.h"
#include "output/resumable_table.h"

namespace app {
namespace {

constexpr std::size_t mostNames = 1000;

std::string trimmed(const std::string& cell) {
  const char* const space = " \t\r\"";
  const auto from = cell.find_first_not_of(space);
  return from == cell.npos ? "" : cell.substr(from, cell.find_last_not_of(space) - from + 1);
}

/// Lines that are not empty, in cells; at most so many.
class CellReader {
 public:
  explicit CellReader(const std::filesystem::path& file) : file_(file.string()), stream_(file) {
    if (!stream_) throw failure("cannot be read");
  }

  bool next(std::vector<std::string>& cells) {
    for (std::string line; std::getline(stream_, line);) {
      ++line_;
      if (trimmed(line).empty()) continue;
      cells = cellsOf(line);
      for (std::string& cell : cells) cell = trimmed(cell);
      return true;
    }
    return false;
  }

  std::invalid_argument failure(const std::string& what) const {
    if (line_ == 0) return std::invalid_argument(fmt::format("{}: {}", file_, what));
    return std::invalid_argument(fmt::format("{}: line {}: {}", file_, line_, what));
  }

 private:
  std::string file_;
  std::ifstream stream_;
  int line_ = 0;
};

double numberOfCell(const std::string& cell, const std::string& column, const CellReader& reader) {
  double value = std::nan("");
  try {
    value = parseNumber(cell);
  } catch (const std::invalid_argument&) {
  }
  if (std::isfinite(value)) return value;
  throw reader.failure(fmt::format("column {}: '{}' must be a finite number", column, cell));
}

}  // namespace

NamedCovariance readCovariance(const std::filesystem::path& file) {
  CellReader reader(file);
  std::vector<std::string> cells;
  if (!reader.next(cells)) throw reader.failure("is empty, must be a covariance");
  const bool rowsHaveNames = cells.front().empty() || cells.front() == "parameter";
  NamedCovariance covariance;
  covariance.names.assign(cells.begin() + (rowsHaveNames ? 1 : 0), cells.end());
  const std::vector<std::string>& names = covariance.names;
  if (names.empty() || names.size() > mostNames) {
    throw reader.failure(fmt::format("{} names, must be 1 to {}", names.size(), mostNames));
  }
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (name->empty()) throw reader.failure("a name is empty, must be a covariance");
    if (std::find(names.begin(), name, *name) != name) {
      throw reader.failure(fmt::format("{} is listed twice, must be listed once", *name));
    }
  }
  const auto n = static_cast<Eigen::Index>(names.size());
  covariance.values.resize(n, n);
  Eigen::Index row = 0;
  for (; reader.next(cells); ++row) {
    if (row == n)
      throw reader.failure(fmt::format("more rows than the {} names, must be as many", n));
    if (cells.size() != names.size() + (rowsHaveNames ? 1 : 0)) {
      throw reader.failure(fmt::format("{} cells, must be {} as in the first line", cells.size(),
                                       names.size() + (rowsHaveNames ? 1 : 0)));
    }
    if (rowsHaveNames) {
      if (cells.front() != names[static_cast<std::size_t>(row)]) {
        throw reader.failure(fmt::format("row of '{}', must be '{}' as in the first line",
                                         cells.front(), names[static_cast<std::size_t>(row)]));
      }
      cells.erase(cells.begin());
    }
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto at = static_cast<std::size_t>(j);
      covariance.values(row, j) = numberOfCell(cells[at], names[at], reader);
    }
  }
  if (row != n) throw reader.failure(fmt::format("{} rows for {} names, must be as many", row, n));
  try {
    bio::requireCovariance(covariance);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", file.string(), error.what()));
  }
  return covariance;
}

void writeCovariance(const NamedCovariance& covariance, std::ostream& out) {
  out << "parameter";
  for (const std::string& name : covariance.names) out << ',' << name;
  out << '\n';
  for (Eigen::Index i = 0; i < covariance.values.rows(); ++i) {
    out << covariance.names[static_cast<std::size_t>(i)];
    for (const double value : covariance.values.row(i)) out << fmt::format(",{}", value);
    out << '\n';
  }
}

}  // namespace app
