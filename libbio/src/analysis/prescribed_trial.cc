#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "bio/analysis/replay.h"
#include "bio/observation/smoothed_motion.h"

namespace bio {
namespace {

std::vector<double> listOf(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

constexpr double usualCutoff = 6;         ///< of human movement [Hz]
constexpr double roughAcceleration = 10;  ///< [rad/s²]: 1 N·m at 0.1 kg m²

/// Root mean square of the acceleration of a course.
double meanAcceleration(const MeasuredChannel& course) {
  PrescribedMotion motion;
  motion.add(0, listOf(course.times), listOf(course.values));
  double sum = 0;
  Eigen::Matrix<double, 1, 1> q, qDot, acceleration;
  for (const double t : course.times) {
    motion.place(t, q, qDot, acceleration);
    sum += acceleration[0] * acceleration[0];
  }
  return std::sqrt(sum / static_cast<double>(course.times.size()));
}

MeasuredChannel smoothedCourse(const MeasuredChannel& course, double cutoff) {
  const double duration = course.times[course.times.size() - 1] - course.times[0];
  const double spacing =
      std::min(0.1 / cutoff, duration / static_cast<double>(course.times.size() - 1));
  const SmoothedMotion smooth = smoothed(listOf(course.times), course.values, cutoff, spacing);
  MeasuredChannel result{course.what, {}, smooth.values};
  result.times = Eigen::Map<const Eigen::VectorXd>(smooth.times.data(),
                                                   static_cast<Eigen::Index>(smooth.times.size()));
  return result;
}

}  // namespace

PrescribedMotion prescribedMotionOf(const Trial& trial, const MusculoskeletalSystem& system) {
  PrescribedMotion motion;
  for (const int k : system.prescribed()) {
    const std::string& name = system.skeleton().coordinates()[static_cast<std::size_t>(k)].name;
    const auto at =
        std::find_if(trial.prescribed.begin(), trial.prescribed.end(),
                     [&](const MeasuredChannel& course) { return course.what.object == name; });
    if (const Function* own = system.courseOf(k); own && at == trial.prescribed.end()) {
      motion.add(k, *own);
      continue;
    }
    if (at == trial.prescribed.end()) {
      throw std::invalid_argument(
          fmt::format("{}: no motion of the prescribed coordinate '{}'", trial.file, name));
    }
    motion.add(k, listOf(at->times), listOf(at->values));
  }
  return motion;
}

void smoothPrescribed(Trial& trial, double cutoff) {
  for (MeasuredChannel& course : trial.prescribed) {
    if (course.times.size() >= 4) course = smoothedCourse(course, cutoff);
  }
}

std::vector<std::string> roughnessRemarks(const Trial& trial, const Model& model) {
  std::vector<std::string> remarks;
  for (const MeasuredChannel& course : trial.prescribed) {
    if (course.times.size() < 8 || !findCoordinate(model, course.what.object).isRotation) continue;
    const double raw = meanAcceleration(course);
    const double smooth = meanAcceleration(smoothedCourse(course, usualCutoff));
    if (raw < roughAcceleration || raw < 3 * smooth) continue;
    remarks.push_back(fmt::format(
        "{}: the prescribed '{}' has an acceleration of {:.3g} rad/s² (root mean square), of which "
        "{:.3g} rad/s² is below {} Hz: if the rest is noise of the sensor, smooth it with "
        "--prescribe-cutoff {}",
        trial.file, course.what.object, raw, smooth, usualCutoff, usualCutoff));
  }
  return remarks;
}

}  // namespace bio
