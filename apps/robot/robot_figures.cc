#include "robot/robot_figures.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>

#include "info/information/symmetric_eigen.h"
#include "info/parallel_for.h"
#include "output/text.h"
#include "report/isolines.h"

namespace app {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

Series curve(const std::string& name, const TimedMotion& motion,
             const std::function<double(std::size_t)>& y, SeriesStyle style = SeriesStyle::line) {
  Series series{.name = name, .style = style};
  for (std::size_t k = 0; k < motion.x.size(); ++k) {
    series.x.push_back(motion.step * static_cast<double>(k));
    series.y.push_back(y(k));
  }
  return series;
}

}  // namespace

Figure stateFigure(const std::string& title, const std::string& label, const MotionResult& found,
                   const std::vector<std::pair<std::string, Index>>& states) {
  Figure figure{.title = title, .xLabel = "Time [s]", .yLabel = label};
  for (const auto& [name, index] : states) {
    const Index i = index;
    figure.series.push_back(curve(
        name + ", start", found.before, [&](std::size_t k) { return found.before.x[k][i]; },
        SeriesStyle::dashed));
    figure.series.push_back(curve(name + ", optimised", found.after,
                                  [&](std::size_t k) { return found.after.x[k][i]; }));
  }
  return figure;
}

Figure inputFigure(const std::string& label, const MotionResult& found) {
  return {.title = "Input",
          .xLabel = "Time [s]",
          .yLabel = label,
          .series = {
              curve(
                  "start", found.before, [&](std::size_t k) { return found.before.u[k][0]; },
                  SeriesStyle::dashed),
              curve("optimised", found.after, [&](std::size_t k) { return found.after.u[k][0]; })}};
}

Figure costFigure(const info::SearchResult& search) {
  Series series{.name = "J"};
  for (std::size_t i = 0; i < search.costs.size(); ++i) {
    series.x.push_back(static_cast<double>(i));
    series.y.push_back(search.costs[i]);
  }
  return {.title = "Cost of the motion",
          .xLabel = "Iteration",
          .yLabel = "J [1]",
          .series = {series},
          .yScale = AxisScale::logarithmic};
}

Figure informationFigure(const MotionResult& found) {
  Figure figure{
      .title = "Information over time",
      .xLabel = "Time [s]",
      .yLabel = "Eigenvalue of the information so far",
      .series = {},
      .caption = "Eigenvalues λ of the Fisher information of all measurements up to that time.",
      .yScale = AxisScale::logarithmic};
  const auto add = [&](const char* name, const TimedMotion& motion, SeriesStyle style) {
    for (Index i : {0, 1})
      figure.series.push_back(curve(
          fmt::format("{}, {}", i == 0 ? "least" : "greatest", name), motion,
          [&](std::size_t k) {
            const double lambda = info::symmetricEigenvalues(motion.grown[k])[i];
            // rounding makes tiny ones of either sign where nothing is known yet
            return lambda > 1e-12 * motion.grown.back().trace()
                       ? lambda
                       : std::numeric_limits<double>::quiet_NaN();
          },
          style));
  };
  add("start", found.before, SeriesStyle::dashed);
  add("optimised", found.after, SeriesStyle::line);
  return figure;
}

Figure basinFigure(const Basin& basin, const info::LeastSquares& problem,
                   const std::vector<VectorXd>& way, int threads) {
  constexpr int count = 41;
  std::vector<double> x, y;
  const auto place = [](const std::pair<double, double>& range, int i) {
    return range.first + (range.second - range.first) * i / (count - 1);
  };
  for (int i = 0; i < count; ++i) {
    x.push_back(place(basin.range[0], i));
    y.push_back(place(basin.range[1], i));
  }
  MatrixXd heights(count, count);
  info::parallelFor(count, threads, [&](int i) {
    for (int j = 0; j < count; ++j)
      heights(i, j) = problem.cost(Eigen::Vector2d(x[std::size_t(i)], y[std::size_t(j)]));
  });
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (double height : heights.reshaped())
    if (std::isfinite(height)) {
      least = std::min(least, height);
      most = std::max(most, height);
    }
  // squares of equal spacing: a parabola's isolines are then equidistant
  constexpr int lines = 12;
  std::vector<double> levels;
  for (int i = 1; i <= lines; ++i)
    levels.push_back(least + (most - least) * std::pow((i - 0.5) / lines, 2));

  const auto inside = [&](const VectorXd& theta) {
    for (Index i : {0, 1}) {
      const auto& [low, high] = basin.range[std::size_t(i)];
      if (!(theta[i] >= low && theta[i] <= high)) return false;
    }
    return true;
  };
  const auto point = [](const std::string& name, const VectorXd& at) {
    return Series{.name = name, .x = {at[0]}, .y = {at[1]}, .style = SeriesStyle::points};
  };
  Series path{.name = "path of the estimator", .style = SeriesStyle::path},
      stops{.name = "iterations", .style = SeriesStyle::points};
  std::size_t outside = 0;
  for (const VectorXd& theta : way) {
    const bool in = inside(theta);
    path.x.push_back(theta[0]);
    path.y.push_back(in ? theta[1] : std::numeric_limits<double>::quiet_NaN());
    if (in) {
      stops.x.push_back(theta[0]);
      stops.y.push_back(theta[1]);
    } else {
      ++outside;
    }
  }
  const auto& parameters = problem.parameters();
  std::string caption = fmt::format(
      "Contour lines of the cost β from {} to {}; they are closer where β is steeper than a "
      "parabola.",
      numberText(levels.front(), 3), numberText(levels.back(), 3));
  if (outside > 0)
    caption += fmt::format(" {} of the estimator's iterations lie outside.", outside);
  return {.title = basin.title,
          .xLabel = label(parameters[0]),
          .yLabel = label(parameters[1]),
          .series = {isolines("contour lines of β", x, y, heights, levels), path, stops,
                     point("true value", basin.truth)},
          .caption = caption};
}

}  // namespace app
