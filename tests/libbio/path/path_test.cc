#include "bio/path/path.h"
#include "bio/path/path_length.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "libbio/path/arm_paths.h"
#include "support/finite_difference.h"

namespace bio {
namespace {

using std::numbers::pi;
using namespace fixtures;

// The same point moved by hand: a hinge, Rodrigues' formula.
TEST(MusclePath, IsTheSumOfItsStraightSpans) {
  ArmPath<1> s(system(), extensor());
  const V axis = V(0.05, 0.04, 1).normalized();
  for (const double angle : {0.0, 0.7, 1.9}) {
    const V P = V(-0.017, -0.267, -0.012);
    const V Q = V(0.006, -0.29, -0.012) + Eigen::AngleAxisd(angle, axis) * V(-0.022, 0.010, -0.001);
    const double fixed = (P - V(-0.006, -0.126, 0.004)).norm();
    const LengthJet<1> jet = s.at(ArmPath<1>::Q(angle));
    EXPECT_NEAR(jet.length, fixed + (Q - P).norm(), 1e-15);
    EXPECT_FALSE(jet.wrapped);
    // moment arm: unit tangent · (axis × arm)
    const V system = Q - V(0.006, -0.29, -0.012);
    EXPECT_NEAR(jet.dL_dq[0], (Q - P).normalized().dot(axis.cross(system)), 1e-15);
  }
}

TEST(MusclePath, DerivativesAgreeWithDifferences) {
  const Model model = system();
  int contact = 0;
  for (const std::vector<std::string>& wraps : {std::vector<std::string>{},
                                                {"cylinder"},
                                                {"sphere"},
                                                {"moved"},
                                                {"moved", "cylinder"},
                                                {"ellipsoid"},
                                                {"odd"},
                                                {"moved", "odd"}}) {
    for (const Muscle& m : {extensor(wraps), flexor(wraps)}) {
      ArmPath<1> one(model, m);
      ArmPath<2> two(model, m);
      ArmPath<3> three(model, m);
      for (const double angle : {0.05, 0.6, 1.1, 1.7, 2.2}) {
        contact += one.at(ArmPath<1>::Q(angle)).wrapped ? 1 : 0;
        one.expectDerivatives(ArmPath<1>::Q(angle));
        two.expectDerivatives({angle, 0.4});
        three.expectDerivatives({0.3, angle, 0.8});
      }
    }
  }
  EXPECT_GT(contact, 10);
}

TEST(MusclePath, WithoutMovingSpansHasConstantLength) {
  const Model model = system();
  ArmPath<1> s(model, muscle({point("humerus", {0, 0, 0}), point("humerus", {0, -0.1, 0}),
                              point("ground", {0, 0.3, 0})}));
  EXPECT_FALSE(s.path.moves());
  EXPECT_EQ(s.at(ArmPath<1>::Q(0.3)).length, s.at(ArmPath<1>::Q(1.3)).length);
  EXPECT_EQ(s.at(ArmPath<1>::Q(0.3)).dL_dq[0], 0);
  ArmPath<3> all(model, muscle({point("humerus", {0, 0, 0}), point("ground", {0, 0.3, 0})}));
  EXPECT_TRUE(all.path.moves());
}

// A surface on spans that do not move is part of the constant length.
TEST(MusclePath, WrapsFixedSpansOnce) {
  const Model model = system();
  const Muscle m =
      muscle({point("humerus", {-0.02, -0.25, -0.012}), point("humerus", {0.03, -0.33, -0.012}),
              point("radius", {0.004, -0.2, -0.01})},
             {"cylinder"});
  ArmPath<1> s(model, m);
  const ArmPath<1>::Q q(1.0);
  const std::vector<V> line = s.points(q, 0.001);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) sum += (line[i + 1] - line[i]).norm();
  EXPECT_GT(line.size(), 100u);
  EXPECT_NEAR(s.at(q).length, sum, 1e-8);
  EXPECT_FALSE(s.at(q).wrapped);  // no moving span touches
}

TEST(MusclePath, PathPointsLieOnTheSurfaceAndSumToTheLength) {
  const Model model = system();
  for (const char* wrap : {"cylinder", "sphere", "moved"}) {
    for (const Muscle& m : {extensor({wrap}), flexor({wrap})}) {
      ArmPath<1> s(model, m);
      for (double angle = 0; angle < 2.2; angle += 0.2) {
        const ArmPath<1>::Q q(angle);
        const LengthJet<1> jet = s.at(q);
        const std::vector<V> line = s.points(q, 1e-3);
        double sum = 0;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) sum += (line[i + 1] - line[i]).norm();
        EXPECT_NEAR(sum, jet.length, 1e-8);
        EXPECT_EQ(line.size() > 3, jet.wrapped);
        if (!jet.wrapped) continue;
        // in the surface's frame the inner points are one radius away
        const WrapObject& object = findWrapObject(model, wrap);
        std::vector<RigidMotion<double, 1>> moved(s.skeleton.numSegments());
        s.skeleton.motions<double, 1>(q, moved.data());
        const BodyPlacement& place = s.skeleton.placeOf(object.body);
        const Placement<double> X_GB = moved[place.segment].value * place.X_SB;
        const V& o = object.frame.orientation;
        const Mat3<double> R =
            (Eigen::AngleAxisd(o.x(), V::UnitX()) * Eigen::AngleAxisd(o.y(), V::UnitY()) *
             Eigen::AngleAxisd(o.z(), V::UnitZ()))
                .toRotationMatrix();
        int onSurface = 0;
        for (const V& p_G : line) {
          V p = R.transpose() * (X_GB.R.transpose() * (p_G - X_GB.p) - object.frame.translation);
          if (object.shape == WrapShape::cylinder) p.z() = 0;
          onSurface += std::abs(p.norm() - object.radius) < 1e-12 ? 1 : 0;
        }
        EXPECT_EQ(onSurface, static_cast<int>(line.size()) - 3);
      }
    }
  }
}

TEST(MusclePath, ConditionalPointsActInTheirRange) {
  const Model model = system();
  Muscle m = flexor();
  PathPoint guide = point("humerus", {0.03, -0.25, -0.01});
  guide.condition = PointCondition{"flexion", 0.5, 1.0};
  m.path.points.insert(m.path.points.begin() + 2, guide);
  ArmPath<1> with(model, m), without(model, flexor());
  Muscle always = m;
  always.path.points[2].condition.reset();
  ArmPath<1> through(model, always);
  for (const double angle : {0.3, 0.4998, 1.0002, 1.8}) {
    EXPECT_EQ(with.at(ArmPath<1>::Q(angle)).length, without.at(ArmPath<1>::Q(angle)).length)
        << angle;
  }
  for (const double angle : {0.499995, 0.7, 1.000005}) {  // OpenSim's tolerance of 1e-5
    EXPECT_EQ(with.at(ArmPath<1>::Q(angle)).length, through.at(ArmPath<1>::Q(angle)).length)
        << angle;
  }
  EXPECT_EQ(with.points(ArmPath<1>::Q(0.7)).size(), 4u);
  EXPECT_EQ(with.points(ArmPath<1>::Q(0.2)).size(), 3u);
  // a condition on a locked coordinate is settled when the path is compiled
  m.path.points[2].condition = PointCondition{"rotation", -0.1, 0.1};
  ArmPath<1> locked(model, m);
  EXPECT_EQ(locked.at(ArmPath<1>::Q(0.7)).length, through.at(ArmPath<1>::Q(0.7)).length);
}

// A guide that lifts the path off an ellipsoid wherever it could be touched makes it harmless.
TEST(MusclePath, LooksAtSpansOnlyWhereTheirPointsAreActive) {
  const Model model = system();
  Muscle m = extensor({"odd"});
  EXPECT_EQ(ArmPath<1>(model, m).path.compiled().chains.size(), 1u);
  PathPoint guide = point("humerus", {-0.05, -0.345, -0.012});
  guide.condition = PointCondition{"flexion", 0.3, 3.0};
  m.path.points.insert(m.path.points.begin() + 2, guide);
  EXPECT_TRUE(ArmPath<1>(model, m).path.compiled().chains.empty());
}

// Of two cylinders about one axis the wider holds the path.
TEST(MusclePath, SolvesSeveralObjectsOnASpanTogether) {
  Model model = system();
  WrapObject second = model.wrapObjects[0];
  second.name = "second";
  second.radius = 0.018;
  model.wrapObjects.push_back(second);
  Muscle m = extensor({"cylinder", "second"});
  for (std::size_t i = 0; i < 3; ++i) m.path.points[i].name = "P" + std::to_string(i + 1);
  ArmPath<1> both(model, m), wider(model, extensor({"second"})), one(model, extensor({"cylinder"}));
  EXPECT_TRUE(both.path.warnings().empty());
  EXPECT_EQ(both.path.compiled().chains.size(), 1u);
  EXPECT_TRUE(one.path.compiled().chains.empty());
  for (const double angle : {0.6, 1.1, 1.7}) {
    const ArmPath<1>::Q q(angle);
    EXPECT_NEAR(both.at(q).length, wider.at(q).length, 1e-12);
    EXPECT_NEAR(both.at(q).dL_dq[0], wider.at(q).dL_dq[0], 1e-11);
  }
}

TEST(MusclePath, MovingPointsFollowTheirFunctions) {
  const Model model = system();
  Muscle m = flexor();
  PointMotion motion;
  motion.coordinate = {"rotation", "flexion", ""};
  motion.location = {
      Function{1, SplineFunction{{-1.6, 0, 0.5, 1, 1.6}, {-0.005, 0.002, 0.004, 0.003, 0.01}}},
      Function{1, PolynomialFunction{{0.004, -0.04}}}, Function{1, ConstantFunction{-0.012}}};
  m.path.points.back().motion = motion;
  ArmPath<2> two(model, m);
  ArmPath<3> three(model, m);
  for (const double angle : {0.2, 1.2, 2.0}) {
    two.expectDerivatives({angle, 0.3});
    three.expectDerivatives({0.2, angle, 0.7});
  }
  // where the functions are at one configuration, so is the point
  Muscle still = flexor();
  still.path.points.back().location = {FunctionEvaluator(motion.location[0]).evaluate(0.3).value,
                                       -0.04 + 0.004 * 1.2, -0.012};
  ArmPath<2> fixed(model, still);
  EXPECT_NEAR(two.at({1.2, 0.3}).length, fixed.at({1.2, 0.3}).length, 1e-15);
  // moved by a locked coordinate only: fixed in its body
  m.path.points.back().motion->coordinate[1] = "rotation";
  ArmPath<1> one(model, m);
  one.expectDerivatives(ArmPath<1>::Q(1.1));
}

TEST(MusclePath, LengthFollowsItsParameters) {
  using Dual2 = info::Dual<2>;
  const Model model = system();
  const Muscle m = extensor({"cylinder"});
  ArmPath<1> s(model, m);
  const double angle = 1.6;
  const PathParameters<double>& p = s.path.parameters();
  ASSERT_EQ(p.points.size(), 3u);
  EXPECT_EQ(p.points[2], V(-0.022, 0.010, -0.001));
  EXPECT_EQ(p.radii[0], 0.016);
  std::vector<RigidMotion<double, 1>> moved(s.skeleton.numSegments());
  const ArmPath<1>::Q q(angle);
  s.skeleton.motions<double, 1>(q, moved.data());
  const auto evaluate = [&](double x, double radius) {
    PathParameters<double> changed = p;
    changed.points[2].x() = x;
    changed.radii[0] = radius;
    return s.path.length<double, 1>(changed, q, moved.data());
  };
  const LengthJet<1> plain = s.at(q);
  ASSERT_TRUE(plain.wrapped);
  s.skeleton.motions<double, 1>(q, moved.data());
  EXPECT_NEAR(evaluate(-0.022, 0.016).length, plain.length, 1e-15);
  EXPECT_NEAR(evaluate(-0.022, 0.016).d2L_dq2(0, 0), plain.d2L_dq2(0, 0), 1e-15);

  PathParameters<Dual2> dual;
  for (const V& x : p.points) dual.points.push_back(x.cast<Dual2>());
  dual.radii = {Dual2(0.016, 2, 1)};
  dual.points[2].x() = Dual2(-0.022, 2, 0);
  const Eigen::Matrix<Dual2, 1, 1> qDual(Dual2(angle, Eigen::Vector2d::Zero()));
  std::vector<RigidMotion<Dual2, 1>> movedDual(s.skeleton.numSegments());
  s.skeleton.motions<Dual2, 1>(qDual, movedDual.data());
  const LengthJet<1, Dual2> jet = s.path.length<Dual2, 1>(dual, qDual, movedDual.data());
  const auto expectSame = [&](const Dual2& value,
                              const std::function<double(const LengthJet<1>&)>& pick) {
    const auto overX = [&](double x) { return pick(evaluate(x, 0.016)); };
    const auto overRadius = [&](double r) { return pick(evaluate(-0.022, r)); };
    EXPECT_NEAR(value.derivatives()[0], support::centralDifference(overX, -0.022, 1e-6), 1e-7);
    EXPECT_NEAR(value.derivatives()[1], support::centralDifference(overRadius, 0.016, 1e-6), 1e-7);
  };
  expectSame(jet.length, [](const auto& j) { return j.length; });
  expectSame(jet.dL_dq[0], [](const auto& j) { return j.dL_dq[0]; });
  expectSame(jet.d2L_dq2(0, 0), [](const auto& j) { return j.d2L_dq2(0, 0); });
}

// The way that recomputes everything agrees with the compiled one, for ends fixed in the ground
// too.
TEST(MusclePath, RecomputedFromItsParametersItIsTheSame) {
  const Model model = system();
  for (const char* wrap : {"cylinder", "sphere", "moved"}) {
    Muscle m = flexor({wrap});
    m.path.points.insert(m.path.points.begin(), point("ground", {0.1, 0.6, 0.02}));
    ArmPath<2> s(model, m);
    std::vector<RigidMotion<double, 2>> moved(s.skeleton.numSegments());
    for (const double angle : {0.1, 0.9, 2.0}) {
      const ArmPath<2>::Q q(angle, 0.3);
      const LengthJet<2> compiled = s.at(q);
      s.skeleton.motions<double, 2>(q, moved.data());
      const LengthJet<2> again = s.path.length<double, 2>(s.path.parameters(), q, moved.data());
      EXPECT_NEAR(again.length, compiled.length, 1e-15);
      EXPECT_NEAR((again.dL_dq - compiled.dL_dq).norm(), 0, 1e-15);
      EXPECT_NEAR((again.d2L_dq2 - compiled.d2L_dq2).norm(), 0, 1e-14);
      EXPECT_EQ(again.wrapped, compiled.wrapped);
    }
  }
}

TEST(MusclePath, RangeOfPointsLimitsAWrap) {
  const Model model = system();
  Muscle m = extensor({"cylinder"});
  const ArmPath<1>::Q q(1.8);
  ArmPath<1> whole(model, m);
  EXPECT_TRUE(whole.at(q).wrapped);
  m.path.wraps[0] = {"cylinder", 2, 3};
  EXPECT_TRUE(ArmPath<1>(model, m).at(q).wrapped);
  m.path.wraps[0] = {"cylinder", 1, 2};
  EXPECT_FALSE(ArmPath<1>(model, m).at(q).wrapped);
  Model off = model;
  off.wrapObjects[0].active = false;
  EXPECT_FALSE(ArmPath<1>(off, extensor({"cylinder"})).at(q).wrapped);
}

TEST(MusclePath, AnEllipsoidWithEqualSemiAxesIsASphere) {
  Model model = system();
  model.wrapObjects[4].semiAxes = {0.018, 0.018, 0.018};
  ArmPath<1> ball(model, extensor({"odd"})), sphere(model, extensor({"sphere"}));
  for (const double angle : {0.5, 1.5, 2.0}) {
    EXPECT_EQ(ball.at(ArmPath<1>::Q(angle)).length, sphere.at(ArmPath<1>::Q(angle)).length);
  }
  EXPECT_TRUE(ball.at(ArmPath<1>::Q(2.0)).wrapped);
}

TEST(MusclePath, AnEllipsoidIsACylinderWhereAskedFor) {
  Model model = system();
  ArmPath<1> cylinder(model, extensor({"cylinder"}));
  const ArmPath<1>::Q q(1.8);
  ArmPath<1> asked(model, extensor({"ellipsoid"}), {"ellipsoid"});
  EXPECT_NEAR(asked.at(q).length, cylinder.at(q).length, 1e-16);
  // whichever axis is the odd one: turn the frame so that x or y lies where z was
  for (const int axis : {0, 1}) {
    WrapObject& turned = model.wrapObjects[3];
    turned.semiAxes.setConstant(0.016);
    turned.semiAxes[axis] = 0.05;
    // body-fixed x-y-z angles of R·(cyclic change of axes)
    const V o(-0.14, 0.05, 0.15);
    const Mat3<double> R =
        (Eigen::AngleAxisd(o.x(), V::UnitX()) * Eigen::AngleAxisd(o.y(), V::UnitY()) *
         Eigen::AngleAxisd(o.z(), V::UnitZ()))
            .toRotationMatrix();
    Mat3<double> change = Mat3<double>::Zero();
    for (int k = 0; k < 3; ++k) change(k, (axis + 1 + k) % 3) = 1;  // old axis → where it lies now
    const Mat3<double> T = R * change;
    turned.frame.orientation = {std::atan2(-T(1, 2), T(2, 2)), std::asin(T(0, 2)),
                                std::atan2(-T(0, 1), T(0, 0))};
    turned.quadrant = axis == 0 ? "-y" : "-z";  // both are −x of the cylinder
    ArmPath<1> s(model, extensor({"ellipsoid"}), {"ellipsoid"});
    EXPECT_NEAR(s.at(q).length, cylinder.at(q).length, 1e-15) << axis;
    EXPECT_TRUE(s.at(q).wrapped);
  }
}

TEST(MusclePath, SaysWhatItLeavesOut) {
  const Model model = system();
  ArmPath<1> outOfReach(model, muscle({point("humerus", {-0.017, -0.267, -0.012}),
                                       point("ulna", {-0.022, 0.010, -0.001})},
                                      {"far"}));
  ASSERT_EQ(outOfReach.path.notes().size(), 1u);
  EXPECT_EQ(outOfReach.path.notes()[0], "test: the ellipsoid 'far' is ignored: no span reaches it");
  ArmPath<1> fixed(model, extensor({"far"}));
  EXPECT_EQ(fixed.path.notes()[0], "test: the ellipsoid 'far' is ignored: no span reaches it");
}

TEST(MusclePath, RefusesWhatItCannotSimulate) {
  const Model model = system();
  const auto refuses = [&](const Muscle& m, const std::vector<std::string>& asCylinder,
                           const char* words) {
    try {
      ArmPath<1> s(model, m, asCylinder);
      ADD_FAILURE() << "accepted: " << words;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  refuses(extensor({"odd"}), {"odd"}, "two must be equal");
  refuses(extensor({"nothing"}), {}, "no wrap object called 'nothing'");
  refuses(muscle({point("humerus", {0, 0, 0})}), {}, "at least 2");
  refuses(muscle({point("humerus", {0, 0, 0}), point("foot", {0, 0, 0})}), {},
          "no body called 'foot'");
}

}  // namespace
}  // namespace bio
