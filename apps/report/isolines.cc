#include "report/isolines.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace app {
namespace {

struct Corner {
  double x, y, height;
};

// Where the line through a triangle meets its sides: none or two points.
void addTriangle(const std::array<Corner, 3>& corners, double level, Series& series) {
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner &a = corners[i], &b = corners[(i + 1) % 3];
    if ((a.height < level) == (b.height < level)) continue;
    const double share = (level - a.height) / (b.height - a.height);
    points.emplace_back(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y));
  }
  if (points.size() != 2) return;
  for (const auto& [x, y] : points) {
    series.x.push_back(x);
    series.y.push_back(y);
  }
  series.x.push_back(points[1].first);
  series.y.push_back(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

Series isolines(const std::string& name, const std::vector<double>& x, const std::vector<double>& y,
                const Eigen::MatrixXd& heights, const std::vector<double>& levels) {
  if (x.size() < 2 || y.size() < 2 || heights.rows() != Eigen::Index(x.size()) ||
      heights.cols() != Eigen::Index(y.size()))
    throw std::invalid_argument(
        fmt::format("isolines: {} × {} heights for {} x and {} y, must be as many and ≥ 2",
                    heights.rows(), heights.cols(), x.size(), y.size()));
  Series series{.name = name, .style = SeriesStyle::path};
  for (std::size_t i = 0; i + 1 < x.size(); ++i)
    for (std::size_t j = 0; j + 1 < y.size(); ++j) {
      const auto corner = [&](std::size_t di, std::size_t dj) {
        return Corner{x[i + di], y[j + dj], heights(Eigen::Index(i + di), Eigen::Index(j + dj))};
      };
      // two triangles a cell: unlike a square, a triangle is never ambiguous
      const Corner a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
      if (!std::isfinite(a.height + b.height + c.height + d.height)) continue;
      for (double level : levels) {
        addTriangle({a, b, c}, level, series);
        addTriangle({a, c, d}, level, series);
      }
    }
  return series;
}

}  // namespace app
