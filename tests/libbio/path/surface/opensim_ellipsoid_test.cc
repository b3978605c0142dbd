#include "bio/path/surface/opensim_ellipsoid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "bio/path/opensim_difference.h"
#include "bio/path/posture_samples.h"
#include "libbio/path/arm_paths.h"

namespace bio {
namespace {

using V = Vec3<double>;
constexpr WrapQuadrant everywhere = WrapQuadrant::all;

/// Random ends on both sides of an ellipsoid, 1.3 to 3 sizes away.
std::pair<V, V> someEnds(std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> far(0.06, 0.12);
  const V x = V(normal(random), normal(random), normal(random)).normalized();
  const V aside = V(normal(random), normal(random), normal(random)) * 0.3;
  return {far(random) * x, -far(random) * (x + aside).normalized()};
}

// Any plane through a sphere's centre cuts it in a great circle.
TEST(OpenSimEllipsoid, OfEqualAxesIsTheSphere) {
  std::mt19937 random(3);
  int touched = 0;
  for (int i = 0; i < 200; ++i) {
    const auto [P, Q] = someEnds(random);
    const auto sphere = wrapSphere(0.04, Way::shorter, P, Q);
    const OpenSimSpan span =
        openSimEllipsoid(V::Constant(0.04), everywhere, P, Q, ArcLength::exact);
    touched += span.touches ? 1 : 0;
    EXPECT_EQ(span.touches, sphere.touches);
    EXPECT_NEAR(span.length, sphere.length, 1e-9);
    // chords of 1 mm, or of a little more: 1/24 of the square of their angle shorter
    const double chords =
        openSimEllipsoid(V::Constant(0.04), everywhere, P, Q, ArcLength::chords).length;
    EXPECT_LE(chords, span.length);
    EXPECT_GT(chords, span.length - 1e-5);
  }
  EXPECT_GT(touched, 100);
}

TEST(OpenSimEllipsoid, KeepsToTheQuadrant) {
  const V a(0.02, 0.03, 0.05), P(0.08, 0.004, 0.01), Q(-0.07, 0.006, -0.02);
  const double plus = openSimEllipsoid(a, WrapQuadrant::plusY, P, Q, ArcLength::exact).length;
  const double minus = openSimEllipsoid(a, WrapQuadrant::minusY, P, Q, ArcLength::exact).length;
  const double all = openSimEllipsoid(a, everywhere, P, Q, ArcLength::exact).length;
  EXPECT_NEAR(all, plus, 1e-12);  // both ends lie there
  EXPECT_GT(minus, plus + 1e-3);
}

TEST(OpenSimEllipsoid, IsStraightWhereTheChordMissesOrAnEndIsInside) {
  const V a(0.02, 0.03, 0.05);
  for (const auto& [P, Q] :
       {std::pair{V(0.1, 0, 0), V(0.1, 0.1, 0)}, std::pair{V(0.1, 0.01, 0), V(0.03, 0.01, 0)},
        std::pair{V(0.1, 0, 0), V(0.01, 0.01, 0.01)}}) {
    const OpenSimSpan span = openSimEllipsoid(a, everywhere, P, Q, ArcLength::exact);
    EXPECT_FALSE(span.touches);
    EXPECT_EQ(span.length, (Q - P).norm());
  }
}

// A taut string is no longer than a plane section on the same side, and over unequal axes shorter.
TEST(OpenSimDifference, IsNeverBelowTheTautString) {
  using namespace fixtures;
  for (Muscle m : {extensor({"odd"}), flexor({"odd"})}) {
    Model model = arm();
    model.muscles = {m};
    ArmPath<1> one(model, m);
    double most = 0;
    int touched = 0;
    for (int k = 0; k <= 50; ++k) {
      const double q = -0.2 + 0.05 * k;
      const OpenSimDifference d =
          openSimDifference(one.path, postureOf(one.skeleton, {q}), ArcLength::exact);
      touched += d.over.empty() ? 0 : 1;
      EXPECT_GT(d.length, -1e-8) << q;
      most = std::max(most, d.length);
    }
    std::printf("  %d touch, up to %.3g m longer\n", touched, most);
    EXPECT_GT(touched, 5);
    const auto departures = openSimDepartures(model, one.skeleton, {}, -0.2, 2.3);
    ASSERT_EQ(departures.size(), most > 1e-5 ? 1u : 0u);
    for (const OpenSimDeparture& found : departures) {
      EXPECT_EQ(found.over, std::vector<std::string>{"odd"});
      EXPECT_GE(found.length, most - 1e-12);
    }
  }
}

}  // namespace
}  // namespace bio
