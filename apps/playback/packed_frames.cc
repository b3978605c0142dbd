#include "playback/packed_frames.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "output/text.h"

namespace app {
namespace {

constexpr double largestCode = 32767;

/// Writes numbers about a centre.
class Packer {
 public:
  explicit Packer(const Eigen::AlignedBox3d& box)
      : centre(box.isEmpty() ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(box.center())),
        unit(box.isEmpty() ? 1 : std::max(1e-9, 0.5 * box.sizes().maxCoeff() / largestCode)) {}

  void add(double value) {
    const double whole =
        std::isfinite(value) ? std::clamp(std::round(value), -largestCode, largestCode) : 0;
    const auto bits = static_cast<std::uint16_t>(static_cast<std::int16_t>(whole));
    bytes.push_back(static_cast<char>(bits & 0xff));
    bytes.push_back(static_cast<char>(bits >> 8));
  }

  void addPoint(const Eigen::Vector3d& point) {
    for (int axis = 0; axis < 3; ++axis) add((point[axis] - centre[axis]) / unit);
  }

  void addBody(const bio::Placement<double>& X) {
    addPoint(X.p);
    const Eigen::Quaterniond turn(X.R);
    for (const double part : {turn.x(), turn.y(), turn.z(), turn.w()}) add(largestCode * part);
  }

  void addLine(const PlayedLine& line) {
    add(static_cast<double>(line.points.size()));
    add(line.radius / 1e-5);
    add(std::isnan(line.activation) ? -1 : 1e4 * std::max(line.activation, 0.0));
    for (const Eigen::Vector3d& point : line.points) addPoint(point);
  }

  const Eigen::Vector3d centre;
  const double unit;
  std::string bytes;
};

}  // namespace

nlohmann::ordered_json packedFrames(const std::vector<PlayedFrame>& frames) {
  std::size_t bodies = 0, lines = 0;
  for (const PlayedFrame& frame : frames) {
    bodies = std::max(bodies, frame.bodies.size());
    lines = std::max(lines, frame.lines.size());
  }
  Eigen::AlignedBox3d box;
  for (const PlayedFrame& frame : frames) {
    const bool isKnown = !frame.bodies.empty();
    if ((isKnown && frame.bodies.size() != bodies) || frame.lines.size() != lines)
      throw std::invalid_argument("frames of a motion must have as many bodies and lines");
    for (const bio::Placement<double>& body : frame.bodies) box.extend(body.p);
    for (const PlayedLine& line : frame.lines)
      for (const Eigen::Vector3d& point : line.points) box.extend(point);
  }
  Packer packer(box);
  nlohmann::ordered_json times = nlohmann::ordered_json::array();
  for (const PlayedFrame& frame : frames) {
    times.push_back(numberIn(cellText(frame.time, 8)));
    for (const bio::Placement<double>& body : frame.bodies) packer.addBody(body);
    if (frame.bodies.empty())
      for (std::size_t i = 0; i < 7 * bodies; ++i) packer.add(0);
    for (const PlayedLine& line : frame.lines) packer.addLine(line);
  }
  return {{"times", times},
          {"lines", lines},
          {"centre", {packer.centre.x(), packer.centre.y(), packer.centre.z()}},
          {"unit", packer.unit},
          {"data", base64(packer.bytes)}};
}

}  // namespace app
