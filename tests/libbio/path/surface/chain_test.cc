#include "bio/path/surface/chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bio/path/surface/chain_change.h"
#include "bio/path/surface/way.h"
#include "bio/path/surface/wrap_cylinder.h"
#include "bio/path/surface/wrap_rule.h"
#include "bio/path/surface/wrap_sphere.h"
#include "support/allocations.h"
#include "support/integrated_geodesic.h"
#include "support/random_chains.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using support::RandomChain;
using support::RandomChains;

ChainPath solveAfresh(const Vector3d& P, const Vector3d& Q,
                      const std::vector<ChainObject>& objects) {
  ChainMemory memory;
  return solveChain(P, Q, objects, memory);
}

ChainPath solveLone(const Surface& surface, const Vector3d& hint, const Vector3d& P,
                    const Vector3d& Q) {
  ChainObject object{surface};
  object.hint = hint;
  return solveAfresh(P, Q, {object});
}

// Walked again by another integrator in other coordinates; the bound asked for is 1e-9 of the
// length, measured 2e-10, which is the walk's. All 10^6: validation/geodesics.
TEST(Chain, IsWalkedAgainByTheGeodesicEquations) {
  for (int kind = 0; kind < 4; ++kind) {
    RandomChains random(static_cast<unsigned>(40 + kind));
    int walks = 0;
    for (int i = 0; i < 400; ++i) {
      const RandomChain chain = random.ofKind(kind);
      const ChainPath path = solveAfresh(chain.P, chain.Q, chain.objects);
      ASSERT_EQ(path.event, ChainEvent::none);
      if (path.numContacts == 0) continue;
      ++walks;
      double walked = 0, miss = 0;
      for (const int steps : {300, 2400}) {
        miss = support::missOf(chain.Q, chain.objects, path, steps, walked);
        if (miss < 2e-10 * path.length) break;
      }
      EXPECT_LT(miss, 1e-9 * path.length);
      EXPECT_NEAR(walked, path.length, 1e-9 * path.length);
    }
    EXPECT_GT(walks, 200);
  }
}

TEST(Chain, OfALoneSphereOrEqualAxesIsTheClosedForm) {
  RandomChains random(50);
  for (int trial = 0; trial < 200; ++trial) {
    const double radius = random.between(0.02, 0.04);
    const Vector3d P = radius * random.between(1.1, 4) * random.direction();
    const Vector3d Q = radius * random.between(1.1, 4) * random.direction();
    if (P.cross(Q).norm() < 1e-3 * P.norm() * Q.norm()) continue;
    const Span<double> expected = wrapSphere(radius, Way::shorter, P, Q);
    for (const Surface& surface :
         {Surface(SphereSurface(radius)), Surface(EllipsoidSurface(Vector3d::Constant(radius)))}) {
      const ChainPath path = solveLone(surface, hintOfShortest(surface, P, Q), P, Q);
      EXPECT_EQ(path.numContacts > 0, expected.touches);
      EXPECT_NEAR(path.length, expected.length, 1e-12);
      EXPECT_LT((path.tangentP() + expected.dL_dP).norm(), 1e-10);
      EXPECT_LT((path.tangentQ() - expected.dL_dQ).norm(), 1e-10);
    }
  }
}

TEST(Chain, OfALoneCylinderOrVeryLongEllipsoidIsTheClosedForm) {
  RandomChains random(51);
  int wrapped = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const double r = random.between(0.01, 0.03);
    const auto end = [&](double turn) {
      const double rho = r * random.between(1.1, 4);
      return Vector3d(rho * std::cos(turn), rho * std::sin(turn), random.between(-0.1, 0.1));
    };
    const Vector3d P = end(0), Q = end(random.between(0.5, 5));
    const Vector3d middle(std::cos(2.5), std::sin(2.5), 0);
    for (const Side side : {Side::counterclockwise, Side::clockwise}) {
      const double turn = angleRound(side, P, Q);
      if (turn > 3) continue;  // what a hint leads to needs no memory
      const Span<double> expected = wrapCylinder(r, side, P, Q);
      const double way = (side == Side::counterclockwise ? 0.5 : -0.5) * turn;
      const Vector3d hint(r * std::cos(way), r * std::sin(way), (P[2] + Q[2]) / 2);
      for (const Surface& surface :
           {Surface(CylinderSurface(r)), Surface(EllipsoidSurface({r, r, 2e5}))}) {
        const ChainPath path = solveLone(surface, hint, P, Q);
        ASSERT_EQ(path.event, ChainEvent::none);
        EXPECT_NEAR(path.length, expected.length, 1e-12);
        EXPECT_LT((path.tangentP() + expected.dL_dP).norm(), 1e-10);
        wrapped += path.numContacts;
      }
    }
  }
  EXPECT_GT(wrapped, 100);
}

// In a plane of symmetry the path is that round a circle.
TEST(Chain, InAPlaneOfSymmetryIsTheCircles) {
  const double ring = 0.05, tube = 0.02, a = 0.03;
  const Vector3d P(0.04, 0, 0.06), Q(0.045, 0, -0.05);
  const ChainPath torus = solveLone(TorusSurface(ring, tube), {ring - tube, 0, 0}, P, Q);
  const auto intoPlane = [&](const Vector3d& p) { return Vector3d(p[0] - ring, p[2], 0); };
  const Span<double> circle =
      wrapCylinder(tube, Side::counterclockwise, intoPlane(P), intoPlane(Q));
  ASSERT_TRUE(circle.touches);
  EXPECT_NEAR(torus.length, circle.length, 1e-12);

  const Vector3d p(-0.06, 0.01, 0), q(0.05, 0.02, 0);
  for (const double c : {0.035, 0.06}) {  // a longer third axis holds the path in the plane
    const ChainPath path = solveLone(EllipsoidSurface({a, a, c}), {0, a, 0}, p, q);
    EXPECT_NEAR(path.length, wrapCylinder(a, Side::clockwise, p, q).length, 1e-12);
  }
}

// The ends' distance is swept through lift-off: the length's slope is its gradient throughout.
TEST(Chain, IsOnceContinuouslyDifferentiableThroughLiftOff) {
  RandomChains random(52);
  int lifted = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const RandomChain chain = random.ofKind(trial % 4);
    ChainMemory memory;
    ChainPath before = solveChain(chain.P, chain.Q, chain.objects, memory);
    if (before.numContacts == 0) continue;
    // away from the first object, on the side where the path touches it
    const Vector3d way = before.contacts[0].atA.n;
    constexpr double h = 5e-5;
    for (int i = 1; i <= 2000; ++i) {
      const ChainPath after =
          solveChain(chain.P + i * h * way, chain.Q + i * h * way, chain.objects, memory);
      // what jumps is told: a way that has ended, an end that is inside
      if (after.event != ChainEvent::none || after.passing[0] == Passing::endInside) break;
      const auto slope = [&](const ChainPath& p) {
        const ChainScrews g = chainGradient(p);
        return way.dot(g.P + g.Q);
      };
      // second derivatives are below 1/(5 mm) here: a corner would be of the order of h
      EXPECT_NEAR(after.length - before.length, 0.5 * h * (slope(before) + slope(after)),
                  400 * h * h);
      EXPECT_LT((after.tangentP() - before.tangentP()).norm(), 600 * h);
      if (after.numContacts < before.numContacts) ++lifted;
      before = after;
    }
  }
  EXPECT_GT(lifted, 10);
}

// Down again: a path that has lifted off touches where it left, and is the one that never left.
TEST(Chain, TouchesDownWhereItLiftedOff) {
  const Surface surface = EllipsoidSurface({0.02, 0.03, 0.045});
  ChainObject object{surface};
  object.hint = {0, 0.03, 0};
  ChainMemory memory;
  const auto at = [&](double y) {
    return solveChain({-0.08, y, 0.01}, {0.07, y, 0.02}, {&object, 1}, memory);
  };
  const double first = at(0.01).length;
  bool wasClear = false;
  for (double y = 0.01; y < 0.06; y += 5e-4) wasClear |= at(y).numContacts == 0;
  for (double y = 0.06; y > 0.01; y -= 5e-4) at(y);
  EXPECT_TRUE(wasClear);
  EXPECT_NEAR(at(0.01).length, first, 1e-13);
}

// Exact Newton steps: after a move of 1 mm, three or so; measured 3.1 on average, 6 at most.
TEST(Chain, FollowsASmallMoveInAFewSteps) {
  for (int kind = 0; kind < 4; ++kind) {
    RandomChains random(static_cast<unsigned>(60 + kind));
    int calls = 0, iterations = 0, most = 0;
    for (int trial = 0; trial < 60; ++trial) {
      const RandomChain chain = random.ofKind(kind);
      const Vector3d way = 1e-3 * random.direction();
      ChainMemory memory;
      ChainPath before = solveChain(chain.P, chain.Q, chain.objects, memory);
      for (int i = 1; i <= 5; ++i) {
        const ChainPath path =
            solveChain(chain.P + i * way, chain.Q - i * way, chain.objects, memory);
        if (path.event == ChainEvent::none && path.numContacts == before.numContacts &&
            path.numContacts > 0 && path.contacts[0].arc > 3e-3) {
          ++calls;
          iterations += path.iterations;
          most = std::max(most, path.iterations);
        }
        before = path;
      }
    }
    EXPECT_GT(calls, 100);
    EXPECT_LT(iterations, 3.5 * calls);
    EXPECT_LE(most, 8);
  }
}

TEST(Chain, KeepsTheShorterOfTheWaysRound) {
  RandomChains random(53);
  for (int trial = 0; trial < 100; ++trial) {
    const RandomChain chain = random.ellipsoids(1);
    const ChainObject& o = chain.objects[0];
    const Vector3d P = o.R_GS.transpose() * (chain.P - o.p_GS);
    const Vector3d Q = o.R_GS.transpose() * (chain.Q - o.p_GS);
    const double shortest = solveLone(o.surface, hintOfShortest(o.surface, P, Q), P, Q).length;
    for (int side = 0; side < 12; ++side) {
      const ChainPath path =
          solveLone(o.surface, hintTowards(o.surface, random.direction(), P, Q), P, Q);
      EXPECT_GE(path.length, shortest - 1e-12);
    }
  }
}

TEST(Chain, PassesOnTheNamedSide) {
  const Surface surface = EllipsoidSurface({0.02, 0.03, 0.05});
  const Vector3d P(-0.08, 0.004, 0.003), Q(0.07, -0.002, 0.005);
  for (const Vector3d& side : {Vector3d(0, 1, 0), Vector3d(0, -1, 0), Vector3d(0, 2, 1)}) {
    const ChainPath path = solveLone(surface, hintTowards(surface, side, P, Q), P, Q);
    ASSERT_EQ(path.numContacts, 1);
    EXPECT_GT((path.contacts[0].A + path.contacts[0].B).dot(side), 0.02);
  }
  support::throwsSaying([&] { hintTowards(surface, Vector3d::Zero(), P, Q); },
                        "must be a direction");
}

TEST(Chain, IsTheSameBackwardsAndFromAnotherFrame) {
  RandomChains random(54);
  for (int trial = 0; trial < 40; ++trial) {
    RandomChain chain = random.ofKind(trial % 4);
    const ChainPath path = solveAfresh(chain.P, chain.Q, chain.objects);
    const std::vector<ChainObject> reversed(chain.objects.rbegin(), chain.objects.rend());
    const ChainPath back = solveAfresh(chain.Q, chain.P, reversed);
    EXPECT_NEAR(back.length, path.length, 1e-12);
    EXPECT_LT((back.tangentP() + path.tangentQ()).norm(), 1e-9);
    const Matrix3d R = random.rotation();
    const Vector3d p = random.direction();
    for (ChainObject& o : chain.objects) {
      o.R_GS = R * o.R_GS;
      o.p_GS = R * o.p_GS + p;
    }
    const ChainPath turned = solveAfresh(R * chain.P + p, R * chain.Q + p, chain.objects);
    EXPECT_NEAR(turned.length, path.length, 1e-12);
    EXPECT_LT((turned.tangentP() - R * path.tangentP()).norm(), 1e-9);
  }
}

TEST(Chain, TellsAnEndInsideAndLeavesTheObjectOut) {
  ChainObject inside{Surface(EllipsoidSurface({0.02, 0.03, 0.025}))};
  ChainObject other{Surface(SphereSurface(0.02))};
  other.p_GS = {0.1, 0.01, 0};
  other.hint = {0, -0.02, 0};
  const Vector3d P(0.01, 0, 0), Q(0.2, 0, 0);
  const ChainPath path = solveAfresh(P, Q, {inside, other});
  EXPECT_EQ(path.passing[0], Passing::endInside);
  EXPECT_EQ(path.passing[1], Passing::touching);
  EXPECT_NEAR(path.length, solveAfresh(P, Q, {other}).length, 1e-15);
}

TEST(Chain, TellsATorusThatIsCutAgainWhichThenStandsTwice) {
  ChainObject torus{Surface(TorusSurface(0.05, 0.016))};
  const Vector3d P(0.13, 0.0, 0.03), Q(-0.12, 0.01, -0.03);
  torus.hint = {0.05, 0, 0.016};
  const ChainPath once = solveAfresh(P, Q, {torus});
  EXPECT_EQ(once.event, ChainEvent::cutsAgain);
  ChainObject again = torus;
  again.hint = {-0.05, 0, -0.016};
  const ChainPath twice = solveAfresh(P, Q, {torus, again});
  EXPECT_EQ(twice.event, ChainEvent::none);
  EXPECT_EQ(twice.numContacts, 2);
  EXPECT_GT(twice.length, once.length);
}

TEST(Chain, TellsWhenARememberedWayHasEnded) {
  ChainObject object{Surface(EllipsoidSurface({0.02, 0.03, 0.045}))};
  object.hint = {0, 0.03, 0};
  ChainMemory memory;
  solveChain({-0.08, 0.01, 0.01}, {0.07, 0.005, 0.02}, {&object, 1}, memory);
  memory.contacts[0].p_SA = {0, 0, -0.045};  // as after a leap that no memory survives
  memory.contacts[0].u_SA = {0, -1, 0};
  memory.contacts[0].arc = 0.3;
  const ChainPath path = solveChain({-0.08, 0.01, 0.01}, {0.07, 0.005, 0.02}, {&object, 1}, memory);
  EXPECT_EQ(path.event, ChainEvent::jumped);
  EXPECT_TRUE(memory.known);
}

TEST(Chain, RefusesMoreObjectsThanItHasRoomFor) {
  const std::vector<ChainObject> five(5, ChainObject{Surface(SphereSurface(0.01))});
  support::throwsSaying(
      [&] {
        solveAfresh({-1, 0, 0}, {1, 0, 0}, five);
      },
      "passes 5 surfaces, must be <= 4");
}

TEST(Chain, AllocatesNothing) {
  RandomChains random(55);
  const RandomChain chain = random.ellipsoids(3);
  const RandomChain torus = random.torus();
  const long before = support::allocations();
  double sum = 0;
  for (const RandomChain* c : {&chain, &torus}) {
    ChainMemory memory;  // cold, too
    const ChainPath path = solveChain(c->P, c->Q, c->objects, memory);
    const ChainChanges changes(path);
    ChainScrews motion;
    motion.P = Vector3d::UnitX();
    sum += path.length + changes.gradientChange(motion).P[0] + changes.ends().QQ(0, 0);
    for (int i = 0; i < path.numContacts; ++i) {
      const ChainContact& contact = path.contacts[static_cast<std::size_t>(i)];
      const auto j = static_cast<std::size_t>(contact.object);
      sum += contactNumbers(c->objects[j], contact)[0].length;
    }
  }
  EXPECT_EQ(support::allocations(), before);
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace
}  // namespace bio
