#include "view/camera_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "view/colour_map.h"

namespace {

using namespace bio::view;
using Eigen::Vector3d;

constexpr double angle = 0.4, aspect = 4.0 / 3;
const PictureFrame frame = {-0.9, 0.6, -0.7, 0.8};

/// Where a point appears, in the units of PictureFrame, by the definition of a perspective camera.
Eigen::Vector2d seen(const CameraPlace& camera, const Vector3d& point) {
  const Vector3d d = point - camera.position;
  const double depth = -camera.toCamera.dot(d);
  const double h = std::tan(angle / 2);
  return {camera.up.cross(camera.toCamera).dot(d) / depth / (h * aspect),
          camera.up.dot(d) / depth / h};
}

TEST(FitCamera, FillsTheFrameAndCutsNothingOff) {
  const std::vector<Vector3d> points = {
      {0, 0, 0}, {0.3, -0.2, 0.1}, {-0.1, -0.5, 0.3}, {0.05, 0.2, -0.2}, {0.2, 0.1, 0.25}};
  for (const Vector3d& direction : {Vector3d(0, 0, 1), Vector3d(1, 0, 0), Vector3d(1, 0.8, 1)}) {
    const CameraPlace camera =
        fitCamera(points, direction, Vector3d::UnitY(), angle, aspect, frame);
    EXPECT_NEAR(camera.up.dot(camera.toCamera), 0, 1e-12);
    Eigen::Vector2d low(9, 9), high(-9, -9);
    for (const Vector3d& point : points) {
      low = low.cwiseMin(seen(camera, point));
      high = high.cwiseMax(seen(camera, point));
    }
    EXPECT_GE(low.x(), frame.left - 1e-9);
    EXPECT_LE(high.x(), frame.right + 1e-9);
    EXPECT_GE(low.y(), frame.bottom - 1e-9);
    EXPECT_LE(high.y(), frame.top + 1e-9);
    const double wide = (high.x() - low.x()) / 1.5, tall = (high.y() - low.y()) / 1.5;
    EXPECT_NEAR(std::max(wide, tall), 1, 1e-6) << "a nearer camera would do";
  }
}

TEST(FitCamera, RefusesNothingToSeeAndALookAlongUp) {
  EXPECT_THROW(fitCamera({}, {0, 0, 1}, {0, 1, 0}, angle, aspect, frame), std::invalid_argument);
  EXPECT_THROW(fitCamera({{0, 0, 0}}, {0, 1, 0}, {0, 1, 0}, angle, aspect, frame),
               std::invalid_argument);
}

TEST(Viridis, LightnessRisesEvenly) {
  double last = lightness(viridis(0));
  EXPECT_NEAR(last, 14, 2);
  for (int i = 1; i <= 20; ++i) {
    const double next = lightness(viridis(i / 20.0));
    EXPECT_NEAR(next - last, 3.85, 1.5) << i;  // (91 − 14)/20
    last = next;
  }
  EXPECT_NEAR(last, 91, 2);
  EXPECT_EQ(viridis(-1), viridis(0));
  EXPECT_EQ(viridis(2), viridis(1));
}

}  // namespace
