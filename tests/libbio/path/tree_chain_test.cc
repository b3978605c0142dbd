#include "bio/path/path_gradient.h"
#include "bio/path/tree_path.h"
#include "bio/skeleton/tree_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libbio/path/arm_paths.h"

namespace bio {
namespace {

using namespace fixtures;
using Q3 = ArmPath<3>::Q;

const std::vector<Q3> postures{
    {0.3, 0.2, 0.8}, {0.1, 0.9, -0.1}, {1.2, 1.4, 0.5}, {0.6, 1.9, 1.5}, {-0.1, 2.2, 2.1}};

Skeleton armTree(const Model& model) {
  SkeletonOptions options;
  options.freeCoordinates = ArmPath<3>::names();
  options.asTree = true;
  return Skeleton(model, options);
}

// Objects on several segments (moved on the ulna, odd on the humerus), passed together.
const std::vector<std::vector<std::string>> chains{{"odd"}, {"moved", "odd"}, {"odd", "moved"}};

TEST(TreeChain, HasLengthsAndDerivativesOfTheCompiledPath) {
  const Model model = system();
  const Skeleton tree = armTree(model);
  int wrapped = 0, severalSegments = 0;
  for (const auto& wraps : chains) {
    for (const Muscle& m : {extensor(wraps), flexor(wraps)}) {
      ArmPath<3> compiled(model, m);
      TreePaths paths(tree);
      paths.add(m, compiled.path);
      for (const PathChain& chain : compiled.path.compiled().chains) {
        severalSegments += chain.inOneSegment ? 0 : 1;
      }
      for (const Q3& q : postures) {
        const LengthJet<3> expected = compiled.at(q);
        paths.moveTo(q);
        const LengthJet<Eigen::Dynamic>& jet = paths.length(0);
        wrapped += expected.wrapped ? 1 : 0;
        EXPECT_EQ(jet.wrapped, expected.wrapped);
        EXPECT_NEAR(jet.length, expected.length, 1e-14);
        for (int i = 0; i < 3; ++i) {
          EXPECT_NEAR(jet.dL_dq[i], expected.dL_dq[i], 1e-13);
          for (int j = 0; j < 3; ++j) {
            EXPECT_NEAR(jet.secondIn(i, j), expected.d2L_dq2(i, j), 1e-11) << i << j;
          }
        }
      }
    }
  }
  EXPECT_GT(wrapped, 8);
  EXPECT_GT(severalSegments, 0);
}

TEST(TreeChain, HasParameterGradientsOfTheCompiledPath) {
  const Model model = system();
  const Skeleton tree = armTree(model);
  for (const auto& wraps : chains) {
    for (const Muscle& m : {extensor(wraps), flexor(wraps)}) {
      ArmPath<3> compiled(model, m);
      const PathGradients ofCompiled(model, compiled.skeleton, m, compiled.path);
      const PathGradients ofTree(model, tree, m, compiled.path);
      ArticulatedTree own(*tree.tree());
      const TreePath path(own, tree, m, compiled.path.compiled());
      TreeMotion<double> motion = own.newMotion<double>();
      SupportedLength<double> work = path.newWork();
      PathGradient<3> expected = ofCompiled.workspace<3>();
      PathGradient<Eigen::Dynamic> gradient = ofTree.workspace(path);
      std::vector<RigidMotion<double, 3>> moved(compiled.skeleton.numSegments());
      const auto agrees = [&](const auto& ours, const auto& theirs) {
        EXPECT_LT((ours.col(0) - theirs.col(0)).cwiseAbs().maxCoeff(), 1e-12);
        for (std::size_t k = 0; k < path.support().size(); ++k) {
          const double apart =
              (ours.col(static_cast<Eigen::Index>(k) + 1) - theirs.col(path.support()[k] + 1))
                  .cwiseAbs()
                  .maxCoeff();
          EXPECT_LT(apart, 1e-11) << m.path.wraps.front().wrapObject << " " << k;
        }
      };
      for (const Q3& q : postures) {
        compiled.skeleton.motions<double, 3>(q, moved.data());
        ofCompiled.evaluate<3>(q, moved.data(), expected);
        own.place(q.data(), motion);
        ofTree.evaluate(q, path, own, motion, work, gradient);
        for (std::size_t i = 0; i < expected.points.size(); ++i) {
          agrees(gradient.points[i], expected.points[i]);
        }
        for (std::size_t i = 0; i < expected.wraps.size(); ++i) {
          agrees(gradient.wraps[i], expected.wraps[i]);
        }
      }
    }
  }
}

// The string itself says which object it meets first.
TEST(TreeChain, PassesObjectsInTheOrderOfTheShortestString) {
  const Model model = system();
  for (const auto& make : {extensor, flexor}) {
    ArmPath<3> oneWay(model, make({"moved", "odd"})), otherWay(model, make({"odd", "moved"}));
    for (const Q3& q : postures) {
      EXPECT_NEAR(oneWay.at(q).length, otherWay.at(q).length, 1e-9) << q.transpose();
    }
  }
}

}  // namespace
}  // namespace bio
