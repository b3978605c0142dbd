#include "bio/skeleton/articulated_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "bio/skeleton/tree_motion.h"
#include "second_ways/simbody_tree.h"
#include "support/allocations.h"
#include "support/tree_models.h"

namespace bio {
namespace {

using Vec3d = Eigen::Vector3d;

ArticulatedTree treeOf(const Model& model) {
  return ArticulatedTree(model, {independentCoordinates(model), {}});
}

Eigen::VectorXd drawn(const ArticulatedTree& tree, std::mt19937& random) {
  std::uniform_real_distribution<double> angle(-1.2, 1.2);
  Eigen::VectorXd q(tree.numCoordinates());
  for (double& x : q) x = angle(random);
  return q;
}

void putsPointsWhereSimbodyDoes(const Model& model, int numCoordinates) {
  const ArticulatedTree tree = treeOf(model);
  ASSERT_EQ(tree.numCoordinates(), numCoordinates);
  const SimbodyTree reference(model);
  auto motion = tree.newMotion<double>();
  std::mt19937 random(3);
  for (int trial = 0; trial < 5; ++trial) {
    const Eigen::VectorXd q = drawn(tree, random);
    std::map<std::string, double> values;
    for (int i = 0; i < tree.numCoordinates(); ++i) {
      values[tree.coordinates()[static_cast<std::size_t>(i)].name] = q[i];
    }
    tree.place(q.data(), motion);
    for (const Body& body : model.bodies) {
      const BodyPlacement& place = tree.placeOf(body.name);
      const Placement<double> X = motion.segments[place.segment] * place.X_SB;
      const Vec3d p(0.1, -0.2, 0.05);
      // measured 2e-15
      EXPECT_LT((X.R * p + X.p - reference.pointInGround(values, body.name, p)).norm(), 1e-13)
          << body.name;
    }
  }
}

TEST(ArticulatedTree, PutsPointsOfChainsAndTreesWhereSimbodyDoes) {
  putsPointsWhereSimbodyDoes(fixtures::chainOfSeven(), 7);
  putsPointsWhereSimbodyDoes(fixtures::branchesOfSixteen(), 16);
  putsPointsWhereSimbodyDoes(fixtures::bodyOfThirtySeven(), 37);
}

TEST(ArticulatedTree, ScrewsAreTheDerivativesOfPlacementsAndOfThemselves) {
  const ArticulatedTree tree = treeOf(fixtures::branchesOfSixteen());
  using Dual = info::Dual<1>;
  auto motion = tree.newMotion<double>();
  auto moved = tree.newMotion<Dual>();
  std::mt19937 random(5);
  const Eigen::VectorXd q = drawn(tree, random);
  tree.place(q.data(), motion);
  // along a coordinate, a mobility's screw changes by its own D and by what lies before it
  for (int c = 0; c < tree.numCoordinates(); ++c) {
    std::vector<Dual> qDual(q.data(), q.data() + q.size());
    qDual[static_cast<std::size_t>(c)].derivatives()[0] = 1;
    tree.place(qDual.data(), moved);
    for (std::size_t j = 0; j < tree.mobilities().size(); ++j) {
      using Six = SpatialVector<double>;
      Six S1 = Six::Zero(), D1 = Six::Zero();
      const bool own = tree.mobilities()[j].coordinate == c;
      if (own) S1 += motion.screw1[j];
      if (own) D1 += motion.screw2[j];
      for (int k = tree.mobilities()[j].parent; k >= 0;) {
        const Mobility& before = tree.mobilities()[static_cast<std::size_t>(k)];
        const Six& S_k = motion.screw[static_cast<std::size_t>(k)];
        if (before.coordinate == c) S1 += crossMotion(S_k, motion.screw[j]);
        if (before.coordinate == c) D1 += crossMotion(S_k, motion.screw1[j]);
        k = before.parent;
      }
      for (int i = 0; i < 6; ++i) {
        EXPECT_NEAR(moved.screw[j][i].derivatives()[0], S1[i], 1e-13);   // measured 4e-16
        EXPECT_NEAR(moved.screw1[j][i].derivatives()[0], D1[i], 1e-13);  // measured 7e-16
      }
    }
  }
}

TEST(ArticulatedTree, AMovingPointGoesWhereItsFunctionsSay) {
  const Model model = fixtures::threeLinkArm();
  ArticulatedTree tree(model, {{"lift", "flex"}, {}});
  const SimbodyTree reference(model);
  PointMotion point;
  point.coordinate = {"flex", "", "follow"};
  point.location = {Function{0.1, SplineFunction{{-2, 0, 1, 2}, {0, 1, 3, 2}}},
                    Function{1, ConstantFunction{0.07}}, Function{1, LinearFunction{0.03, 0.01}}};
  const int segment = tree.addMovingPoint("fore", point);
  auto motion = tree.newMotion<double>();
  const Eigen::Vector2d q(0.4, 0.9);
  tree.place(q.data(), motion);
  const double follow = FunctionEvaluator(model.couplers[0].function).evaluate(0.9).value;
  const Vec3d local(FunctionEvaluator(point.location[0]).evaluate(0.9).value, 0.07,
                    0.03 * follow + 0.01);
  const Vec3d expected = reference.pointInGround({{"lift", 0.4}, {"flex", 0.9}}, "fore", local);
  EXPECT_LT((motion.segments[static_cast<std::size_t>(segment)].p - expected).norm(), 1e-14);
  EXPECT_EQ(tree.numMassSegments(), segment);
}

TEST(ArticulatedTree, LockedValuesOverrideDefaultsAndDriveTheirCouplers) {
  const Model model = fixtures::threeLinkArm();
  const ArticulatedTree tree(model, {{"lift"}, {{"flex", 1.0}}});
  const SimbodyTree reference(model);
  auto motion = tree.newMotion<double>();
  const double q = 0.2;
  tree.place(&q, motion);
  for (const char* body : {"fore", "cap", "hand"}) {
    const BodyPlacement& place = tree.placeOf(body);
    const auto X = motion.segments[place.segment] * place.X_SB;
    const std::map<std::string, double> values = {{"lift", 0.2}, {"flex", 1.0}};
    EXPECT_LT((X.p - reference.pointInGround(values, body, Vec3d::Zero())).norm(), 1e-14) << body;
  }
  EXPECT_EQ(tree.sourceOf("follow").freeIndex, -1);
  EXPECT_NEAR(tree.sourceOf("follow").value, 0.8, 1e-15);
  EXPECT_EQ(tree.indexOf("flex"), -1);
  EXPECT_TRUE(tree.hasConstantInertia());
  EXPECT_FALSE(ArticulatedTree(model, {{"turn"}, {}}).hasConstantInertia());  // by a spline
}

TEST(ArticulatedTree, PlacesWithoutAllocation) {
  const ArticulatedTree tree = treeOf(fixtures::bodyOfThirtySeven());
  auto motion = tree.newMotion<double>();
  const Eigen::VectorXd q = tree.defaultValues();
  const long before = support::allocations();
  tree.place(q.data(), motion);
  EXPECT_EQ(support::allocations(), before);
}

std::string messageOf(const Model& model, const SkeletonOptions& options) {
  try {
    ArticulatedTree(model, options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ArticulatedTree, RefusesWhatItCannotMove) {
  using testing::HasSubstr;
  const Model arm = fixtures::threeLinkArm();
  EXPECT_THAT(messageOf(arm, {{}, {}}), HasSubstr("0 free coordinates"));
  EXPECT_THAT(messageOf(arm, {{"lift", "lift"}, {}}), HasSubstr("named free twice"));
  EXPECT_THAT(messageOf(arm, {{"follow"}, {}}), HasSubstr("cannot be free"));
  EXPECT_THAT(messageOf(arm, {{"lift"}, {{"lift", 1}}}), HasSubstr("free and locked"));
  EXPECT_THAT(messageOf(arm, {{"lift"}, {{"follow", 1}}}), HasSubstr("lock that one instead"));
  EXPECT_THAT(messageOf(arm, {{"lift"}, {{"flex", std::numeric_limits<double>::quiet_NaN()}}}),
              HasSubstr("must be finite"));
  EXPECT_THAT(messageOf(arm, {{"knee"}, {}}), HasSubstr("no coordinate called 'knee'"));
  Model bent = arm;
  bent.joints[2].axes[0].axis.setZero();
  EXPECT_THAT(messageOf(bent, {{"flex"}, {}}), HasSubstr("length 0, must be > 0"));
  Model looped = arm;
  looped.joints.push_back(arm.joints[0]);
  EXPECT_THAT(messageOf(looped, {{"lift"}, {}}), HasSubstr("must be a tree"));
  Model loose = arm;
  loose.joints[1].parentBody = "hand";
  EXPECT_THAT(messageOf(loose, {{"lift"}, {}}), HasSubstr("not connected to the ground"));
  Model still = arm;
  still.joints[2].axes[1].function = Function{1, ConstantFunction{0.1}};
  still.joints[2].axes[1].coordinate.clear();
  EXPECT_THAT(messageOf(still, {{"turn"}, {}}), HasSubstr("moves no body"));
  ArticulatedTree tree(arm, {{"lift"}, {}});
  EXPECT_THROW(tree.placeOf("foot"), std::invalid_argument);
  PointMotion fixed;
  EXPECT_THROW(tree.addMovingPoint("fore", fixed), std::invalid_argument);
}

}  // namespace
}  // namespace bio
