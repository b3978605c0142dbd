#include "discovery/first_part.h"

#include <algorithm>

namespace bio::discover {
namespace {

using Eigen::Index;

constexpr double shortestPart = 1;  // [s]

/// What of a series was measured until `end`.
template <typename Series>
void cut(Series& series, double end) {
  Index n = 0;
  while (n < series.times.size() && series.times[n] <= end) ++n;
  // a constant has one sample, whatever its time
  if (n == 0 || series.times.size() == 1) return;
  series.times.conservativeResize(n);
  series.values.conservativeResize(n);
}

}  // namespace

std::optional<Trial> firstPart(const Trial& trial, const std::string& coordinate, double position,
                               bool above) {
  const auto motion =
      std::find_if(trial.measured.begin(), trial.measured.end(),
                   [&](const MeasuredMotion& one) { return one.coordinate == coordinate; });
  if (motion == trial.measured.end()) return trial;
  double end = trial.times[trial.times.size() - 1];
  for (Index i = 0; i < motion->values.size(); ++i) {
    if (above ? motion->values[i] <= position : motion->values[i] >= position) continue;
    if (i == 0) return {};
    end = motion->times[i - 1];
    break;
  }
  if (end == trial.times[trial.times.size() - 1]) return trial;
  if (end - trial.times[0] < shortestPart) return {};
  Trial part = trial;
  const Index rows =
      std::upper_bound(trial.times.begin(), trial.times.end(), end) - trial.times.begin();
  part.sha256.clear();  // it is not what is in the file
  part.times.conservativeResize(rows);
  part.excitations = trial.excitations.topRows(rows).eval();
  for (AppliedForce& one : part.applied) {
    one.values.conservativeResize(rows);
    if (one.control.size() > 0) one.control.conservativeResize(rows);
  }
  for (auto* series : {&part.measured, &part.prescribed})
    for (MeasuredMotion& one : *series) cut(one, end);
  for (MeasuredChannel& one : part.channels) cut(one, end);
  return part;
}

}  // namespace bio::discover
