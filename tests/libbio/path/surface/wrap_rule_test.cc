#include "bio/path/surface/wrap_rule.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "bio/path/surface/wrap_sphere.h"

namespace bio {
namespace {

using V = Vec3<double>;
constexpr Side ccw = Side::counterclockwise;
constexpr Side cw = Side::clockwise;

TEST(WrapQuadrant, ReadsOpenSimsWords) {
  EXPECT_EQ(wrapQuadrant("all"), WrapQuadrant::all);
  EXPECT_EQ(wrapQuadrant("x"), WrapQuadrant::plusX);
  EXPECT_EQ(wrapQuadrant("+x"), WrapQuadrant::plusX);
  EXPECT_EQ(wrapQuadrant("-x"), WrapQuadrant::minusX);
  EXPECT_EQ(wrapQuadrant("y"), WrapQuadrant::plusY);
  EXPECT_EQ(wrapQuadrant("-Y"), WrapQuadrant::minusY);
  EXPECT_EQ(wrapQuadrant("+z"), WrapQuadrant::plusZ);
  EXPECT_EQ(wrapQuadrant("-z"), WrapQuadrant::minusZ);
  for (const char* bad : {"", "w", "-", "xx", "+-x", "left"}) {
    EXPECT_THROW(wrapQuadrant(bad), std::invalid_argument) << bad;
  }
}

TEST(CylinderSide, WithoutQuadrantIsTheShorterWay) {
  EXPECT_EQ(cylinderSide(WrapQuadrant::all, V(2, -1, 0), V(2, 1, 0)), ccw);
  EXPECT_EQ(cylinderSide(WrapQuadrant::all, V(2, 1, 0), V(2, -1, 0)), cw);
  EXPECT_EQ(cylinderSide(WrapQuadrant::all, V(-2, 1, 0), V(-2, -1, 3)), ccw);
}

TEST(CylinderSide, PassesTheNamedSide) {
  // downwards past +x is clockwise, past −x counter-clockwise
  EXPECT_EQ(cylinderSide(WrapQuadrant::plusX, V(0.2, 3, 0), V(0.1, -3, 0)), cw);
  EXPECT_EQ(cylinderSide(WrapQuadrant::minusX, V(0.2, 3, 0), V(0.1, -3, 0)), ccw);
  EXPECT_EQ(cylinderSide(WrapQuadrant::plusX, V(-0.2, 3, 0), V(-0.1, -3, 0)), cw);
  EXPECT_EQ(cylinderSide(WrapQuadrant::plusY, V(-3, 0.1, 0), V(3, 0.1, 0)), cw);
  EXPECT_EQ(cylinderSide(WrapQuadrant::minusY, V(-3, 0.1, 0), V(3, 0.1, 0)), ccw);
  EXPECT_THROW(cylinderSide(WrapQuadrant::plusZ, V(2, 0, 0), V(0, 2, 0)), std::invalid_argument);
}

// OpenSim's cases: neither end on the side always wraps; a free line on the side does not.
TEST(CylinderTouches, FollowsTheQuadrant) {
  const auto touches = [](WrapQuadrant quadrant, const V& P, const V& Q) {
    return cylinderTouches(1, 10, cylinderSide(quadrant, P, Q), P, Q);
  };
  EXPECT_TRUE(touches(WrapQuadrant::plusX, V(-2, 3, 0), V(-2, -3, 0)));  // neither end on the side
  EXPECT_FALSE(touches(WrapQuadrant::plusX, V(2, 3, 0), V(2, -3, 0)));   // free, on the side
  EXPECT_TRUE(touches(WrapQuadrant::plusX, V(0.5, 3, 0), V(0.5, -3, 0)));  // penetrates
  EXPECT_TRUE(touches(WrapQuadrant::plusX, V(-0.5, 3, 0), V(-0.5, -3, 0)));
  EXPECT_TRUE(touches(WrapQuadrant::all, V(-0.5, 3, 0), V(-0.5, -3, 0)));
  EXPECT_FALSE(touches(WrapQuadrant::all, V(-1.5, 3, 0), V(-1.5, -3, 0)));  // misses
}

TEST(CylinderTouches, NotWhenAnEndIsInsideOrBothContactsAreBeyondTheEnds) {
  EXPECT_FALSE(cylinderTouches(1, 10, cw, V(0.5, 0.5, 0), V(0.5, -3, 0)));
  EXPECT_FALSE(cylinderTouches(1, 10, cw, V(0.5, 3, 0), V(0, 0, 0)));
  EXPECT_TRUE(cylinderTouches(1, 10, cw, V(0.5, 3, 4.9), V(0.5, -3, 4.9)));
  EXPECT_FALSE(cylinderTouches(1, 10, cw, V(0.5, 3, 5.1), V(0.5, -3, 5.1)));
  EXPECT_TRUE(cylinderTouches(1, 10, cw, V(0.5, 3, -3), V(0.5, -3, 13)));
  EXPECT_TRUE(cylinderTouches(1, 10, cw, V(0.5, 3, 13), V(0.5, -3, -3)));
}

// For "all", any segment that penetrates touches, and none that misses.
TEST(CylinderTouches, MeansPenetrationForQuadrantAll) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-3, 3);
  int inside = 0;
  for (int i = 0; i < 5000; ++i) {
    const V P(unit(random), unit(random), unit(random)),
        Q(unit(random), unit(random), unit(random));
    if (P.head<2>().norm() <= 1 || Q.head<2>().norm() <= 1) continue;
    double closest = 1e9;
    for (int k = 0; k <= 2000; ++k) {
      closest = std::min(closest, (P + (Q - P) * k / 2000.0).head<2>().norm());
    }
    if (std::abs(closest - 1) < 1e-3) continue;
    inside += closest < 1 ? 1 : 0;
    const Side side = cylinderSide(WrapQuadrant::all, P, Q);
    EXPECT_EQ(cylinderTouches(1, 100, side, P, Q), closest < 1);
    EXPECT_EQ(wrapSphere(1.0, sphereWay(WrapQuadrant::all, P, Q), P, Q).touches, [&] {
      double least = 1e9;
      for (int k = 0; k <= 2000; ++k) least = std::min(least, (P + (Q - P) * k / 2000.0).norm());
      return least < 1;
    }());
  }
  EXPECT_GT(inside, 500);
}

TEST(SphereWay, PassesTheNamedSide) {
  EXPECT_EQ(sphereWay(WrapQuadrant::all, V(2, 0, 0), V(0, 2, 0)), Way::shorter);
  EXPECT_EQ(sphereWay(WrapQuadrant::plusX, V(2, 0, 0), V(0, 2, 0)), Way::shorter);
  EXPECT_EQ(sphereWay(WrapQuadrant::minusX, V(2, 0, 0), V(0, 2, 0)), Way::longer);
  EXPECT_EQ(sphereWay(WrapQuadrant::minusZ, V(2, 0, -1), V(0, 2, -1)), Way::shorter);
}

constexpr double deg = std::numbers::pi / 180;

V towards(double angle_deg) {
  return V(3 * std::cos(angle_deg * deg), 3 * std::sin(angle_deg * deg), 0);
}

TEST(AngleRound, RunsFromZeroToATurnOnEitherSide) {
  for (const double angle : {10.0, 100.0, 190.0, 350.0}) {
    EXPECT_NEAR(angleRound(ccw, towards(20), towards(20 + angle)), angle * deg, 1e-14);
    EXPECT_NEAR(angleRound(cw, towards(20), towards(20 - angle)), angle * deg, 1e-14);
  }
}

// Where the angles that occur end is where the jump must not be.
TEST(SlipAngle, LiesInTheMiddleOfTheWidestGap) {
  const auto slipped = [](double decided, const std::vector<double>& angles_deg, double at) {
    std::vector<double> angles;
    for (const double a : angles_deg) angles.push_back(a * deg);
    return hasSlippedOff(slipAngle(decided * deg, angles), ccw, towards(0), towards(at));
  };
  // an extensor: from 17 to 147 degrees, so that 262 is as far from both as can be
  const std::vector<double> extensor = {147, 17, 80};
  EXPECT_FALSE(slipped(147, extensor, 147));
  EXPECT_FALSE(slipped(147, extensor, 261));
  EXPECT_TRUE(slipped(147, extensor, 263));
  EXPECT_TRUE(slipped(147, extensor, 359));
  EXPECT_FALSE(slipped(147, extensor, 1));
  // a path that goes more than half way round where its side was decided keeps it
  EXPECT_FALSE(slipped(230, {170, 200, 230}, 300));
  EXPECT_FALSE(slipped(230, {170, 200, 230}, 359));
  // angles on either side of 0: the ones below are of a path that has slipped off
  EXPECT_TRUE(slipped(120, {120, 60, 5, 340, 300}, 300));
  EXPECT_TRUE(slipped(120, {120, 60, 5, 340, 300}, 211));
  EXPECT_FALSE(slipped(120, {120, 60, 5, 340, 300}, 209));
  // nothing known: never
  EXPECT_FALSE(hasSlippedOff(SlipAngle{}, ccw, towards(0), towards(359)));
  EXPECT_FALSE(hasSlippedOff(slipAngle(1, {}), cw, towards(0), towards(-359)));
}

TEST(SlipAngle, IsSeenFromThePathsOwnSide) {
  const SlipAngle slip = slipAngle(100 * deg, {100 * deg, 20 * deg});
  EXPECT_TRUE(hasSlippedOff(slip, cw, towards(0), towards(-300)));
  EXPECT_FALSE(hasSlippedOff(slip, cw, towards(0), towards(-200)));
  EXPECT_FALSE(hasSlippedOff(slip, cw, towards(0), towards(-60)));
}

}  // namespace
}  // namespace bio
