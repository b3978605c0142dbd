#include "bio/path/surface/geodesic.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/finite_difference.h"
#include "support/integrated_geodesic.h"
#include "support/random_chains.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using Eigen::Vector3d;
using support::RandomChains;

template <class S>
SurfaceFrame randomFrame(const S& surface, RandomChains& random, Vector3d& x) {
  x = ontoSurface(surface, surface.size() * random.direction());
  return surfaceFrame(surface, x, random.direction());
}

// Derivatives of g against differences of those below; in the surface's own numbers, too.
template <class S, class WithNumber>
void expectConsistentDerivatives(const S& surface, const WithNumber& with) {
  RandomChains random(3);
  for (int trial = 0; trial < 50; ++trial) {
    Vector3d x;
    const SurfaceFrame frame = randomFrame(surface, random, x);
    const Vector3d w = random.direction();
    const double h = 1e-4 * surface.size();
    const auto along = [&](const auto& f) { return support::centralDifference(f, 0.0, h); };
    const double scale = surface.gradient(x).norm();
    EXPECT_NEAR(surface.gradient(x).dot(w),
                along([&](double t) { return surface.value(x + t * w); }), 1e-9 * scale);
    EXPECT_NEAR(surface.hessianTimes(x, frame.u).dot(w),
                along([&](double t) { return surface.gradient(x + t * w).dot(frame.u); }),
                1e-8 * scale / surface.size());
    const auto bend = [&](double t) {
      return surface.hessianTimes(x + t * w, frame.u).dot(frame.u);
    };
    EXPECT_NEAR(surface.thirdTwice(x, frame.u).dot(w), along(bend),
                1e-7 * scale / surface.size() / surface.size());
    for (int i = 0; i < S::numNumbers; ++i) {
      const NumberDerivative d = surface.ofNumber(x, i);
      EXPECT_NEAR(d.value, along([&](double t) { return with(i, t).value(x); }), 1e-9 * scale);
      EXPECT_NEAR(d.gradient.dot(w), along([&](double t) { return with(i, t).gradient(x).dot(w); }),
                  1e-8 * scale / surface.size());
    }
  }
}

TEST(SurfaceDerivatives, OfAnEllipsoidAreConsistent) {
  const Vector3d axes(0.02, 0.035, 0.06);
  expectConsistentDerivatives(EllipsoidSurface(axes), [&](int i, double t) {
    return EllipsoidSurface(axes + t * Vector3d::Unit(i));
  });
}

TEST(SurfaceDerivatives, OfATorusAreConsistent) {
  expectConsistentDerivatives(TorusSurface(0.05, 0.02), [&](int i, double t) {
    return TorusSurface(0.05 + (i == 0 ? t : 0), 0.02 + (i == 1 ? t : 0));
  });
}

TEST(SurfaceDerivatives, OfSphereAndCylinderAreConsistent) {
  expectConsistentDerivatives(SphereSurface(0.03),
                              [](int, double t) { return SphereSurface(0.03 + t); });
  expectConsistentDerivatives(CylinderSurface(0.03),
                              [](int, double t) { return CylinderSurface(0.03 + t); });
}

TEST(SurfaceFrames, BendLikeTheSphere) {
  const SphereSurface sphere(0.04);
  const SurfaceFrame frame = surfaceFrame(sphere, Vector3d(0, 0, 0.04), Vector3d(1, 2, 3));
  EXPECT_NEAR(frame.normal, -25, 1e-12);
  EXPECT_NEAR(frame.sideways, -25, 1e-12);
  EXPECT_NEAR(frame.twist, 0, 1e-12);
  EXPECT_NEAR((frame.n - Vector3d::UnitZ()).norm(), 0, 1e-15);
}

// Ways by conserved quantities and by nothing but derivatives agree. (Over a torus at twice this
// length, seven radians of tube, the difference has grown to 2e-12 m.)
template <class S>
void expectTwoWaysAgree(const S& surface, unsigned seed) {
  RandomChains random(seed);
  for (int trial = 0; trial < 200; ++trial) {
    Vector3d x;
    const SurfaceFrame frame = randomFrame(surface, random, x);
    const double s = random.between(-1, 1) * surface.size();
    const GeodesicPoint a = shootGeodesic(surface, x, frame.u, s);
    const GeodesicPoint b = shootByDerivatives(surface, x, frame.u, s);
    EXPECT_NEAR((a.x - b.x).norm(), 0, 5e-12 * surface.size());
    EXPECT_NEAR((a.u - b.u).norm(), 0, 2e-11);
    EXPECT_NEAR(a.a, b.a, 2e-11 * (1 + std::abs(a.a)));
    EXPECT_NEAR(a.r, b.r, 2e-11 * surface.size() * (1 + std::abs(a.a)));
  }
}

TEST(Geodesics, OfConservedQuantitiesAreThoseOfTheDerivativesAlone) {
  expectTwoWaysAgree(EllipsoidSurface({0.03, 0.04, 0.05}), 4);
  expectTwoWaysAgree(EllipsoidSurface({0.05, 0.02, 0.013}), 5);
  expectTwoWaysAgree(TorusSurface(0.05, 0.02), 6);
  expectTwoWaysAgree(SphereSurface(0.03), 7);
  expectTwoWaysAgree(CylinderSurface(0.03), 8);
}

// The bound is the Runge–Kutta rule's; measured 2e-12.
TEST(Geodesics, ArriveWhereARungeKuttaRuleArrives) {
  RandomChains random(9);
  for (int trial = 0; trial < 100; ++trial) {
    const EllipsoidSurface ellipsoid = random.ellipsoid();
    Vector3d x;
    SurfaceFrame frame = randomFrame(ellipsoid, random, x);
    const double s = random.between(0, 2) * ellipsoid.size();
    support::WalkedPoint walked =
        support::walkEllipsoid(ellipsoid.semiAxes(), {x, frame.u}, s, 20000);
    GeodesicPoint p = shootGeodesic(ellipsoid, x, frame.u, s);
    EXPECT_NEAR((p.x - walked.x).norm(), 0, 1e-11 * ellipsoid.size());
    EXPECT_NEAR((p.u - walked.u).norm(), 0, 1e-10);

    const TorusSurface torus(random.between(0.03, 0.06), random.between(0.005, 0.025));
    frame = randomFrame(torus, random, x);
    walked = support::walkTorus(torus.ringRadius(), torus.tubeRadius(), {x, frame.u}, s, 2000);
    p = shootGeodesic(torus, x, frame.u, s);
    EXPECT_NEAR((p.x - walked.x).norm(), 0, 1e-10 * torus.size());
    EXPECT_NEAR((p.u - walked.u).norm(), 0, 1e-9);
  }
}

TEST(Geodesics, StayOnTheSurfaceAtUnitSpeedAndKeepWronskisDeterminant) {
  RandomChains random(10);
  for (int trial = 0; trial < 200; ++trial) {
    const EllipsoidSurface ellipsoid = random.ellipsoid();
    Vector3d x;
    const SurfaceFrame frame = randomFrame(ellipsoid, random, x);
    const GeodesicPoint p =
        shootGeodesic(ellipsoid, x, frame.u, random.between(-2, 2) * ellipsoid.size());
    EXPECT_NEAR(ellipsoid.value(p.x), 0, 1e-11);
    EXPECT_NEAR(p.u.norm(), 1, 1e-11);
    const double size = std::abs(p.a * p.rSlope) + std::abs(p.aSlope * p.r);
    EXPECT_NEAR(p.a * p.rSlope - p.aSlope * p.r, 1, 1e-10 * (1 + size));
  }
}

// Neighbours by differences: a from a start moved sideways in parallel, r from one turned.
TEST(Geodesics, HaveTheirNeighboursWhereJacobisFieldsSay) {
  RandomChains random(11);
  const EllipsoidSurface surface({0.03, 0.04, 0.055});
  for (int trial = 0; trial < 50; ++trial) {
    Vector3d x;
    const SurfaceFrame frame = randomFrame(surface, random, x);
    const double s = random.between(0, 1.5) * surface.size();
    const GeodesicPoint p = shootGeodesic(surface, x, frame.u, s);
    const SurfaceFrame end = surfaceFrame(surface, p.x, p.u);
    const auto turned = [&](double angle) {
      const Vector3d u = std::cos(angle) * frame.u + std::sin(angle) * frame.b;
      return shootGeodesic(surface, x, u, s).x.dot(end.b);
    };
    EXPECT_NEAR(p.r, support::centralDifference(turned, 0.0, 1e-3), 1e-9);
    const auto moved = [&](double shift) {
      const GeodesicPoint beside = shootGeodesic(surface, x, frame.b, shift);
      const Vector3d n = surfaceFrame(surface, beside.x, beside.u).n;
      return shootGeodesic(surface, beside.x, beside.u.cross(n), s).x.dot(end.b);
    };
    EXPECT_NEAR(p.a, support::centralDifference(moved, 0.0, 3e-5), 1e-7);
  }
}

TEST(Geodesics, AreNotFiniteWhereTooManyStepsWouldBeNeeded) {
  const EllipsoidSurface surface({0.03, 0.04, 0.05});
  const SurfaceFrame frame = surfaceFrame(surface, Vector3d(0.03, 0, 0), Vector3d(0, 1, 1));
  EXPECT_FALSE(shootGeodesic(surface, Vector3d(0.03, 0, 0), frame.u, 1e3).x.allFinite());
}

TEST(Surfaces, RefuseNumbersThatMakeNone) {
  const double nan = std::nan("");
  support::throwsSaying([] { SphereSurface(0); }, "radius is 0 m, must be > 0");
  support::throwsSaying([&] { CylinderSurface c(nan); }, "radius is nan m, must be > 0");
  support::throwsSaying([] { EllipsoidSurface({0.1, -1, 0.1}); }, "semi-axis is -1 m, must be > 0");
  support::throwsSaying([] { TorusSurface(0.01, 0.02); }, "must be > its tube radius");
  support::throwsSaying([&] { TorusSurface(nan, 0.02); }, "must be > its tube radius");
}

TEST(Surfaces, TellInsideFromOutside) {
  const Surface torus = TorusSurface(0.05, 0.01);
  EXPECT_FALSE(isInside(torus, Vector3d(0.0, 0.001, 0)));  // in the hole
  EXPECT_TRUE(isInside(torus, Vector3d(0.0, 0.055, 0.005)));
  EXPECT_FALSE(isInside(torus, Vector3d(0.0, 0.0601, 0)));
  const Surface ellipsoid = EllipsoidSurface({0.01, 0.02, 0.03});
  EXPECT_TRUE(isInside(ellipsoid, Vector3d::Zero()));
  EXPECT_TRUE(isInside(ellipsoid, Vector3d(0, 0, 0.03)));
  EXPECT_FALSE(isInside(ellipsoid, Vector3d(0, 0, 0.0301)));
}

}  // namespace
}  // namespace bio
