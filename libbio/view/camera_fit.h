#pragma once

#include <Eigen/Dense>
#include <vector>

namespace bio::view {

/// Where a camera stands; it looks along −toCamera with `up` upwards.
struct CameraPlace {
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d toCamera;  ///< unit, from the scene to the camera
  Eigen::Vector3d up;        ///< unit, at right angles to it
};

/// The part of the picture that the scene may fill, as fractions of half its width and height.
struct PictureFrame {
  double left = -1, right = 1, bottom = -1, top = 1;
};

/// The nearest camera that sees every point inside the frame.
///
/// With x, y, z along right, up and toCamera, a camera at (c_x, c_y, D) shows a point at
/// ((x − c_x)/(D − z)/w, (y − c_y)/(D − z)/h), w and h the tangents of half the angles of view.
/// Each edge of the frame is a linear inequality in (c, D), so that the least D has a closed form.
///
/// @param viewAngle  vertical angle of view [rad], 0 < viewAngle < π
/// @param aspect  width/height > 0
/// @throws std::invalid_argument without points, or if toCamera is vertical and so is up
CameraPlace fitCamera(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& toCamera,
                      const Eigen::Vector3d& up, double viewAngle, double aspect,
                      const PictureFrame& frame);

}  // namespace bio::view
