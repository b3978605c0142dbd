#include "bio/review/trial_review.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "bio/tables/interpolated_series.h"
#include "model/plausible.h"

namespace bio {
namespace {

Eigen::VectorXd steps(const Eigen::VectorXd& values) {
  return values.tail(values.size() - 1) - values.head(values.size() - 1);
}

/// Rows further apart do not show what the excitation does [s]. A muscle's activation follows it
/// within 10 ms (rising) to 70 ms (falling): over a longer interval it depends on what lies between
/// the rows. With every 20th row (0.1 s) of the shipped trials the simulated angle changes by less
/// than 0.5°, with every 100th (0.5 s) by up to 27°.
constexpr double longestStraightLine = 0.1;

/// The longest interval in which an excitation changes [s]; 0 if all are constant.
double longestChange(const Trial& trial, const Eigen::VectorXd& intervals) {
  double longest = 0;
  for (Eigen::Index k = 0; k < intervals.size(); ++k) {
    const bool changes = trial.excitations.row(k) != trial.excitations.row(k + 1);
    if (changes) longest = std::max(longest, intervals[k]);
  }
  return longest;
}

void reviewSampling(const Trial& trial, std::vector<Remark>& remarks) {
  const Eigen::VectorXd intervals = steps(trial.times);
  std::vector<double> sorted(intervals.begin(), intervals.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double median = *middle;
  const double least = intervals.minCoeff(), largest = intervals.maxCoeff();
  if (largest > 1.01 * median || least < 0.99 * median) {
    remarks.push_back({"time", fmt::format("intervals = {:.4g} to {:.4g} s, usually equal "
                                           "(the median is {:.4g} s)",
                                           least, largest, median)});
  }
  if (median >= millisecondsBeyond && trial.duration() >= millisecondsFrom) {
    remarks.push_back(
        {"time", fmt::format("rows are {:.4g} s apart, usually below 0.1 s: milliseconds?", median),
         Weight::warning});
    return;
  }
  const double line = longestChange(trial, intervals);
  if (line > longestStraightLine * (1 + 1e-6)) {
    remarks.push_back(
        {"time",
         fmt::format("rows are up to {:.4g} s apart: the excitation between them is taken as a "
                     "straight line; record it, or resample the recording, at 20 Hz or more",
                     line),
         Weight::warning});
  } else if (median > 0.1) {
    remarks.push_back(
        {"time", fmt::format("rows are {:.4g} s apart, usually below 0.1 s", median)});
  }
}

void reviewExcitation(const std::string& muscle, const Eigen::VectorXd& excitation,
                      std::vector<Remark>& remarks) {
  const std::string subject = fmt::format("excitation of '{}'", muscle);
  if (excitation.maxCoeff() == 0) remarks.push_back({subject, "is 0 throughout"});
  if (excitation.minCoeff() == 1) remarks.push_back({subject, "is 1 throughout"});
  const double jump = steps(excitation).cwiseAbs().maxCoeff();
  if (jump > 0.5) {
    remarks.push_back(
        {subject, fmt::format("jumps by {:.3g} between rows, usually below 0.5", jump)});
  }
}

constexpr double strongPush = 50;  // [N·m] or [N]

void reviewApplied(const AppliedForce& applied, bool isRotation, std::vector<Remark>& remarks) {
  const std::string subject =
      fmt::format("{} on '{}'", isRotation ? "torque" : "force", applied.coordinate);
  const char* unit = isRotation ? "N·m" : "N";
  const double largest = applied.values.cwiseAbs().maxCoeff();
  if (largest > strongPush) {
    remarks.push_back({subject, fmt::format("reaches {:.4g} {}, usually below {} {}", largest, unit,
                                            strongPush, unit)});
  }
  if (largest == 0) remarks.push_back({subject, "is 0 throughout"});
  const double jump = steps(applied.values).cwiseAbs().maxCoeff();
  if (jump > strongPush / 10) {
    remarks.push_back({subject, fmt::format("jumps by {:.3g} {} between rows, usually below {} {}",
                                            jump, unit, strongPush / 10, unit)});
  }
}

void reviewMotion(const MeasuredChannel& motion, const Coordinate& coordinate, double start,
                  std::vector<Remark>& remarks) {
  const std::string subject = fmt::format("measured '{}'", motion.what.object);
  const double least = motion.values.minCoeff(), largest = motion.values.maxCoeff();
  const double encompassing = std::max(std::abs(least), std::abs(largest));
  const char* unit = coordinate.isRotation ? "rad" : "m";
  const bool isOutside = least < coordinate.rangeMin - 1e-3 || largest > coordinate.rangeMax + 1e-3;
  if (coordinate.isRotation && isOutside && encompassing > certainlyDegreesBeyond) {
    remarks.push_back(
        {subject,
         fmt::format("values = {:.4g} to {:.4g} rad, must be within ±2π or the model's range: "
                     "degrees stand in a column '{}_deg', or under inDegrees=yes",
                     least, largest, motion.what.object),
         Weight::error});
    return;
  }
  if (coordinate.isRotation && encompassing > degreesBeyond) {
    remarks.push_back(
        {subject,
         fmt::format("values = {:.4g} to {:.4g} rad, usually within ±4π: degrees?", least, largest),
         Weight::warning});
  } else if (isOutside) {
    remarks.push_back(
        {subject, fmt::format("values = {:.4g} to {:.4g} {}, outside the model's range {} to {}",
                              least, largest, unit, coordinate.rangeMin, coordinate.rangeMax)});
  }
  if (coordinate.isRotation && motion.values.size() > 1) {
    const double jump = steps(motion.values).cwiseAbs().maxCoeff();
    if (jump > 0.5 && encompassing <= degreesBeyond) {
      remarks.push_back({subject, fmt::format("jumps by {:.3g} rad between measurements, usually "
                                              "below 0.5 rad",
                                              jump)});
    }
  }
  if (motion.times(0) - start > 0.1) {
    remarks.push_back(
        {subject, fmt::format("begins {:.3g} s after the excitations", motion.times(0) - start)});
  }
}

/// Remark on interpolated values of a coordinate or another measured channel.
void reviewInterpolation(const std::string& name, const Eigen::VectorXd& times,
                         const Eigen::VectorXd& values, std::vector<Remark>& remarks) {
  const int factor = interpolationFactor(times, values);
  if (factor == 1) return;
  remarks.push_back(
      {fmt::format("measured '{}'", name),
       fmt::format("1 value in {} was recorded, the others lie on straight lines between: noise is "
                   "estimated too small from them, and intervals become too narrow; give the "
                   "recorded values only, with empty cells (or NaN) between",
                   factor),
       Weight::warning});
}

}  // namespace

std::vector<Remark> reviewTrial(const Trial& trial, const Model& model) {
  std::vector<Remark> remarks;
  reviewSampling(trial, remarks);
  for (std::size_t m = 0; m < trial.muscles.size(); ++m) {
    reviewExcitation(trial.muscles[m], trial.excitations.col(static_cast<Eigen::Index>(m)),
                     remarks);
  }
  for (const AppliedForce& applied : trial.applied) {
    reviewApplied(applied, findCoordinate(model, applied.coordinate).isRotation, remarks);
  }
  for (const MeasuredChannel& channel : trial.measured) {
    if (channel.what.isCoordinate())
      reviewMotion(channel, findCoordinate(model, channel.what.object), trial.times(0), remarks);
    reviewInterpolation(nameOf(channel.what), channel.times, channel.values, remarks);
  }
  return remarks;
}

std::string whyNotUsable(const MeasuredChannel& motion, Eigen::Index fewest) {
  const auto count = motion.values.size();
  if (count < fewest) {
    return fmt::format("'{}' has {} measured value{}, must have at least {}", nameOf(motion.what),
                       count, count == 1 ? "" : "s", fewest);
  }
  const double low = motion.values.minCoeff(), high = motion.values.maxCoeff();
  if (low == high) {
    return fmt::format("'{}' has the same value in all {} samples, must change",
                       nameOf(motion.what), count);
  }
  const bool areTwo = (motion.values.array() == low || motion.values.array() == high).all();
  if (areTwo && count > 2) {
    return fmt::format(
        "'{}' has only two different values in {} samples (resolution of its sensor), must have "
        "more",
        nameOf(motion.what), count);
  }
  return "";
}

void requireUsable(const std::string& file, const MeasuredChannel& motion, Eigen::Index fewest) {
  const std::string why = whyNotUsable(motion, fewest);
  if (!why.empty()) throw std::invalid_argument(fmt::format("{}: measured {}", file, why));
}

}  // namespace bio
