#pragma once

#include <Eigen/Dense>
#include <vector>

#include "bio/muscle/curves/curves.h"

namespace bio {

/// Coordinates whose motion is given as a function of time, not simulated: a measured shoulder
/// while the elbow is simulated, or a joint that a dynamometer holds or turns.
///
/// A course goes through its samples as a C² cubic spline (curves.h), so that speed and
/// acceleration are continuous; a single sample is a constant. Or it is a function of time, of
/// which a model file holds one (Coordinate::prescribedFunction).
class PrescribedMotion {
 public:
  /// No prescribed coordinate.
  PrescribedMotion() = default;

  /// @param coordinate  free index, not yet prescribed
  /// @param times       [s] strictly rising, at least one
  /// @param values      as many [rad] or [m], finite
  /// @throws std::invalid_argument sizes that differ, times not rising, a value that is not finite
  void add(int coordinate, const std::vector<double>& times, const std::vector<double>& values);

  /// A function of time [s], given for all times; with its own continuity: at the corners of
  /// straight lines the speed jumps.
  /// @throws std::invalid_argument what FunctionEvaluator throws, a coordinate prescribed twice
  void add(int coordinate, const Function& function);

  bool empty() const { return courses_.empty(); }

  struct Course {
    int coordinate;
    double first, last;  ///< times between which it is given; a function: everywhere [s]
    double lastKnot;     ///< of a curve of pieces; else infinite [s]
    FunctionEvaluator curve;
  };
  const std::vector<Course>& courses() const { return courses_; }

  /// Sets the values at time t, those of the other coordinates stay.
  template <class Vector>
  void place(double t, Vector& q) const {
    for (const Course& course : courses_) q[course.coordinate] = at(course, t).value;
  }
  /// Sets the speeds as well.
  template <class Vector>
  void place(double t, Vector& q, Vector& qDot) const {
    for (const Course& course : courses_) {
      const CurveValue now = at(course, t);
      q[course.coordinate] = now.value;
      qDot[course.coordinate] = now.slope;
    }
  }
  /// Sets the accelerations as well.
  template <class Vector>
  void place(double t, Vector& q, Vector& qDot, Vector& acceleration) const {
    for (const Course& course : courses_) {
      const CurveValue now = at(course, t);
      q[course.coordinate] = now.value;
      qDot[course.coordinate] = now.slope;
      acceleration[course.coordinate] = now.curvature;
    }
  }

 private:
  static CurveValue at(const Course& course, double t);
  void requireNew(int coordinate) const;

  std::vector<Course> courses_;
};

}  // namespace bio
