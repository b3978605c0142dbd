#include "bio/path/point_path.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "bio/path/surface/wrap_cylinder.h"
#include "bio/path/surface/wrap_sphere.h"
#include "bio/skeleton/tree_motion.h"
#include "second_ways/simbody_tree.h"
#include "support/allocations.h"
#include "support/tree_models.h"

namespace bio {
namespace {

using Vec3d = Eigen::Vector3d;
using Dual = info::Dual<1>;

ArticulatedTree treeOfPoints(const Model& model) {
  return ArticulatedTree(model, {independentCoordinates(model), {}});
}

Eigen::VectorXd drawn(const ArticulatedTree& tree, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  Eigen::VectorXd q(tree.numCoordinates());
  for (double& x : q) x = value(random);
  return q;
}

TreeMotion<double> placed(const ArticulatedTree& tree, const Eigen::VectorXd& q) {
  auto motion = tree.newMotion<double>();
  tree.place(q.data(), motion);
  return motion;
}

/// The motion with q moving along one coordinate.
TreeMotion<Dual> placedAlong(const ArticulatedTree& tree, const Eigen::VectorXd& q, int i) {
  std::vector<Dual> qDual(q.data(), q.data() + q.size());
  qDual[static_cast<std::size_t>(i)].derivatives()[0] = 1;
  auto motion = tree.newMotion<Dual>();
  tree.place(qDual.data(), motion);
  return motion;
}

/// A fixed point of a body, in its segment.
Station stationOf(const ArticulatedTree& tree, const std::string& body, const Vec3d& p) {
  const BodyPlacement& place = tree.placeOf(body);
  return {static_cast<int>(place.segment), place.X_SB.R * p + place.X_SB.p};
}

SupportedLength<double> lengthAt(const ArticulatedTree& tree, const PointPath& path,
                                 const Eigen::VectorXd& q) {
  auto out = path.newLength<double>();
  path.evaluate(placed(tree, q), out);
  return out;
}

/// Derivatives over the support against dual numbers and central differences; 0 elsewhere.
void derivativesAreRight(const ArticulatedTree& tree, const PointPath& path,
                         const Eigen::VectorXd& q) {
  const auto jet = lengthAt(tree, path, q);
  const double h = 1e-5;
  Eigen::Index slot = 0;
  for (int i = 0; i < tree.numCoordinates(); ++i) {
    auto along = path.newLength<Dual>();
    path.evaluate(placedAlong(tree, q, i), along);
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(q.size(), i);
    const auto plus = lengthAt(tree, path, q + step), minus = lengthAt(tree, path, q - step);
    const bool isInside = slot < jet.first.size() && path.support()[std::size_t(slot)] == i;
    if (!isInside) {
      EXPECT_NEAR(along.length.derivatives()[0], 0, 1e-14) << i;  // measured 3e-16
      continue;
    }
    EXPECT_NEAR(along.length.derivatives()[0], jet.first[slot], 1e-12);  // measured 4e-16
    EXPECT_NEAR((plus.length - minus.length) / (2 * h), jet.first[slot], 1e-7);
    for (Eigen::Index j = 0; j < jet.first.size(); ++j) {
      EXPECT_NEAR(along.first[j].derivatives()[0], jet.second(slot, j), 1e-12);  // measured 5e-16
      EXPECT_NEAR((plus.first[j] - minus.first[j]) / (2 * h), jet.second(slot, j), 1e-7);
    }
    ++slot;
  }
  EXPECT_EQ(slot, jet.first.size());
  EXPECT_LT((jet.second - jet.second.transpose()).cwiseAbs().maxCoeff(), 1e-14);
}

/// From one foot over the pelvis and trunk to a hand, touching seven bodies.
PointPath longPath(const ArticulatedTree& tree) {
  return PointPath(
      tree,
      {stationOf(tree, "body5", {0.1, -0.1, 0.02}), stationOf(tree, "body2", {0.02, 0.05, 0.1}),
       stationOf(tree, "body2", {0.05, -0.05, 0.1}), stationOf(tree, "body0", {-0.1, 0, 0.1}),
       stationOf(tree, "body8", {0, 0.1, 0.2}), stationOf(tree, "body13", {0.1, 0.3, 0}),
       stationOf(tree, "body15", {0.2, 0.1, 0})});
}

TEST(PointPath, LengthIsTheSumOfDistancesOfSimbodysPoints) {
  const Model model = fixtures::bodyOfThirtySeven();
  const ArticulatedTree tree = treeOfPoints(model);
  const SimbodyTree reference(model);
  const Eigen::VectorXd q = drawn(tree, 3);
  std::map<std::string, double> values;
  for (int i = 0; i < tree.numCoordinates(); ++i) {
    values[tree.coordinates()[static_cast<std::size_t>(i)].name] = q[i];
  }
  const auto at = [&](const char* body, const Vec3d& p) {
    return reference.pointInGround(values, body, p);
  };
  const std::vector<Vec3d> x = {at("body5", {0.1, -0.1, 0.02}),  at("body2", {0.02, 0.05, 0.1}),
                                at("body2", {0.05, -0.05, 0.1}), at("body0", {-0.1, 0, 0.1}),
                                at("body8", {0, 0.1, 0.2}),      at("body13", {0.1, 0.3, 0}),
                                at("body15", {0.2, 0.1, 0})};
  double expected = 0;
  for (std::size_t i = 1; i < x.size(); ++i) expected += (x[i] - x[i - 1]).norm();
  EXPECT_NEAR(lengthAt(tree, longPath(tree), q).length, expected, 1e-13);  // measured 0
}

TEST(PointPath, DerivativesAreThoseOfDualNumbersAndDifferences) {
  const ArticulatedTree whole = treeOfPoints(fixtures::bodyOfThirtySeven());
  for (unsigned seed = 1; seed < 4; ++seed) {
    derivativesAreRight(whole, longPath(whole), drawn(whole, seed));
  }
  // one coordinate moves both ends: the cap follows flex, which also carries the forearm
  const ArticulatedTree arm = treeOfPoints(fixtures::threeLinkArm());
  const PointPath path(
      arm, {stationOf(arm, "cap", {0.1, 0.02, 0}), stationOf(arm, "hand", {0.02, 0.1, 0.05}),
            stationOf(arm, "ground", {0.3, 0.2, 0.1})});
  derivativesAreRight(arm, path, drawn(arm, 8));
}

TEST(PointPath, PointsThatMoveInTheirBodyAddTheirCoordinates) {
  ArticulatedTree tree = treeOfPoints(fixtures::threeLinkArm());
  PointMotion point;
  point.coordinate = {"flex", "", "follow"};
  point.location = {Function{0.1, SplineFunction{{-2, 0, 1, 2}, {0, 1, 3, 2}}},
                    Function{1, ConstantFunction{0.07}}, Function{1, LinearFunction{0.3, 0.01}}};
  const int moving = tree.addMovingPoint("upper", point);
  const PointPath path(tree, {stationOf(tree, "upper", {0.1, 0.2, 0}),
                              {moving, {0, 0, 0}},
                              stationOf(tree, "fore", {0.1, 0.02, 0})});
  derivativesAreRight(tree, path, drawn(tree, 5));
  const PointPath inUpper(tree, {stationOf(tree, "upper", {0.1, 0.2, 0}), {moving, {0, 0, 0}}});
  EXPECT_EQ(inUpper.support(), std::vector<int>{tree.indexOf("flex")});
}

TEST(PointPath, SupportIsWhatLiesBetweenTheEnds) {
  const ArticulatedTree tree = treeOfPoints(fixtures::bodyOfThirtySeven());
  const PointPath knee(
      tree, {stationOf(tree, "body1", Vec3d::Zero()), stationOf(tree, "body2", Vec3d(0, 0.5, 0))});
  EXPECT_EQ(knee.support(), std::vector<int>{tree.indexOf("q2")});
  // from shank to shank: both knees and hips, not the six of the pelvis
  const PointPath shanks(
      tree, {stationOf(tree, "body2", Vec3d::Zero()), stationOf(tree, "body8", Vec3d(0, 0.5, 0))});
  EXPECT_EQ(shanks.support().size(), 8u);
  const PointPath still(
      tree, {stationOf(tree, "body1", Vec3d(0, 3, 0)), stationOf(tree, "body1", Vec3d(4, 0, 0))});
  EXPECT_TRUE(still.support().empty());
  EXPECT_NEAR(lengthAt(tree, still, drawn(tree, 1)).length, 5, 1e-14);
}

TEST(SegmentChain, MovementsInTheGroundAreThoseOfDualNumbers) {
  const ArticulatedTree tree = treeOfPoints(fixtures::bodyOfThirtySeven());
  const Eigen::VectorXd q = drawn(tree, 9);
  const Station hand = stationOf(tree, "body14", {0.1, 0.2, 0.3});
  const SegmentChain chain(tree, 0, hand.segment);
  const Vec3d force(30, -20, 50);
  const auto motion = placed(tree, q);
  const auto k = static_cast<Eigen::Index>(chain.support().size());
  std::vector<Vec3d> moves(chain.steps().size());
  const Vec3d x = stationInGround(motion, hand);
  chainMoves(chain, motion, x, moves.data());
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(k, k);
  addSecondsAlong(chain, motion, x, moves.data(), force, second);
  for (Eigen::Index a = 0; a < k; ++a) {
    const auto moved = placedAlong(tree, q, chain.support()[static_cast<std::size_t>(a)]);
    const Vec3<Dual> xDual = stationInGround(moved, hand);
    std::vector<Vec3<Dual>> movesDual(moves.size());
    chainMoves(chain, moved, xDual, movesDual.data());
    Vec3d u = Vec3d::Zero();
    Eigen::VectorXd row = Eigen::VectorXd::Zero(k);
    for (std::size_t j = 0; j < moves.size(); ++j) {
      if (chain.steps()[j].slot == a) u += moves[j];
      for (int i = 0; i < 3; ++i) {
        row[chain.steps()[j].slot] += force[i] * movesDual[j][i].derivatives()[0];
      }
    }
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(xDual[i].derivatives()[0], u[i], 1e-13);
    EXPECT_LT((second.row(a).transpose() - row).cwiseAbs().maxCoeff(), 1e-12);  // measured 2e-14
  }
}

/// A span from `from` to `to` over a surface fixed in a third segment, on its own support.
template <class T, class Rule>
SupportedLength<T> spanOver(const ArticulatedTree& tree, const TreeMotion<T>& motion, int surface,
                            const Station& from, const Station& to, const Rule& rule,
                            std::vector<int>* support = nullptr) {
  SegmentChain toP(tree, surface, from.segment), toQ(tree, surface, to.segment);
  std::vector<int> both = toP.support();
  both.insert(both.end(), toQ.support().begin(), toQ.support().end());
  std::sort(both.begin(), both.end());
  both.erase(std::unique(both.begin(), both.end()), both.end());
  toP.renumber(both);
  toQ.renumber(both);
  if (support) *support = both;
  SupportedLength<T> out;
  const auto k = static_cast<Eigen::Index>(both.size());
  out.first.setZero(k);
  out.second.setZero(k, k);
  out.moves.resize(toP.steps().size() + toQ.steps().size());
  out.slotMoves.resize(2 * both.size());
  const Placement<T>& X = motion.segments[static_cast<std::size_t>(surface)];
  const Vec3<T> P = stationInGround(motion, from), Q = stationInGround(motion, to);
  const auto seen = [&](const Vec3<T>& x) { return Vec3<T>(X.R.transpose() * (x - X.p)); };
  addSpan(rule(seen(P), seen(Q)), X, toP, P, toQ, Q, motion, out);
  return out;
}

TEST(PointPath, AStraightSpanSeenFromAThirdBodyHasTheSameDerivatives) {
  const ArticulatedTree tree = treeOfPoints(fixtures::bodyOfThirtySeven());
  const Eigen::VectorXd q = drawn(tree, 12);
  const Station from = stationOf(tree, "body3", {0.1, 0.2, 0.3});
  const Station to = stationOf(tree, "body13", {0.1, 0, 0});
  const auto straight = [](const Vec3d& P, const Vec3d& Q) {
    return straightSpanToSecondOrder<double>(P, Q);
  };
  const PointPath path(tree, {from, to});
  const auto direct = lengthAt(tree, path, q);
  // as seen from the other leg's knee cap, whose joints must drop out
  std::vector<int> support;
  const int cap = static_cast<int>(tree.placeOf("body9").segment);
  const auto seen = spanOver<double>(tree, placed(tree, q), cap, from, to, straight, &support);
  EXPECT_GT(support.size(), path.support().size());
  EXPECT_NEAR(seen.length, direct.length, 1e-14);
  const auto slotOf = [&](int coordinate) {
    const auto& own = path.support();
    const auto at = std::find(own.begin(), own.end(), coordinate);
    return at == own.end() ? Eigen::Index(-1) : Eigen::Index(at - own.begin());
  };
  for (std::size_t i = 0; i < support.size(); ++i) {
    const Eigen::Index a = slotOf(support[i]), row = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(seen.first[row], a < 0 ? 0 : direct.first[a], 1e-13);
    for (std::size_t j = 0; j < support.size(); ++j) {
      const Eigen::Index b = slotOf(support[j]);
      EXPECT_NEAR(seen.second(row, static_cast<Eigen::Index>(j)),
                  a < 0 || b < 0 ? 0 : direct.second(a, b), 1e-12);  // measured 2e-16
    }
  }
}

/// A span from the shank over a surface on the pelvis to the upper arm, so that both ends turn as
/// seen from it, whose frame lies just off the chord, nearer to its beginning.
template <class Wrap>
void wrappedSpanIsRight(const Wrap& wrap) {
  const ArticulatedTree tree = treeOfPoints(fixtures::bodyOfThirtySeven());
  const Eigen::VectorXd q = drawn(tree, 21);
  const int surface = static_cast<int>(tree.placeOf("body0").segment);
  const Station from = stationOf(tree, "body2", {0.1, 0.2, 0.1});
  const Station to = stationOf(tree, "body13", {-0.1, -0.2, 0.1});
  const auto X = placed(tree, q);
  const Placement<double>& X_GC = X.segments[static_cast<std::size_t>(surface)];
  const Vec3d near = 0.7 * stationInGround(X, from) + 0.3 * stationInGround(X, to);
  const Vec3d center = X_GC.R.transpose() * (near - X_GC.p) + Vec3d(0.002, 0.01, -0.005);
  const auto over = [&](const auto& P, const auto& Q) {
    using T = std::decay_t<decltype(P[0])>;
    const Vec3<T> c = center.cast<T>();
    return wrap(Vec3<T>(P - c), Vec3<T>(Q - c));
  };
  std::vector<int> support;
  const auto jet = spanOver<double>(tree, X, surface, from, to, over, &support);
  const PointPath chord(tree, {from, to});
  ASSERT_GT(jet.length, lengthAt(tree, chord, q).length + 1e-4);  // it bends
  for (std::size_t i = 0; i < support.size(); ++i) {
    const auto along =
        spanOver<Dual>(tree, placedAlong(tree, q, support[i]), surface, from, to, over);
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(along.length.derivatives()[0], jet.first[row], 1e-12);  // measured 2e-16
    for (Eigen::Index j = 0; j < jet.first.size(); ++j) {
      EXPECT_NEAR(along.first[j].derivatives()[0], jet.second(row, j), 1e-12);  // measured 1e-15
    }
  }
}

TEST(PointPath, ASpanOverASphereHasTheDerivativesOfDualNumbers) {
  wrappedSpanIsRight([](const auto& P, const auto& Q) {
    using T = std::decay_t<decltype(P[0])>;
    return wrapSphereToSecondOrder<T>(T(0.03), Way::shorter, P, Q);
  });
}

// Unlike a sphere's, a cylinder's mixed second derivatives are not symmetric.
TEST(PointPath, ASpanOverACylinderHasTheDerivativesOfDualNumbers) {
  wrappedSpanIsRight([](const auto& P, const auto& Q) {
    using T = std::decay_t<decltype(P[0])>;
    return wrapCylinderToSecondOrder<T>(T(0.03), Side::clockwise, P, Q);
  });
}

TEST(PointPath, EvaluatesWithoutAllocation) {
  const ArticulatedTree tree = treeOfPoints(fixtures::bodyOfThirtySeven());
  const PointPath path = longPath(tree);
  const auto motion = placed(tree, drawn(tree, 1));
  auto out = path.newLength<double>();
  const long before = support::allocations();
  path.evaluate(motion, out);
  EXPECT_EQ(support::allocations(), before);
}

TEST(PointPath, RefusesWhatIsNoPath) {
  const ArticulatedTree tree = treeOfPoints(fixtures::threeLinkArm());
  EXPECT_THROW(PointPath(tree, {stationOf(tree, "hand", Vec3d::Zero())}), std::invalid_argument);
  EXPECT_THROW(PointPath(tree, {{0, Vec3d::Zero()}, {99, Vec3d::Zero()}}), std::invalid_argument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(PointPath(tree, {{0, Vec3d::Zero()}, {1, Vec3d(nan, 0, 0)}}), std::invalid_argument);
  SegmentChain chain(tree, 0, 1);
  EXPECT_THROW(chain.renumber({}), std::invalid_argument);
}

}  // namespace
}  // namespace bio
