#include "bio/path/path_gradient.h"

#include <gtest/gtest.h>

#include "bio/path/path_length.h"
#include "support/elbow_model.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

/// ℓ, ∂ℓ/∂q of a muscle of a model compiled anew.
template <int N>
LengthJet<N> lengthOf(const Model& model, const std::vector<std::string>& free,
                      const std::string& muscle, const Eigen::Matrix<double, N, 1>& q) {
  const Skeleton skeleton(model, {free, {}});
  const MusclePath path(model, skeleton, findMuscle(model, muscle), {});
  std::vector<RigidMotion<double, N>> moved(skeleton.numSegments());
  skeleton.motions<double, N>(q, moved.data());
  return path.length<N>(q, moved.data());
}

template <int N>
void gradientsMatchDifferences(const Model& model, const std::vector<std::string>& free,
                               const Eigen::Matrix<double, N, 1>& q, double tolerance) {
  const Skeleton skeleton(model, {free, {}});
  int points = 0, wraps = 0;
  for (std::size_t m = 0; m < model.muscles.size(); ++m) {
    const Muscle& muscle = model.muscles[m];
    const MusclePath path(model, skeleton, muscle, {});
    const PathGradients gradients(model, skeleton, muscle, path);
    PathGradient<N> g = gradients.workspace<N>();
    std::vector<RigidMotion<double, N>> moved(skeleton.numSegments());
    skeleton.motions<double, N>(q, moved.data());
    gradients.evaluate<N>(q, moved.data(), g);
    const auto check = [&](auto&& set, const auto& row, const std::string& what) {
      const auto at = [&](double shift) {
        Model other = model;
        set(other, shift);
        return lengthOf<N>(other, free, muscle.name, q);
      };
      const double h = 1e-6;
      const LengthJet<N> plus = at(h), minus = at(-h);
      EXPECT_NEAR(row[0], (plus.length - minus.length) / (2 * h), tolerance) << what;
      for (int k = 0; k < N; ++k) {
        EXPECT_NEAR(row[1 + k], (plus.dL_dq[k] - minus.dL_dq[k]) / (2 * h), tolerance)
            << what << ", slope in " << free[static_cast<std::size_t>(k)];
      }
    };
    for (std::size_t i = 0; i < muscle.path.points.size(); ++i) {
      if (muscle.path.points[i].motion) continue;
      for (int axis = 0; axis < 3; ++axis) {
        ++points;
        check([&](Model& other,
                  double shift) { other.muscles[m].path.points[i].location[axis] += shift; },
              g.points[i].row(axis), muscle.path.points[i].name);
      }
    }
    for (std::size_t w = 0; w < muscle.path.wraps.size(); ++w) {
      if (!gradients.mayTouch(w)) continue;
      std::size_t index = 0;
      while (model.wrapObjects[index].name != muscle.path.wraps[w].wrapObject) ++index;
      ++wraps;
      for (int c = 0; c < wrap_rows::count; ++c) {
        check(
            [&](Model& other, double shift) {
              WrapObject& wrap = other.wrapObjects[index];
              if (c == 0) wrap.radius += shift;
              if (c > 0 && c < 4) wrap.frame.translation[c - 1] += shift;
              if (c >= 4 && c < 7) wrap.frame.orientation[c - 4] += shift;
              if (c >= 7 && wrap.shape == WrapShape::ellipsoid) wrap.semiAxes[c - 7] += shift;
            },
            g.wraps[w].row(c), muscle.name + " over " + muscle.path.wraps[w].wrapObject);
      }
    }
  }
  EXPECT_GT(points, 20);
  EXPECT_GT(wraps, 0);
}

class PathGradientAt : public ::testing::TestWithParam<double> {};
TEST_P(PathGradientAt, MatchesDifferencesOfCompiledPaths) {
  const fixtures::ShippedElbow elbow;
  gradientsMatchDifferences<1>(elbow.model, {"elbow_flexion"},
                               Eigen::Matrix<double, 1, 1>(GetParam()), 3e-7);
}
INSTANTIATE_TEST_SUITE_P(OverTheRange, PathGradientAt, ::testing::Values(-0.5, 0.3, 0.7, 1.2, 1.9));

TEST(PathGradient, MatchesDifferencesForTwoCoordinates) {
  const fixtures::ShippedElbow elbow;
  gradientsMatchDifferences<2>(elbow.model, {"shoulder_rot", "elbow_flexion"},
                               Eigen::Vector2d(0.1, 1.3), 3e-7);
}

// The triceps' cylinder replaced by an ellipsoid.
TEST(PathGradient, MatchesDifferencesOverEllipsoids) {
  fixtures::ShippedElbow elbow;
  for (WrapObject& wrap : elbow.model.wrapObjects) {
    if (wrap.name != "TRI") continue;
    wrap.shape = WrapShape::ellipsoid;
    wrap.semiAxes = {wrap.radius, 1.1 * wrap.radius, 0.04};
  }
  const Skeleton skeleton(elbow.model, {{"elbow_flexion"}, {}});
  const MusclePath path(elbow.model, skeleton, findMuscle(elbow.model, "TRIlong"), {});
  EXPECT_FALSE(path.compiled().chains.empty());
  for (const double angle : {0.7, 1.2, 1.9}) {
    gradientsMatchDifferences<1>(elbow.model, {"elbow_flexion"}, Eigen::Matrix<double, 1, 1>(angle),
                                 3e-7);
  }
  gradientsMatchDifferences<2>(elbow.model, {"shoulder_rot", "elbow_flexion"},
                               Eigen::Vector2d(0.1, 1.3), 3e-7);
}

TEST(PathGradient, MovingTheWholeArmMovesNothing) {
  // shifting all points and objects of one fixed body together is a shift of the other ones
  const fixtures::ShippedElbow elbow;
  const Skeleton& skeleton = elbow.system.skeleton();
  std::vector<RigidMotion<double, 1>> moved(skeleton.numSegments());
  const Eigen::Matrix<double, 1, 1> q(1.4);
  skeleton.motions<double, 1>(q, moved.data());
  for (const SystemMuscle& m : elbow.system.muscles()) {
    const Muscle& muscle = findMuscle(elbow.model, m.name);
    const PathGradients gradients(elbow.model, skeleton, muscle, m.path);
    PathGradient<1> g = gradients.workspace<1>();
    gradients.evaluate<1>(q, moved.data(), g);
    // ∂ℓ/∂x of all points and objects, turned into the ground, adds up to nothing
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const auto intoGround = [&](const std::string& body, const Eigen::Vector3d& v) {
      const BodyPlacement& place = skeleton.placeOf(body);
      sum += moved[place.segment].value.R * (place.X_SB.R * v);
    };
    for (std::size_t i = 0; i < muscle.path.points.size(); ++i) {
      intoGround(muscle.path.points[i].body, g.points[i].col(0));
    }
    for (std::size_t w = 0; w < muscle.path.wraps.size(); ++w) {
      const WrapObject& wrap = findWrapObject(elbow.model, muscle.path.wraps[w].wrapObject);
      intoGround(wrap.body, g.wraps[w].template block<3, 1>(1, 0));
    }
    EXPECT_LT(sum.norm(), 1e-13) << m.name;
  }
}

}  // namespace
}  // namespace bio
