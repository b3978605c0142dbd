#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "playback/played_frames.h"
#include "view/system_shape.h"

namespace app {

/// From where a motion is seen first: along −z (side) or along −x (front), where `up` is upwards.
struct Viewpoint {
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();  ///< in ground
  bool isFront = false;
  /// To the right and upwards on the screen [m].
  Eigen::Vector2d onScreen(const Eigen::Vector3d& point) const;
};

/// The viewpoint from which a motion is widest.
/// @param gravity  [m/s²]; none: y is upwards
Viewpoint viewpointOf(const std::vector<PlayedFrame>& frames, const Eigen::Vector3d& gravity);

/// A colour of the scale of activations, "#rrggbb".
/// @param share  of the last colour, 0 to 1; NaN: grey
std::string activationColour(double share);

/// One frame as an <svg>: what is seen where nothing moves, on paper and without WebGL.
/// @param shapes       as bodyShapes() gives them, in the order of the frame's bodies
/// @param largest      activation that has the last colour
/// @param description  for readers who do not see it
std::string stillDrawing(const PlayedFrame& frame, const std::vector<bio::view::BodyShape>& shapes,
                         const Viewpoint& viewpoint, double largest,
                         const std::string& description);

}  // namespace app
