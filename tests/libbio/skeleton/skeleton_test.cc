#include "bio/skeleton/skeleton.h"

#include <gtest/gtest.h>

#include <random>

#include "second_ways/simbody_tree.h"
#include "support/arm_models.h"

namespace bio {
namespace {

using Vec3d = Eigen::Vector3d;

template <int N>
using Q = Eigen::Matrix<double, N, 1>;

SkeletonOptions freeing(std::vector<std::string> names) {
  return {std::move(names), {}};
}

template <int N>
std::vector<RigidMotion<double, N>> moved(const Skeleton& skeleton, const Q<N>& q) {
  std::vector<RigidMotion<double, N>> X(skeleton.numSegments());
  skeleton.motions<double, N>(q, X.data());
  return X;
}

template <int N>
Vec3d pointAt(const Skeleton& skeleton, const Q<N>& q, const std::string& body, const Vec3d& p) {
  const BodyPlacement& place = skeleton.placeOf(body);
  const auto X = moved<N>(skeleton, q)[place.segment].value * place.X_SB;
  return X.R * p + X.p;
}

std::map<std::string, double> named(const Skeleton& skeleton, const Eigen::VectorXd& q) {
  std::map<std::string, double> values;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    values[skeleton.coordinates()[static_cast<std::size_t>(i)].name] = q[i];
  }
  return values;
}

template <int N>
void agreesWithSimbody(const Model& model, const std::vector<std::string>& free) {
  const Skeleton skeleton(model, freeing(free));
  const SimbodyTree tree(model);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-1.2, 1.2);
  for (int trial = 0; trial < 20; ++trial) {
    Q<N> q;
    for (int i = 0; i < N; ++i) q[i] = angle(random);
    const auto values = named(skeleton, q);
    for (const Body& body : model.bodies) {
      const Vec3d p(0.1, -0.2, 0.05);
      EXPECT_LT(
          (pointAt<N>(skeleton, q, body.name, p) - tree.pointInGround(values, body.name, p)).norm(),
          1e-14)
          << body.name;
    }
    const auto jet = skeleton.inertia<N>(q, moved<N>(skeleton, q).data());
    const auto reference = tree.reducedTo(free, values);
    // measured 4e-16
    EXPECT_LT((jet.massMatrix - reference.massMatrix).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((-jet.dV - reference.gravityForce).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Skeleton, AgreesWithSimbodyOnPlacesMassMatrixAndGravity) {
  const Model model = fixtures::threeLinkArm();
  agreesWithSimbody<1>(model, {"lift"});
  agreesWithSimbody<1>(model, {"flex"});
  agreesWithSimbody<2>(model, {"flex", "turn"});
  agreesWithSimbody<4>(model, {"reach", "lift", "turn", "flex"});
}

TEST(Skeleton, DerivativesOfPlacementsMatchCentralDifferences) {
  const Skeleton skeleton(fixtures::threeLinkArm(), freeing({"reach", "lift", "turn", "flex"}));
  const Q<4> q(0.02, 0.4, -0.3, 0.7);
  const auto X = moved<4>(skeleton, q);
  const double h = 1e-5;
  for (std::size_t s = 0; s < skeleton.numSegments(); ++s) {
    for (int i = 0; i < 4; ++i) {
      const Q<4> step = h * Q<4>::Unit(i);
      const auto plus = moved<4>(skeleton, q + step)[s];
      const auto minus = moved<4>(skeleton, q - step)[s];
      const auto si = static_cast<std::size_t>(i);
      EXPECT_LT(((plus.value.R - minus.value.R) / (2 * h) - X[s].first[si].R).norm(), 1e-9);
      EXPECT_LT(((plus.value.p - minus.value.p) / (2 * h) - X[s].first[si].p).norm(), 1e-9);
      for (int j = 0; j < 4; ++j) {
        const auto sj = static_cast<std::size_t>(j);
        const auto& second = X[s].second[static_cast<std::size_t>(pairIndex(i, j))];
        EXPECT_LT(((plus.first[sj].R - minus.first[sj].R) / (2 * h) - second.R).norm(), 1e-9);
        EXPECT_LT(((plus.first[sj].p - minus.first[sj].p) / (2 * h) - second.p).norm(), 1e-9);
      }
    }
  }
}

TEST(Skeleton, DerivativesOfInertiaAndGravityMatchCentralDifferences) {
  const Skeleton skeleton(fixtures::threeLinkArm(), freeing({"reach", "lift", "turn", "flex"}));
  const auto at = [&](const Q<4>& q) {
    return skeleton.inertia<4>(q, moved<4>(skeleton, q).data());
  };
  const Q<4> q(0.02, 0.4, -0.3, 0.7);
  const auto jet = at(q);
  const double h = 1e-5;
  for (int i = 0; i < 4; ++i) {
    const Q<4> step = h * Q<4>::Unit(i);
    const auto plus = at(q + step);
    const auto minus = at(q - step);
    const auto si = static_cast<std::size_t>(i);
    EXPECT_LT(((plus.massMatrix - minus.massMatrix) / (2 * h) - jet.dM[si]).norm(), 1e-9);
    EXPECT_NEAR((plus.potential - minus.potential) / (2 * h), jet.dV[i], 1e-8);
    EXPECT_LT(((plus.dV - minus.dV) / (2 * h) - jet.d2V.col(i)).norm(), 1e-8);
    for (int j = 0; j < 4; ++j) {
      const auto sj = static_cast<std::size_t>(j);
      const auto ij = static_cast<std::size_t>(pairIndex(i, j));
      EXPECT_LT(((plus.dM[sj] - minus.dM[sj]) / (2 * h) - jet.d2M[ij]).norm(), 1e-8);
    }
  }
}

TEST(Skeleton, ASingleHingeHasConstantInertia) {
  const Model model = fixtures::threeLinkArm();
  EXPECT_TRUE(Skeleton(model, freeing({"lift"})).hasConstantInertia());
  EXPECT_TRUE(Skeleton(model, freeing({"reach"})).hasConstantInertia());
  EXPECT_FALSE(
      Skeleton(model, freeing({"flex"})).hasConstantInertia());  // shifts and drives the cap
  EXPECT_FALSE(Skeleton(model, freeing({"turn"})).hasConstantInertia());  // by a spline
}

TEST(Skeleton, LockedValuesOverrideDefaultsAndDriveTheirCouplers) {
  const Model model = fixtures::threeLinkArm();
  const Skeleton skeleton(model, {{"lift"}, {{"flex", 1.0}}});
  const SimbodyTree tree(model);
  const Q<1> q(0.2);
  const std::map<std::string, double> values = {{"lift", 0.2}, {"flex", 1.0}};
  for (const char* body : {"fore", "cap", "hand"}) {
    EXPECT_LT((pointAt<1>(skeleton, q, body, Vec3d(0.1, 0, 0)) -
               tree.pointInGround(values, body, Vec3d(0.1, 0, 0)))
                  .norm(),
              1e-14)
        << body;
  }
  EXPECT_EQ(skeleton.sourceOf("follow").freeIndex, -1);
  EXPECT_NEAR(skeleton.sourceOf("follow").value, 0.8, 1e-15);
}

TEST(Skeleton, RotatingAndShiftingFramesChainAndInvert) {
  const Skeleton skeleton(fixtures::threeLinkArm(), freeing({"flex", "turn"}));
  const auto X = moved<2>(skeleton, Q<2>(0.4, 0.9));
  const auto& A = X[1];
  const auto identity = chain(invert(A), A);
  EXPECT_LT((identity.value.R - Eigen::Matrix3d::Identity()).norm() + identity.value.p.norm(),
            1e-14);
  for (const auto& D : identity.first) EXPECT_LT(D.R.norm() + D.p.norm(), 1e-14);
  for (const auto& D : identity.second) EXPECT_LT(D.R.norm() + D.p.norm(), 1e-13);
}

TEST(Skeleton, BrokenRulesAreNamed) {
  const Model model = fixtures::threeLinkArm();
  const auto message = [](const Model& m, const SkeletonOptions& options) -> std::string {
    try {
      const Skeleton skeleton(m, options);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "no error";
  };
  using ::testing::Test;
  EXPECT_NE(message(model, freeing({})).find("0 free coordinates"), std::string::npos);
  EXPECT_NE(message(model, freeing({"elbow"})).find("'elbow'"), std::string::npos);
  EXPECT_NE(message(model, freeing({"flex", "flex"})).find("twice"), std::string::npos);
  EXPECT_NE(message(model, freeing({"follow"})).find("follows 'flex'"), std::string::npos);
  EXPECT_NE(message(model, {{"flex"}, {{"flex", 1}}}).find("free and locked"), std::string::npos);
  EXPECT_NE(message(model, {{"flex"}, {{"follow", 1}}}).find("lock that one"), std::string::npos);
  EXPECT_NE(message(model, {{"flex"}, {{"lift", std::nan("")}}}).find("finite"), std::string::npos);
  Model loose = model;
  loose.joints.erase(loose.joints.begin() + 1);  // the shoulder
  EXPECT_NE(message(loose, freeing({"flex"})).find("not connected"), std::string::npos);
  Model loop = model;
  loop.joints.push_back(loop.joints[1]);
  EXPECT_NE(message(loop, freeing({"flex"})).find("tree"), std::string::npos);
  Model idle = model;
  for (Joint& joint : idle.joints) {
    if (joint.name == "elbow") joint.axes[1].coordinate = "flex";
  }
  EXPECT_NE(message(idle, freeing({"turn"})).find("moves no body"), std::string::npos);
}

}  // namespace
}  // namespace bio
