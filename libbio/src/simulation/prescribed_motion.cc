#include "bio/simulation/prescribed_motion.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace bio {

namespace {

constexpr double ever = std::numeric_limits<double>::infinity();

void requireCourse(bool holds, const char* rule) {
  if (!holds) throw std::invalid_argument(fmt::format("prescribed motion: {}", rule));
}

}  // namespace

void PrescribedMotion::requireNew(int coordinate) const {
  for (const Course& course : courses_) {
    requireCourse(course.coordinate != coordinate, "a coordinate must be prescribed once");
  }
}

void PrescribedMotion::add(int coordinate, const std::vector<double>& times,
                           const std::vector<double>& values) {
  requireCourse(!times.empty() && times.size() == values.size(),
                "must have at least one time, and a value for each");
  for (std::size_t k = 0; k < times.size(); ++k) {
    requireCourse(std::isfinite(times[k]) && std::isfinite(values[k]),
                  "times and values must be finite");
    requireCourse(k == 0 || times[k] > times[k - 1], "times must rise");
  }
  requireNew(coordinate);
  if (times.size() == 1) {
    courses_.push_back({coordinate, -ever, ever, ever,
                        FunctionEvaluator(Function{1, ConstantFunction{values[0]}})});
  } else {
    courses_.push_back({coordinate, times.front(), times.back(), times.back(),
                        FunctionEvaluator(Function{1, SplineFunction{times, values}})});
  }
}

void PrescribedMotion::add(int coordinate, const Function& function) {
  requireNew(coordinate);
  double lastKnot = ever;
  if (const auto* spline = std::get_if<SplineFunction>(&function.shape)) {
    if (!spline->x.empty()) lastKnot = spline->x.back();
  }
  courses_.push_back({coordinate, -ever, ever, lastKnot, FunctionEvaluator(function)});
}

CurveValue PrescribedMotion::at(const Course& course, double t) {
  // behind its last point a spline is straight; that point itself belongs to the curve, and what is
  // given between samples ends there, if rounding of times goes beyond it
  const bool isEnd = std::abs(t - course.lastKnot) < 1e-12 || t >= course.last;
  return course.curve.evaluate(isEnd ? std::nextafter(course.lastKnot, -ever) : t);
}

}  // namespace bio
