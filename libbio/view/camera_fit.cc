#include "view/camera_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace bio::view {
namespace {

/// Extremes of one picture coordinate: x − c ≤ high·(D − z) and x − c ≥ low·(D − z) for all points.
struct Edges {
  double low, high;
  double most = -std::numeric_limits<double>::infinity();  ///< max(x + high·z)
  double least = std::numeric_limits<double>::infinity();  ///< min(x + low·z)

  void add(double x, double z) {
    most = std::max(most, x + high * z);
    least = std::min(least, x + low * z);
  }
  double distance() const { return (most - least) / (high - low); }
  double centre(double D) const { return 0.5 * (most - high * D + least - low * D); }
};

}  // namespace

CameraPlace fitCamera(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& toCamera,
                      const Eigen::Vector3d& up, double viewAngle, double aspect,
                      const PictureFrame& frame) {
  const Eigen::Vector3d z = toCamera.normalized();
  const Eigen::Vector3d across = up.cross(z);
  if (points.empty() || !(across.norm() > 1e-9 * up.norm())) {
    throw std::invalid_argument(
        "camera: must have points to show and a direction that is not vertical");
  }
  const Eigen::Vector3d x = across.normalized(), y = z.cross(x);
  const double h = std::tan(viewAngle / 2), w = h * aspect;
  Edges horizontal{frame.left * w, frame.right * w}, vertical{frame.bottom * h, frame.top * h};
  double nearest = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : points) {
    horizontal.add(x.dot(point), z.dot(point));
    vertical.add(y.dot(point), z.dot(point));
    nearest = std::max(nearest, z.dot(point));
  }
  // A single point would put the camera inside the scene.
  const double D = std::max({horizontal.distance(), vertical.distance(), nearest + 0.01});
  return {horizontal.centre(D) * x + vertical.centre(D) * y + D * z, z, y};
}

}  // namespace bio::view
