#include "bio/discovery/drive_law.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "bio/discovery/sensor_law.h"
#include "info/dynamics/linear_table.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// The excess of |x| over a limit, with the sign of x, and its derivatives.
struct Excess {
  double value = 0, inX = 0, inLimit = 0;
};

Excess excessOf(double x, double limit) {
  constexpr double rounded = 0.05;  // half the width of the corner, over the limit
  const double w = rounded * limit;
  const double sign = x < 0 ? -1 : 1;
  const double above = sign * x - limit;
  if (above <= -w) return {};
  if (above >= w) return {sign * above, 1, -sign};
  const double u = (above + w) / (2 * w);
  return {sign * w * u * u, u, -sign * (u * (1 - rounded) + rounded * u * u)};
}

/// A column of rows at times that stand d later, from the first time to the last.
VectorXd delayed(const std::vector<double>& corners, const VectorXd& times, double delay,
                 const VectorXd& rows) {
  VectorXd result(static_cast<Index>(corners.size()));
  for (Index k = 0; k < result.size(); ++k)
    result[k] = info::linearAt(times, corners[static_cast<std::size_t>(k)] - delay).value(rows);
  return result;
}

VectorXd atTimes(const std::vector<double>& wanted, const VectorXd& times, const VectorXd& rows) {
  return delayed(wanted, times, 0, rows);
}

}  // namespace

DrivenCourse drivenCourse(const VectorXd& times, const VectorXd& command, const DriveLaw& law) {
  const Index n = times.size();
  const double first = times[0], last = times[n - 1];
  // behind the lag and the limit, at the rows
  VectorXd slopeBefore = VectorXd::Zero(n);
  for (Index k = 1; k < n; ++k)
    slopeBefore[k] = (command[k] - command[k - 1]) / (times[k] - times[k - 1]);
  const Lagged after =
      lagged({times.begin(), times.end()}, command.transpose(), slopeBefore.transpose(), law.lag);
  VectorXd value = after.value.transpose(), inLag = after.inLag.transpose();
  VectorXd inShare(n), inLimit(n);
  for (Index k = 0; k < n; ++k) {
    const Excess excess = excessOf(value[k], law.limit);
    if (law.share != 0) value[k] -= law.share * excess.value;
    inLag[k] *= law.gain * (1 - law.share * excess.inX);
    inShare[k] = -law.gain * excess.value;
    inLimit[k] = -law.gain * law.share * excess.inLimit;
  }
  DrivenCourse course;
  course.times.push_back(first);
  for (Index k = law.delay > 0 ? 0 : 1; k < n; ++k)
    if (times[k] + law.delay < last) course.times.push_back(times[k] + law.delay);
  course.times.push_back(last);
  const auto later = [&](const VectorXd& rows) {
    return delayed(course.times, times, law.delay, rows);
  };
  course.inGain = later(value);
  course.values = law.gain == 1 ? course.inGain : VectorXd(law.gain * course.inGain);
  course.inLag = later(inLag);
  course.inShare = later(inShare);
  course.inLimit = later(inLimit);
  course.inDelay.resize(static_cast<Index>(course.times.size()) - 1);
  for (Index k = 0; k < course.inDelay.size(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    course.inDelay[k] =
        (course.values[k] - course.values[k + 1]) / (course.times[i + 1] - course.times[i]);
  }
  return course;
}

Trial withDrives(Trial trial, const DriveLaws& laws) {
  std::set<double> corners(trial.times.begin(), trial.times.end());
  const auto insert = [&](double t) {
    constexpr double same = 1e-9;  // [s]
    const auto next = corners.lower_bound(t - same);
    if (next == corners.end() || *next > t + same) corners.insert(t);
  };
  std::vector<std::optional<DrivenCourse>> courses;
  for (const AppliedForce& applied : trial.applied) {
    const auto law = laws.find(applied.coordinate);
    auto& course = courses.emplace_back();
    if (law == laws.end() || law->second.isTrue()) continue;
    course = drivenCourse(trial.times, applied.values, law->second);
    for (const double t : course->times) insert(t);
    trial.sha256.clear();  // it is not what is in the file
  }
  const VectorXd times = trial.times;
  const std::vector<double> rows(corners.begin(), corners.end());
  for (std::size_t i = 0; i < courses.size(); ++i) {
    AppliedForce& applied = trial.applied[i];
    if (courses[i]) {
      const auto& at = courses[i]->times;
      applied.values = atTimes(rows, VectorXd::Map(at.data(), std::ssize(at)), courses[i]->values);
      if (applied.optimalForce != 0) applied.control = applied.values / applied.optimalForce;
    } else {
      applied.values = atTimes(rows, times, applied.values);
    }
    if (applied.control.size() == times.size() && (!courses[i] || applied.optimalForce == 0))
      applied.control = atTimes(rows, times, applied.control);
  }
  Eigen::MatrixXd excitations(std::ssize(rows), trial.excitations.cols());
  for (Index m = 0; m < excitations.cols(); ++m)
    excitations.col(m) = atTimes(rows, times, trial.excitations.col(m));
  trial.excitations = std::move(excitations);
  trial.times = VectorXd::Map(rows.data(), std::ssize(rows));
  return trial;
}

std::vector<DriveCommand> commandsOf(const std::vector<Trial>& trials,
                                     const std::vector<std::string>& names) {
  std::vector<DriveCommand> commands;
  for (const std::string& name : names) {
    DriveCommand command{name, 0, {}};
    bool isDriven = false, isOfActuators = true;
    for (const Trial& trial : trials) {
      for (const AppliedForce& applied : trial.applied) {
        if (applied.coordinate != name || applied.values.size() == 0) continue;
        if (!(applied.values.maxCoeff() > applied.values.minCoeff())) continue;
        isDriven = true;
        command.largest = std::max(command.largest, applied.values.cwiseAbs().maxCoeff());
        isOfActuators = isOfActuators && !applied.actuator.empty();
        auto& actuators = command.actuators;
        if (std::find(actuators.begin(), actuators.end(), applied.actuator) == actuators.end())
          actuators.push_back(applied.actuator);
      }
    }
    if (!isOfActuators) command.actuators.clear();
    if (isDriven) commands.push_back(std::move(command));
  }
  return commands;
}

std::vector<DriveCommand> possibleCommands(const std::vector<std::string>& names) {
  std::vector<DriveCommand> commands;
  for (const std::string& name : names) commands.push_back({name, 1, {}});
  return commands;
}

DriveLaw driveLaw(const Drive& drive, const VectorXd& values) {
  DriveLaw law;
  const auto set = [&](double& number, const std::optional<std::size_t>& quantity) {
    if (quantity) number = values[static_cast<Index>(*quantity)];
  };
  set(law.gain, drive.gain);
  set(law.delay, drive.delay);
  set(law.lag, drive.lag);
  set(law.share, drive.share);
  set(law.limit, drive.limit);
  return law;
}

}  // namespace bio::discover
