#include "view/system_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "view/colour_map.h"
#include "view/virtual_display.h"

namespace {

using namespace bio::view;
using Eigen::Vector3d;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// One upright muscle of 0.3 m in the middle of a picture, seen from z.
class Scene : public ::testing::Test {
 protected:
  static constexpr int width = 320, height = 240;

  SystemPoser::Posture posture(double radius, double x = 0) const {
    SystemPoser::Posture posture;
    posture.bodies["ground"] = {};
    posture.muscles.push_back({{{x, -0.15, 0}, {x, 0.15, 0}}, radius});
    return posture;
  }

  Image draw(const SystemScene::Moment& moment, std::vector<BodyShape> bodies = {}) {
    SceneOptions options;
    options.width = width;
    options.height = height;
    options.floor = -0.15;
    SystemScene scene(bodies, {}, options);
    scene.look({{0, 0, 1}, {0, 0, 1}, {0, 1, 0}});
    return scene.draw(moment);
  }

  Image drawMuscle(double activation, double radius = 0.01) {
    const SystemPoser::Posture one = posture(radius);
    return draw({0, &one, {activation}, nullptr});
  }

  static Colour at(const Image& image, int x, int y) {
    const auto first = 3 * static_cast<std::size_t>(y * image.width + x);
    return {image.rgb[first] / 255.0, image.rgb[first + 1] / 255.0, image.rgb[first + 2] / 255.0};
  }
  static Colour middle(const Image& image) { return at(image, width / 2, height / 2); }

  /// The angle between two colours as directions: shading changes their length alone.
  static double hueDifference(const Colour& a, const Colour& b) {
    const Vector3d u(a[0], a[1], a[2]), v(b[0], b[1], b[2]);
    return std::acos(std::min(1.0, u.dot(v) / (u.norm() * v.norm())));
  }

  /// Pixels of the middle row that differ from the background beside the muscle.
  static int thickness(const Image& image) {
    int count = 0;
    const Colour empty = at(image, width / 4, height / 2);
    for (int x = width / 4; x < 3 * width / 4; ++x) {
      const Colour here = at(image, x, height / 2);
      if (std::abs(here[0] - empty[0]) + std::abs(here[2] - empty[2]) > 0.2) ++count;
    }
    return count;
  }

  VirtualDisplay display_;
};

TEST_F(Scene, AMusclesColourIsItsActivation) {
  for (const double activation : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Colour seen = middle(drawMuscle(activation));
    EXPECT_LT(hueDifference(seen, viridis(activation)), 0.1) << activation;
    EXPECT_GT(hueDifference(seen, viridis(activation < 0.5 ? 1 : 0)), 0.3) << activation;
  }
  const Colour grey = middle(drawMuscle(unknown));
  EXPECT_LT(hueDifference(grey, {1, 1, 1}), 0.02);
}

TEST_F(Scene, AMusclesWidthIsTwiceItsRadius) {
  // Half the picture's height is tan(cameraViewAngle/2) metres at the distance of 1 m.
  const double pixel = 2 * std::tan(cameraViewAngle / 2) / height;
  for (const double radius : {0.005, 0.01, 0.02}) {
    EXPECT_NEAR(thickness(drawMuscle(0, radius)), 2 * radius / pixel, 2) << radius;
  }
}

TEST_F(Scene, AGhostIsOrangeAndLeavesTheArmAsItIs) {
  const SystemPoser::Posture one = posture(0.01), other = posture(0.01, 0.05);
  const Image alone = draw({0, &one, {0.5}, nullptr});
  const Image both = draw({0, &one, {0.5}, &other});
  EXPECT_EQ(middle(alone), middle(both));
  const double pixel = 2 * std::tan(cameraViewAngle / 2) / height;
  const int x = width / 2 + static_cast<int>(0.05 / pixel);
  EXPECT_NE(at(alone, x, height / 2), at(both, x, height / 2));
  const Colour ghost = at(both, x, height / 2);
  EXPECT_GT(ghost[0], ghost[1] + 0.05);
  EXPECT_GT(ghost[1], ghost[2]);
}

// The first row of an image is the upper one: the ground lies below.
TEST_F(Scene, TheGroundIsBelowAndTheTimeIsWrittenInTheLowerLeftCorner) {
  const SystemPoser::Posture one = posture(0.01);
  const Image before = draw({0, &one, {0.5}, nullptr}), after = draw({7.125, &one, {0.5}, nullptr});
  int changed = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (at(before, x, y) == at(after, x, y)) continue;
      ++changed;
      EXPECT_GT(y, height * 9 / 10);
      EXPECT_LT(x, width / 3);
    }
  }
  EXPECT_GT(changed, 10);
  EXPECT_GT(lightness(at(before, width / 4, height / 4)),
            lightness(at(before, width / 4, height - 40)));
}

TEST_F(Scene, BonesAreWhereTheirBodyIs) {
  BodyShape bone;
  bone.name = "bone";
  bone.bones.push_back({{0, 0, 0}, {0.1, 0, 0}, 0.02, 0.02, 0.02});
  SystemPoser::Posture one = posture(0.005);
  one.bodies["bone"] = {Eigen::Matrix3d::Identity(), {0.02, 0.1, 0}};
  const Image without = drawMuscle(0.5, 0.005), with = draw({0, &one, {0.5}, nullptr}, {bone});
  const double pixel = 2 * std::tan(cameraViewAngle / 2) / height;
  const auto differs = [&](double x, double y) {
    const int column = width / 2 + static_cast<int>(x / pixel);
    const int row = height / 2 - static_cast<int>(y / pixel);
    return at(without, column, row) != at(with, column, row);
  };
  EXPECT_TRUE(differs(0.07, 0.1));
  EXPECT_FALSE(differs(0.07, -0.1));
  EXPECT_FALSE(differs(-0.07, 0.1));
}

TEST_F(Scene, PngHoldsTheSizeOfThePicture) {
  const std::string png = pngOf(drawMuscle(0.5));
  EXPECT_EQ(png.substr(0, 4), "\x89PNG");
  EXPECT_EQ(static_cast<unsigned char>(png[18]) * 256 + static_cast<unsigned char>(png[19]), width);
  EXPECT_EQ(static_cast<unsigned char>(png[22]) * 256 + static_cast<unsigned char>(png[23]),
            height);
}

}  // namespace
