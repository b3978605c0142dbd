#pragma once

#include <string>
#include <utility>
#include <vector>

#include "info/least_squares.h"
#include "robot_search.h"

/// The pictures of a motion and of what it tells.
namespace app {

/// States by name and place, before (dashed) and after.
Figure stateFigure(const std::string& title, const std::string& label, const Found& found,
                   const std::vector<std::pair<std::string, Eigen::Index>>& states);

/// The input, before and after.
Figure inputFigure(const std::string& label, const Found& found);

/// J over the iterations.
Figure costFigure(const info::SearchResult& search);

/// Eigenvalues of the information gathered up to each time, before and after.
Figure informationFigure(const Found& found);

/// β over two parameters as a map of isolines, with the way of an estimator on it.
struct Basin {
  std::string title;
  std::vector<std::pair<double, double>> range;  ///< shown, of each parameter
  Eigen::Vector2d truth;
};
Figure basinFigure(const Basin& basin, const info::LeastSquares& problem,
                   const std::vector<Eigen::VectorXd>& way, int threads);

}  // namespace app
