#include "bio/path/surface/wrap_sphere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "bio/path/surface/wrap_cylinder.h"

namespace bio {
namespace {

using std::numbers::pi;
using V = Vec3<double>;
using Vec6 = Eigen::Matrix<double, 6, 1>;

struct SphereCase {
  double radius;
  Way way;
  V P, Q;
};

SphereCase randomSphere(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal(0, 1);
  const auto point = [&](double r) {
    const V direction(normal(random), normal(random), normal(random));
    return V(direction.normalized() * r * (1.05 + 5 * unit(random)));
  };
  SphereCase c;
  c.radius = 0.005 + 0.03 * unit(random);
  c.way = unit(random) < 0.7 ? Way::shorter : Way::longer;
  c.P = point(c.radius);
  c.Q = point(c.radius);
  return c;
}

TEST(WrapSphere, KnownValues) {
  // two straight pieces of 0.5, a quarter turn between them
  const Span<double> quarter = wrapSphere(1.0, Way::shorter, V(1, -0.5, 0), V(-0.5, 1, 0));
  EXPECT_TRUE(quarter.touches);
  EXPECT_NEAR(quarter.length, 1 + pi / 2, 1e-14);
  EXPECT_NEAR((quarter.dL_dP - V(0, -1, 0)).norm(), 0, 1e-14);
  EXPECT_NEAR((quarter.dL_dQ - V(-1, 0, 0)).norm(), 0, 1e-14);
  const Span<double> straight = wrapSphere(1.0, Way::shorter, V(2, -1, 0), V(2, 1, 1));
  EXPECT_FALSE(straight.touches);
  EXPECT_NEAR(straight.length, std::sqrt(5.0), 1e-15);
  // the long way round: 270° less the two tangent angles of 45°
  const Span<double> longer =
      wrapSphere(1.0, Way::longer, V(std::sqrt(2.0), 0, 0), V(0, std::sqrt(2.0), 0));
  EXPECT_NEAR(longer.length, 2 + pi, 1e-14);
}

// In the plane of the ends and the centre a sphere is a cylinder across that plane.
TEST(WrapSphere, AgreesWithTheCylinderAcrossItsPlane) {
  std::mt19937 random(1);
  int wrapped = 0;
  for (int i = 0; i < 2000; ++i) {
    const SphereCase c = randomSphere(random);
    Mat3<double> R;  // frame with z across the plane
    R.col(2) = c.P.cross(c.Q).normalized();
    R.col(0) = c.P.normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    const Side side = c.way == Way::shorter ? Side::counterclockwise : Side::clockwise;
    const Span<double> cylinder =
        wrapCylinder(c.radius, side, V(R.transpose() * c.P), V(R.transpose() * c.Q));
    const Span<double> sphere = wrapSphere(c.radius, c.way, c.P, c.Q);
    ASSERT_EQ(sphere.touches, cylinder.touches);
    wrapped += sphere.touches ? 1 : 0;
    EXPECT_NEAR(sphere.length, cylinder.length, 1e-13);
    EXPECT_NEAR((sphere.dL_dP - R * cylinder.dL_dP).norm(), 0, 1e-11);
    EXPECT_NEAR((sphere.dL_dQ - R * cylinder.dL_dQ).norm(), 0, 1e-11);
  }
  EXPECT_GT(wrapped, 800);
}

// A frictionless ball takes no moment about its centre.
TEST(WrapSphere, TransmitsNoMomentAboutItsCentre) {
  std::mt19937 random(2);
  for (int i = 0; i < 1000; ++i) {
    const SphereCase c = randomSphere(random);
    const Span<double> span = wrapSphere(c.radius, c.way, c.P, c.Q);
    EXPECT_NEAR((c.P.cross(span.dL_dP) + c.Q.cross(span.dL_dQ)).norm(), 0, 1e-14);
    EXPECT_NEAR(span.dL_dP.norm(), 1, 1e-13);
    EXPECT_NEAR(span.dL_dQ.norm(), 1, 1e-13);
  }
}

TEST(WrapSphere, ContactPointsLieOnTheSurface) {
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    const SphereCase c = randomSphere(random);
    const Span<double> span = wrapSphere(c.radius, c.way, c.P, c.Q);
    if (!span.touches) continue;
    const WrapContact<double> contact = wrapSphereContact(c.radius, c.way, c.P, c.Q);
    EXPECT_NEAR(contact.p_CA.norm(), c.radius, 1e-14);
    EXPECT_NEAR(contact.p_CB.norm(), c.radius, 1e-14);
    EXPECT_NEAR((contact.p_CA - c.P).dot(contact.p_CA), 0, 1e-15);
    EXPECT_NEAR((c.Q - contact.p_CB).dot(contact.p_CB), 0, 1e-15);
  }
}

TEST(WrapSphere, IsContinuouslyDifferentiableAtLiftOff) {
  const double r = 0.02, liftOff = std::acos(r / 0.05) + std::acos(r / 0.03);
  const V tilted = V(0.3, 0.5, 0.8).normalized();
  const auto at = [&](double offset) {
    const Eigen::AngleAxisd turn(liftOff + offset, tilted);
    const V start = tilted.unitOrthogonal();
    return wrapSphere(r, Way::shorter, V(0.05 * start), V(turn * (0.03 * start)));
  };
  for (const double tiny : {1e-4, 1e-6, 1e-8}) {
    const Span<double> straight = at(-tiny), touching = at(tiny);
    EXPECT_FALSE(straight.touches);
    EXPECT_TRUE(touching.touches);
    EXPECT_NEAR(straight.length, touching.length, 0.1 * tiny);
    EXPECT_NEAR((straight.dL_dP - touching.dL_dP).norm(), 0, 5 * tiny);
  }
}

TEST(WrapSphere, DerivativesAgreeThreeWays) {
  using Inner = info::Dual<6>;
  using Outer = info::Dual<6, Inner>;
  std::mt19937 random(4);
  for (int i = 0; i < 1000; ++i) {
    const SphereCase c = randomSphere(random);
    if (c.P.normalized().cross(c.Q.normalized()).norm() < 0.05) continue;  // plane ill defined
    const SpanToSecondOrder<double> hand = wrapSphereToSecondOrder(c.radius, c.way, c.P, c.Q);
    Vec6 gradient, z;
    gradient << hand.span.dL_dP, hand.span.dL_dQ;
    z << c.P, c.Q;
    Eigen::Matrix<double, 6, 6> hessian;
    hessian << hand.hessian.d2L_dPdP, hand.hessian.d2L_dPdQ, hand.hessian.d2L_dPdQ.transpose(),
        hand.hessian.d2L_dQdQ;
    Vec3<Outer> P, Q;
    for (int k = 0; k < 3; ++k) {
      P[k] = Outer(Inner(z[k], 6, k), 6, k);
      Q[k] = Outer(Inner(z[k + 3], 6, k + 3), 6, k + 3);
    }
    const Outer L = wrapSphere(Outer(Inner(c.radius)), c.way, P, Q).length;
    const double scale = 1 + hessian.cwiseAbs().maxCoeff();
    EXPECT_NEAR(L.value().value(), hand.span.length, 1e-14);
    const double h = 1e-6 * c.radius;
    for (int j = 0; j < 6; ++j) {
      EXPECT_NEAR(L.derivatives()[j].value(), gradient[j], 1e-10);
      for (int k = 0; k < 6; ++k) {
        EXPECT_NEAR(L.derivatives()[j].derivatives()[k], hessian(j, k), 1e-9 * scale);
      }
      const auto moved = [&](double step) {
        Vec6 y = z;
        y[j] += step;
        return wrapSphere(c.radius, c.way, V(y.head<3>()), V(y.tail<3>()));
      };
      const Span<double> plus = moved(h), minus = moved(-h);
      if (plus.touches != minus.touches) continue;
      EXPECT_NEAR((plus.length - minus.length) / (2 * h), gradient[j], 1e-6);
      Vec6 change;
      change << plus.dL_dP - minus.dL_dP, plus.dL_dQ - minus.dL_dQ;
      EXPECT_NEAR((change / (2 * h) - hessian.col(j)).norm(), 0, 1e-6 * scale);
    }
  }
}

// ∂L/∂r = β
TEST(WrapSphere, RadiusDerivativeIsTheWrappedAngle) {
  using Dual1 = info::Dual<1>;
  std::mt19937 random(5);
  for (int i = 0; i < 500; ++i) {
    const SphereCase c = randomSphere(random);
    const Span<Dual1> span =
        wrapSphere(Dual1(c.radius, 1, 0), c.way, Vec3<Dual1>(c.P.cast<Dual1>()),
                   Vec3<Dual1>(c.Q.cast<Dual1>()));
    const double angle = wrapSphereContact(c.radius, c.way, c.P, c.Q).angle;
    EXPECT_NEAR(span.length.derivatives()[0], angle, 1e-10);
  }
}

TEST(WrapSphere, RefusesEndsThatAreNotOutside) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const V& inside : {V(0.5, 0, 0), V(0, 1, 0), V(nan, 3, 0)}) {
    EXPECT_THROW(wrapSphere(1.0, Way::shorter, inside, V(2, 0, 0)), std::domain_error);
    EXPECT_THROW(wrapSphereToSecondOrder(1.0, Way::shorter, V(2, 0, 0), inside), std::domain_error);
  }
}

}  // namespace
}  // namespace bio
