#include "bio/simulation/prescribed_motion.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace bio {

void PrescribedMotion::add(int coordinate, const std::vector<double>& times,
                           const std::vector<double>& values) {
  const auto require = [](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument(fmt::format("prescribed motion: {}", rule));
  };
  require(!times.empty() && times.size() == values.size(),
          "must have at least one time, and a value for each");
  for (std::size_t k = 0; k < times.size(); ++k) {
    require(std::isfinite(times[k]) && std::isfinite(values[k]), "times and values must be finite");
    require(k == 0 || times[k] > times[k - 1], "times must rise");
  }
  for (const Course& course : courses_) {
    require(course.coordinate != coordinate, "a coordinate must be prescribed once");
  }
  constexpr double ever = std::numeric_limits<double>::infinity();
  if (times.size() == 1) {
    courses_.push_back(
        {coordinate, -ever, ever, FunctionEvaluator(Function{1, ConstantFunction{values[0]}})});
  } else {
    courses_.push_back({coordinate, times.front(), times.back(),
                        FunctionEvaluator(Function{1, SplineFunction{times, values}})});
  }
}

CurveValue PrescribedMotion::at(const Course& course, double t) {
  // behind its last point the spline is straight; that point itself belongs to the curve
  const double inside = std::nextafter(course.last, -std::numeric_limits<double>::infinity());
  return course.curve.evaluate(t >= course.last ? inside : t);
}

}  // namespace bio
