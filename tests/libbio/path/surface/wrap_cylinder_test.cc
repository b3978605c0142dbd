#include "bio/path/surface/wrap_cylinder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "support/appendix_a_cylinder.h"

namespace bio {
namespace {

using std::numbers::pi;
using V = Vec3<double>;
using Vec6 = Eigen::Matrix<double, 6, 1>;

struct CylinderCase {
  double radius;
  Side side;
  V P, Q;
};

V cylindrical(double distance, double angle, double z) {
  return {distance * std::cos(angle), distance * std::sin(angle), z};
}

// Ends outside the cylinder, any angle between them.
CylinderCase randomCylinder(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  CylinderCase c;
  c.radius = 0.005 + 0.03 * unit(random);
  c.side = unit(random) < 0.5 ? Side::counterclockwise : Side::clockwise;
  c.P =
      cylindrical(c.radius * (1.05 + 9 * unit(random)), 2 * pi * unit(random), 0.1 * unit(random));
  c.Q =
      cylindrical(c.radius * (1.05 + 9 * unit(random)), 2 * pi * unit(random), 0.1 * unit(random));
  return c;
}

Span<double> wrap(const CylinderCase& c) {
  return wrapCylinder(c.radius, c.side, c.P, c.Q);
}

// The angle on the given side, from P to Q.
double sweep(const CylinderCase& c) {
  const double sigma = c.side == Side::counterclockwise ? 1 : -1;
  const double angle = sigma * (std::atan2(c.Q.y(), c.Q.x()) - std::atan2(c.P.y(), c.P.x()));
  return angle < 0 ? angle + 2 * pi : angle;
}

TEST(WrapCylinder, KnownValues) {
  // ends at right angles to the tangent points: half a turn plus two straight pieces
  const Span<double> half = wrapCylinder(1.0, Side::counterclockwise, V(1, -3, 0), V(-1, -2, 0));
  EXPECT_TRUE(half.touches);
  EXPECT_NEAR(half.length, 3 + 2 + pi, 1e-14);
  EXPECT_NEAR((half.dL_dP - V(0, -1, 0)).norm(), 0, 1e-14);
  EXPECT_NEAR((half.dL_dQ - V(0, -1, 0)).norm(), 0, 1e-14);
  // three quarters of a turn: β = 3π/2
  const Span<double> most = wrapCylinder(1.0, Side::counterclockwise, V(1, -0.3, 0), V(0.4, -1, 0));
  EXPECT_NEAR(most.length, 0.3 + 0.4 + 1.5 * pi, 1e-14);
  // a helix: the same half turn while rising by 4
  const Span<double> helix = wrapCylinder(1.0, Side::counterclockwise, V(1, -3, 1), V(-1, -2, 5));
  EXPECT_NEAR(helix.length, std::hypot(5 + pi, 4), 1e-14);
}

TEST(WrapCylinder, IsStraightWhereThatPassesOnTheSide) {
  const Span<double> span = wrapCylinder(1.0, Side::counterclockwise, V(2, -3, 1), V(2, 3, 0));
  EXPECT_FALSE(span.touches);
  EXPECT_NEAR(span.length, std::sqrt(37.0), 1e-15);
  // the other way round it has to wrap
  EXPECT_TRUE(wrapCylinder(1.0, Side::clockwise, V(2, -3, 1), V(2, 3, 0)).touches);
}

// (A.1) alone would wrap here: the axis is nearer to the line than r, but beyond the segment.
TEST(WrapCylinder, IsStraightWhenTheAxisLiesBeyondTheSegment) {
  const Span<double> span = wrapCylinder(1.0, Side::counterclockwise, V(3, -0.5, 0), V(6, 0.0, 0));
  EXPECT_FALSE(span.touches);
  const support::AppendixACylinder appendix{V::Zero(), V::UnitZ(), 1.0};
  EXPECT_TRUE(appendix(V(3, -0.5, 0), V(6, 0.0, 0), V::UnitX()).wraps);
}

// The second algorithm: the thesis's own chain, its misprints corrected.
TEST(WrapCylinder, AgreesWithTheChainOfAppendixA) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  int wrapped = 0;
  for (int i = 0; i < 2000; ++i) {
    CylinderCase c = randomCylinder(random);
    const Span<double> span = wrap(c);
    if (!span.touches) continue;
    const double beta = wrapCylinderContact(c.radius, c.side, c.P, c.Q).angle;
    if (beta > pi - 0.02 || beta < 0.02) continue;  // the arcsine's end points
    const V axis = c.side == Side::counterclockwise ? V::UnitZ() : V(-V::UnitZ());
    const support::AppendixACylinder appendix{V(0, 0, unit(random)), axis, c.radius};
    const V motion(unit(random), unit(random), unit(random));
    const auto result = appendix(c.P, c.Q, motion);
    ASSERT_TRUE(result.wraps);
    EXPECT_NEAR(span.length, result.length, 1e-13);
    EXPECT_NEAR(span.dL_dQ.dot(motion), result.derivative, 1e-11);
    ++wrapped;
  }
  EXPECT_GT(wrapped, 500);
}

// A third way: the shortest of all polylines over the surface, found by minimising over the contact
// angles of each end (length along the surface unrolled).
TEST(WrapCylinder, IsTheShortestPathRoundTheCylinder) {
  std::mt19937 random(2);
  int wrapped = 0;
  for (int i = 0; i < 400; ++i) {
    const CylinderCase c = randomCylinder(random);
    const Span<double> span = wrap(c);
    if (!span.touches) continue;
    ++wrapped;
    const double sigma = c.side == Side::counterclockwise ? 1 : -1;
    const double beta = wrapCylinderContact(c.radius, c.side, c.P, c.Q).angle;
    const WrapContact<double> contact = wrapCylinderContact(c.radius, c.side, c.P, c.Q);
    const double start = std::atan2(contact.p_CA.y(), contact.p_CA.x());
    // length of P → surface point (θ1, z1) → helix → surface point (θ2, z2) → Q
    const auto length = [&](const Eigen::Vector4d& x) {
      const V A = cylindrical(c.radius, start + sigma * x[0], x[1]);
      const V B = cylindrical(c.radius, start + sigma * x[2], x[3]);
      return (A - c.P).norm() + std::hypot(c.radius * (x[2] - x[0]), x[3] - x[1]) +
             (c.Q - B).norm();
    };
    const Eigen::Vector4d found(0, contact.p_CA.z(), beta, contact.p_CB.z());
    EXPECT_NEAR(length(found), span.length, 1e-14);
    // no neighbour that stays on the surface is shorter
    std::normal_distribution<double> normal(0, 1);
    for (int k = 0; k < 200; ++k) {
      const double scale = std::pow(10.0, -1 - 4.0 * k / 200);
      Eigen::Vector4d x = found + scale * Eigen::Vector4d(normal(random), 0.02 * normal(random),
                                                          normal(random), 0.02 * normal(random));
      // an end sees the surface only up to its tangent: contacts beyond would be reached through it
      x[0] = std::min(x[0], 0.0);
      x[2] = std::max(x[2], beta);
      EXPECT_GE(length(x), span.length - 1e-12);
    }
  }
  EXPECT_GT(wrapped, 150);
}

TEST(WrapCylinder, ContactPointsLieOnTheSurfaceAndTangentsTouchThem) {
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    const CylinderCase c = randomCylinder(random);
    const Span<double> span = wrap(c);
    if (!span.touches) continue;
    const WrapContact<double> contact = wrapCylinderContact(c.radius, c.side, c.P, c.Q);
    EXPECT_NEAR(contact.p_CA.head<2>().norm(), c.radius, 1e-15);
    EXPECT_NEAR(contact.p_CB.head<2>().norm(), c.radius, 1e-15);
    EXPECT_NEAR(contact.angle,
                sweep(c) - std::acos(c.radius / c.P.head<2>().norm()) -
                    std::acos(c.radius / c.Q.head<2>().norm()),
                1e-12);
    const V along = (contact.p_CA - c.P).normalized();
    EXPECT_NEAR((along + span.dL_dP).norm(), 0, 1e-11);
    EXPECT_NEAR(along.head<2>().dot(contact.p_CA.head<2>()), 0, 1e-12);
    EXPECT_NEAR(((c.Q - contact.p_CB).normalized() - span.dL_dQ).norm(), 0, 1e-11);
  }
}

// A frictionless cylinder takes neither axial force nor moment about its axis from the path.
TEST(WrapCylinder, TransmitsNoForceAlongAndNoMomentAboutItsAxis) {
  std::mt19937 random(4);
  for (int i = 0; i < 2000; ++i) {
    const CylinderCase c = randomCylinder(random);
    const Span<double> span = wrap(c);
    EXPECT_NEAR(span.dL_dP.z() + span.dL_dQ.z(), 0, 1e-15);
    EXPECT_NEAR((c.P.cross(span.dL_dP) + c.Q.cross(span.dL_dQ)).z(), 0, 1e-15);
    EXPECT_NEAR(span.dL_dP.norm(), 1, 1e-14);
    EXPECT_NEAR(span.dL_dQ.norm(), 1, 1e-14);
  }
}

TEST(WrapCylinder, ReversedAndMirroredPathsAreAsLong) {
  std::mt19937 random(5);
  for (int i = 0; i < 1000; ++i) {
    const CylinderCase c = randomCylinder(random);
    const Side other = c.side == Side::clockwise ? Side::counterclockwise : Side::clockwise;
    const Span<double> span = wrap(c);
    const Span<double> reversed = wrapCylinder(c.radius, other, c.Q, c.P);
    EXPECT_NEAR(span.length, reversed.length, 1e-14);
    EXPECT_NEAR((span.dL_dP - reversed.dL_dQ).norm(), 0, 1e-12);
    const V mirror(1, -1, 1);
    const Span<double> mirrored =
        wrapCylinder(c.radius, other, V(c.P.cwiseProduct(mirror)), V(c.Q.cwiseProduct(mirror)));
    EXPECT_NEAR(span.length, mirrored.length, 1e-14);
  }
}

// Near lift-off the two formulas meet with their value and slope.
TEST(WrapCylinder, IsContinuouslyDifferentiableAtLiftOff) {
  const double r = 0.016;
  const V P = cylindrical(0.05, 0.3, 0.01);
  const double liftOff = 0.3 + std::acos(r / 0.05) + std::acos(r / 0.03);
  const auto at = [&](double offset) {
    return wrapCylinder(r, Side::counterclockwise, P, cylindrical(0.03, liftOff + offset, 0.04));
  };
  for (const double tiny : {1e-4, 1e-6, 1e-8}) {
    const Span<double> straight = at(-tiny), touching = at(tiny);
    EXPECT_FALSE(straight.touches);
    EXPECT_TRUE(touching.touches);
    EXPECT_NEAR(straight.length, touching.length, 0.1 * tiny);
    EXPECT_NEAR((straight.dL_dP - touching.dL_dP).norm(), 0, 5 * tiny);
    EXPECT_NEAR((straight.dL_dQ - touching.dL_dQ).norm(), 0, 5 * tiny);
  }
}

// Length, gradient and Hessian by hand, through the scalar type and by differences.
TEST(WrapCylinder, DerivativesAgreeThreeWays) {
  using Inner = info::Dual<6>;
  using Outer = info::Dual<6, Inner>;
  std::mt19937 random(6);
  int wrapped = 0;
  for (int i = 0; i < 2000; ++i) {
    const CylinderCase c = randomCylinder(random);
    const SpanToSecondOrder<double> hand = wrapCylinderToSecondOrder(c.radius, c.side, c.P, c.Q);
    const Span<double> plain = wrap(c);
    wrapped += plain.touches ? 1 : 0;
    ASSERT_EQ(hand.span.touches, plain.touches);
    EXPECT_NEAR(hand.span.length, plain.length, 1e-15);
    EXPECT_NEAR((hand.span.dL_dP - plain.dL_dP).norm(), 0, 1e-14);
    EXPECT_NEAR((hand.span.dL_dQ - plain.dL_dQ).norm(), 0, 1e-14);

    Vec6 gradient;
    gradient << hand.span.dL_dP, hand.span.dL_dQ;
    Eigen::Matrix<double, 6, 6> hessian;
    hessian << hand.hessian.d2L_dPdP, hand.hessian.d2L_dPdQ, hand.hessian.d2L_dPdQ.transpose(),
        hand.hessian.d2L_dQdQ;
    Vec6 z;
    z << c.P, c.Q;
    Vec3<Outer> P, Q;
    for (int k = 0; k < 3; ++k) {
      P[k] = Outer(Inner(z[k], 6, k), 6, k);
      Q[k] = Outer(Inner(z[k + 3], 6, k + 3), 6, k + 3);
    }
    const Outer L = wrapCylinder(Outer(Inner(c.radius)), c.side, P, Q).length;
    const double scale = 1 + hessian.cwiseAbs().maxCoeff();
    for (int j = 0; j < 6; ++j) {
      EXPECT_NEAR(L.derivatives()[j].value(), gradient[j], 1e-11);
      for (int k = 0; k < 6; ++k) {
        EXPECT_NEAR(L.derivatives()[j].derivatives()[k], hessian(j, k), 1e-9 * scale);
      }
    }
    // central differences of the length and of the gradient
    const double h = 1e-6 * c.radius;
    for (int j = 0; j < 6; ++j) {
      const auto moved = [&](double step) {
        Vec6 y = z;
        y[j] += step;
        return wrapCylinder(c.radius, c.side, V(y.head<3>()), V(y.tail<3>()));
      };
      const Span<double> plus = moved(h), minus = moved(-h);
      if (plus.touches != minus.touches) continue;
      EXPECT_NEAR((plus.length - minus.length) / (2 * h), gradient[j], 1e-6);
      Vec6 change;
      change << plus.dL_dP - minus.dL_dP, plus.dL_dQ - minus.dL_dQ;
      EXPECT_NEAR((change / (2 * h) - hessian.col(j)).norm(), 0, 1e-6 * scale);
    }
  }
  EXPECT_GT(wrapped, 1000);
}

// ∂L/∂r = β·s/L: the arc grows with the radius, everything else is stationary.
TEST(WrapCylinder, RadiusDerivativeIsTheWrappedAngle) {
  using Dual1 = info::Dual<1>;
  std::mt19937 random(7);
  for (int i = 0; i < 500; ++i) {
    const CylinderCase c = randomCylinder(random);
    const Span<Dual1> span =
        wrapCylinder(Dual1(c.radius, 1, 0), c.side, Vec3<Dual1>(c.P.cast<Dual1>()),
                     Vec3<Dual1>(c.Q.cast<Dual1>()));
    double expected = 0;
    if (span.touches) {
      const double angle = wrapCylinderContact(c.radius, c.side, c.P, c.Q).angle;
      expected = angle * std::sqrt(1 - span.dL_dQ.z().value() * span.dL_dQ.z().value());
    }
    EXPECT_NEAR(span.length.derivatives()[0], expected, 1e-11);
  }
}

TEST(WrapCylinder, RefusesEndsThatAreNotOutside) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const V outside(2, 0, 0);
  for (const V& inside : {V(0.5, 0, 0), V(1, 0, 0), V(0, 0, 5), V(nan, 3, 0)}) {
    EXPECT_THROW(wrapCylinder(1.0, Side::clockwise, inside, outside), std::domain_error);
    EXPECT_THROW(wrapCylinder(1.0, Side::clockwise, outside, inside), std::domain_error);
    EXPECT_THROW(wrapCylinderToSecondOrder(1.0, Side::clockwise, outside, inside),
                 std::domain_error);
  }
  EXPECT_THROW(wrapCylinder(nan, Side::clockwise, outside, V(0, 2, 0)), std::domain_error);
}

}  // namespace
}  // namespace bio
