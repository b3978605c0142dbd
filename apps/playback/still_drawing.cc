#include "playback/still_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/svg_text.h"
#include "view/colour_map.h"

namespace app {
namespace {

/// Longer side of the drawing.
constexpr double longerSide = 420;

Eigen::Quaterniond uprightFrom(const Eigen::Vector3d& up) {
  return Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitY());
}

struct Stroke {
  std::vector<Eigen::Vector2d> points;  ///< [m]
  double width;                         ///< [m]
  std::string colour;
};

}  // namespace

Eigen::Vector2d Viewpoint::onScreen(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d upright = uprightFrom(up) * point;
  return {isFront ? -upright.z() : upright.x(), upright.y()};
}

Viewpoint viewpointOf(const std::vector<PlayedFrame>& frames, const Eigen::Vector3d& gravity) {
  Viewpoint viewpoint;
  if (gravity.norm() > 0) viewpoint.up = -gravity.normalized();
  const Eigen::Quaterniond upright = uprightFrom(viewpoint.up);
  Eigen::Vector3d travelled = Eigen::Vector3d::Zero();
  const auto add = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    travelled += (upright * (to - from)).cwiseAbs();
  };
  for (std::size_t f = 1; f < frames.size(); ++f) {
    const PlayedFrame &before = frames[f - 1], &now = frames[f];
    for (std::size_t i = 0; i < now.bodies.size(); ++i) {
      // the turn as well: a point 0.2 m from the origin on each axis
      add(before.bodies[i].p, now.bodies[i].p);
      for (int axis = 0; axis < 3; ++axis)
        add(0.2 * before.bodies[i].R.col(axis), 0.2 * now.bodies[i].R.col(axis));
    }
  }
  viewpoint.isFront = travelled.z() > travelled.x();
  return viewpoint;
}

std::string activationColour(double share) {
  if (std::isnan(share)) return "#999999";
  std::string colour = "#";
  for (const double part : bio::view::viridis(share))
    colour += fmt::format("{:02x}", static_cast<int>(std::lround(255 * part)));
  return colour;
}

std::string stillDrawing(const PlayedFrame& frame, const std::vector<bio::view::BodyShape>& shapes,
                         const Viewpoint& viewpoint, double largest,
                         const std::string& description) {
  std::vector<Stroke> strokes;
  for (std::size_t i = 0; i < shapes.size() && i < frame.bodies.size(); ++i) {
    const bio::Placement<double>& X = frame.bodies[i];
    const auto seen = [&](const Eigen::Vector3d& p) { return viewpoint.onScreen(X.R * p + X.p); };
    for (const bio::view::TaperedBone& bone : shapes[i].bones)
      strokes.push_back({{seen(bone.from), seen(bone.to)}, 2 * bone.shaftRadius, "#c9bfa5"});
    for (const auto& [centre, radius] : shapes[i].joints)
      strokes.push_back({{seen(centre), seen(centre)}, 2 * radius, "#c9bfa5"});
  }
  // what is grey behind what is not, and thinner
  for (const bool isGrey : {true, false}) {
    for (const PlayedLine& line : frame.lines) {
      if (line.points.empty() || std::isnan(line.activation) != isGrey) continue;
      Stroke& stroke = strokes.emplace_back();
      stroke.width = (isGrey ? 0.8 : 1.6) * line.radius;
      stroke.colour = activationColour(line.activation / largest);
      for (const Eigen::Vector3d& point : line.points)
        stroke.points.push_back(viewpoint.onScreen(point));
    }
  }
  Eigen::AlignedBox2d box;
  for (const Stroke& stroke : strokes) {
    for (const Eigen::Vector2d& point : stroke.points) {
      box.extend(Eigen::Vector2d(point.array() - stroke.width));
      box.extend(Eigen::Vector2d(point.array() + stroke.width));
    }
  }
  if (box.isEmpty()) box.extend(Eigen::Vector2d::Zero());
  const double scale = longerSide / std::max(1e-6, box.sizes().maxCoeff());
  std::string text = fmt::format(
      "<svg class=\"still\" role=\"img\" aria-label=\"{}\" viewBox=\"0 0 {:.0f} {:.0f}\">\n",
      svgText(description), std::ceil(scale * box.sizes().x()), std::ceil(scale * box.sizes().y()));
  for (const Stroke& stroke : strokes) {
    text += fmt::format(
        "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{:.1f}\" "
        "stroke-linecap=\"round\" stroke-linejoin=\"round\" points=\"",
        stroke.colour, scale * stroke.width);
    for (const Eigen::Vector2d& point : stroke.points)
      text += fmt::format("{:.1f},{:.1f} ", scale * (point.x() - box.min().x()),
                          scale * (box.max().y() - point.y()));
    text.back() = '"';
    text += "/>\n";
  }
  return text + "</svg>\n";
}

}  // namespace app
