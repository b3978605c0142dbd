#include "discovery/first_part.h"

#include <algorithm>

namespace bio::discover {
namespace {

using Eigen::Index;

constexpr double shortestPart = 1;  // [s]

Index numUntil(const Eigen::VectorXd& times, double end) {
  return std::upper_bound(times.begin(), times.end(), end) - times.begin();
}

/// Leaves out what begins later.
template <typename Series>
void cut(std::vector<Series>& all, double end) {
  std::erase_if(all, [&](const Series& series) { return numUntil(series.times, end) == 0; });
  for (Series& series : all) {
    const Index n = numUntil(series.times, end);
    series.times.conservativeResize(n);
    series.values.conservativeResize(n);
  }
}

}  // namespace

Trial partUntil(const Trial& trial, double end) {
  const Index rows = numUntil(trial.times, end);
  Trial part = trial;
  part.sha256.clear();  // it is not what is in the file
  part.times.conservativeResize(rows);
  part.excitations.conservativeResize(rows, Eigen::NoChange);
  for (AppliedForce& force : part.applied) {
    force.values.conservativeResize(rows);
    if (force.control.size() > 0) force.control.conservativeResize(rows);
  }
  cut(part.measured, end);
  return part;
}

std::optional<Trial> firstPart(const Trial& trial, const std::string& coordinate, double position,
                               bool above) {
  const MeasuredChannel* motion = trial.measurementOf(ofCoordinate(coordinate));
  if (!motion) return trial;
  const auto isBeyond = [&](double value) { return above ? value > position : value < position; };
  const auto passed = std::find_if(motion->values.begin(), motion->values.end(), isBeyond);
  if (passed == motion->values.end()) return trial;
  const Index first = passed - motion->values.begin();
  if (first == 0 || motion->times[first - 1] - trial.times[0] < shortestPart) return {};
  return partUntil(trial, motion->times[first - 1]);
}

}  // namespace bio::discover
