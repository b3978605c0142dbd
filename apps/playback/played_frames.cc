#include "playback/played_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "view/system_shape.h"

namespace app {
namespace {

constexpr double drawnTolerance = 1e-4;  // [m] of lines

/// The rows of a motion alone, for reportMuscles.
bio::Trajectory onlyRows(const bio::Trajectory& motion, const std::vector<std::size_t>& rows) {
  bio::Trajectory part;
  const std::vector<Eigen::Index> columns(rows.begin(), rows.end());
  for (const std::size_t row : rows) part.time.push_back(motion.time[row]);
  part.q = motion.q(Eigen::all, columns);
  part.qDot = motion.qDot(Eigen::all, columns);
  part.activation = motion.activation(Eigen::all, columns);
  part.fibreLength = motion.fibreLength(Eigen::all, columns);
  return part;
}

double distanceFromSegment(const Eigen::Vector3d& point, const Eigen::Vector3d& from,
                           const Eigen::Vector3d& to) {
  const Eigen::Vector3d along = to - from;
  const double square = along.squaredNorm();
  const double share = square > 0 ? std::clamp((point - from).dot(along) / square, 0.0, 1.0) : 0.0;
  return (point - from - share * along).norm();
}

}  // namespace

std::vector<std::size_t> evenRows(const std::vector<double>& times, std::size_t count) {
  std::vector<std::size_t> rows;
  if (times.empty() || count == 0) return rows;
  const double first = times.front(), span = times.back() - first;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.0;
    const double wanted = first + share * span;
    auto at = std::lower_bound(times.begin(), times.end(), wanted);
    if (at == times.end()) --at;
    if (at != times.begin() && wanted - *(at - 1) < *at - wanted) --at;
    const auto row = static_cast<std::size_t>(at - times.begin());
    if (rows.empty() || rows.back() < row) rows.push_back(row);
  }
  if (count > 1 && rows.back() + 1 < times.size()) rows.back() = times.size() - 1;
  return rows;
}

std::vector<Eigen::Vector3d> thinnedLine(const std::vector<Eigen::Vector3d>& line,
                                         double tolerance) {
  if (line.size() < 3) return line;
  std::vector<bool> isKept(line.size(), false);
  isKept.front() = isKept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> parts{{0, line.size() - 1}};
  while (!parts.empty()) {
    const auto [from, to] = parts.back();
    parts.pop_back();
    double farthest = tolerance;
    std::size_t middle = from;
    for (std::size_t k = from + 1; k < to; ++k) {
      const double distance = distanceFromSegment(line[k], line[from], line[to]);
      if (distance <= farthest) continue;
      farthest = distance;
      middle = k;
    }
    if (middle == from) continue;
    isKept[middle] = true;
    parts.emplace_back(from, middle);
    parts.emplace_back(middle, to);
  }
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t k = 0; k < line.size(); ++k)
    if (isKept[k]) kept.push_back(line[k]);
  return kept;
}

FrameMaker::FrameMaker(const bio::Model& model, const bio::MusculoskeletalSystem& system,
                       const std::vector<std::string>& wrapAsCylinder)
    : system_(&system),
      bodies_(bio::view::drawnBodyNames(model)),
      still_(bio::view::stillPaths(model, system, wrapAsCylinder)) {}

std::vector<std::string> FrameMaker::paths() const {
  return bio::view::drawnPathNames(*system_, still_);
}

std::vector<bio::Placement<double>> FrameMaker::bodiesAt(const Eigen::VectorXd& q) const {
  return bio::view::placedPaths(system_->skeleton(), bodies_, {}, q).bodies;
}

/// A path without a taut string in this posture has no line.
std::vector<std::vector<Eigen::Vector3d>> FrameMaker::linesAt(const Eigen::VectorXd& q) const {
  const std::vector<const bio::MusclePath*> paths = bio::view::drawnPaths(*system_, still_);
  const auto placed = [&](const std::vector<const bio::MusclePath*>& some) {
    return bio::view::placedPaths(system_->skeleton(), {}, some, q).lines;
  };
  try {
    return placed(paths);
  } catch (const std::domain_error&) {
  }
  std::vector<std::vector<Eigen::Vector3d>> lines;
  for (const bio::MusclePath* path : paths) {
    try {
      lines.push_back(placed({path}).front());
    } catch (const std::domain_error&) {
      lines.emplace_back();
    }
  }
  return lines;
}

std::vector<PlayedFrame> FrameMaker::frames(const bio::Trajectory& motion,
                                            const std::vector<std::size_t>& rows) const {
  const bio::Trajectory part = onlyRows(motion, rows);
  const bio::MuscleReport report = bio::reportMuscles(*system_, part);
  std::vector<PlayedFrame> frames;
  for (std::size_t f = 0; f < rows.size(); ++f) {
    const auto column = static_cast<Eigen::Index>(f);
    PlayedFrame& frame = frames.emplace_back();
    frame.time = part.time[f];
    frame.bodies = bodiesAt(part.q.col(column));
    for (const std::vector<Eigen::Vector3d>& line : linesAt(part.q.col(column))) {
      const std::size_t i = frame.lines.size();
      const auto k = static_cast<Eigen::Index>(i);
      const bool isSimulated = i < system_->numMuscles();
      frame.lines.push_back(
          {thinnedLine(line, drawnTolerance),
           bio::view::tubeRadius(isSimulated ? report.tendonForce(k, column) : 0),
           isSimulated ? part.activation(k, column) : std::numeric_limits<double>::quiet_NaN()});
    }
  }
  return frames;
}

}  // namespace app
