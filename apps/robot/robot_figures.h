#pragma once

#include <string>
#include <utility>
#include <vector>

#include "info/estimation/least_squares.h"
#include "robot/robot_search.h"

/// Figures of a motion and of its information.
namespace app {

/// States by name and index, before (dashed) and after.
Figure stateFigure(const std::string& title, const std::string& label, const MotionResult& found,
                   const std::vector<std::pair<std::string, Eigen::Index>>& states);

/// The input, before and after.
Figure inputFigure(const std::string& label, const MotionResult& found);

/// J over the iterations.
Figure costFigure(const info::SearchResult& search);

/// Eigenvalues of the information gathered up to each time, before and after.
Figure informationFigure(const MotionResult& found);

/// Contour map of the cost β over two parameters, with the path of an estimator.
struct Basin {
  std::string title;
  std::vector<std::pair<double, double>> range;  ///< shown range of each parameter
  Eigen::Vector2d truth;
};
Figure basinFigure(const Basin& basin, const info::LeastSquares& problem,
                   const std::vector<Eigen::VectorXd>& way, int threads);

}  // namespace app
