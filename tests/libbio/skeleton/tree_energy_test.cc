#include "bio/skeleton/tree_energy.h"

#include <gtest/gtest.h>

#include <random>

#include "bio/skeleton/tree_energy_bodies.h"
#include "bio/skeleton/tree_motion.h"
#include "second_ways/simbody_tree.h"
#include "support/allocations.h"
#include "support/tree_models.h"

namespace bio {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
constexpr int dynamic = Eigen::Dynamic;

SkeletonOptions allFree(const Model& model) {
  return {independentCoordinates(model), {}};
}

Vector drawn(int n, std::mt19937& random, double size) {
  std::uniform_real_distribution<double> value(-size, size);
  Vector x(n);
  for (double& x_i : x) x_i = value(random);
  return x;
}

template <int N = dynamic>
EnergyDerivatives<N> energies(const ArticulatedTree& tree, const Vector& q, const Vector& v) {
  auto motion = tree.newMotion<double>();
  tree.place(q.data(), motion);
  return TreeEnergy<N>(tree).evaluate(motion, v.data());
}

/// Largest difference over the largest value.
template <class A, class B>
double deviation(const A& a, const B& b) {
  return (a - b).cwiseAbs().maxCoeff() / std::max(1e-3, b.cwiseAbs().maxCoeff());
}

std::vector<Model> madeModels() {
  return {fixtures::threeLinkArm(), fixtures::chainOfSeven(), fixtures::branchesOfSixteen(),
          fixtures::bodyOfThirtySeven()};
}

TEST(TreeEnergy, MassMatrixAndGravityAreThoseOfSimbody) {
  std::mt19937 random(11);
  for (const Model& model : madeModels()) {
    const ArticulatedTree tree(model, allFree(model));
    const SimbodyTree reference(model);
    for (int trial = 0; trial < 4; ++trial) {
      const Vector q = drawn(tree.numCoordinates(), random, 1.2);
      const Vector v = drawn(tree.numCoordinates(), random, 2);
      std::map<std::string, double> values;
      for (int i = 0; i < tree.numCoordinates(); ++i) {
        values[tree.coordinates()[static_cast<std::size_t>(i)].name] = q[i];
      }
      const auto jet = energies(tree, q, v);
      const auto expected = reference.reducedTo(allFree(model).freeCoordinates, values);
      EXPECT_LT(deviation(jet.T_vv, expected.massMatrix), 1e-12);     // measured 9e-16
      EXPECT_LT(deviation(-jet.V_q, expected.gravityForce), 1e-12);   // measured 5e-16
      EXPECT_LT(deviation(jet.T_v, expected.massMatrix * v), 1e-12);  // measured 2e-15
      EXPECT_NEAR(jet.kinetic / (0.5 * v.dot(jet.T_v)), 1, 1e-13);
    }
  }
}

template <int N>
void agreesWithTheSkeleton(const std::vector<std::string>& free) {
  const Model model = fixtures::threeLinkArm();
  const ArticulatedTree tree(model, {free, {}});
  const Skeleton skeleton(model, {free, {}});
  std::mt19937 random(17);
  for (int trial = 0; trial < 10; ++trial) {
    const Vector q = drawn(N, random, 1.2), v = drawn(N, random, 3);
    std::vector<RigidMotion<double, N>> moved(skeleton.numSegments());
    const Eigen::Matrix<double, N, 1> qN = q;
    skeleton.motions<double, N>(qN, moved.data());
    const InertiaJet<N> old = skeleton.inertia<N>(qN, moved.data());
    const auto jet = energies < N == 1 ? 1 : dynamic > (tree, q, v);
    Matrix T_vq(N, N), T_qq(N, N);
    Vector T_q(N);
    for (int i = 0; i < N; ++i) {
      const Matrix dM = old.dM[static_cast<std::size_t>(i)];
      T_vq.col(i) = dM * v;
      T_q[i] = 0.5 * v.dot(dM * v);
      for (int j = 0; j < N; ++j) {
        T_qq(i, j) = 0.5 * v.dot(old.d2M[static_cast<std::size_t>(pairIndex(i, j))] * v);
      }
    }
    // measured 4e-14 at most
    EXPECT_LT(deviation(Matrix(jet.T_vv), Matrix(old.massMatrix)), 1e-12);
    EXPECT_LT(deviation(Vector(jet.T_v), Vector(old.massMatrix * v)), 1e-12);
    EXPECT_LT(deviation(Vector(jet.T_q), T_q), 1e-12);
    EXPECT_LT(deviation(Matrix(jet.T_vq), T_vq), 1e-12);
    EXPECT_LT(deviation(Matrix(jet.T_qq), T_qq), 1e-12);
    EXPECT_NEAR(jet.potential, old.potential, 1e-13);
    EXPECT_LT(deviation(Vector(jet.V_q), Vector(old.dV)), 1e-12);
    EXPECT_LT(deviation(Matrix(jet.V_qq), Matrix(old.d2V)), 1e-12);
  }
}

TEST(TreeEnergy, AgreesWithTheSkeletonForOneToFourCoordinates) {
  agreesWithTheSkeleton<1>({"lift"});
  agreesWithTheSkeleton<1>({"reach"});
  agreesWithTheSkeleton<1>({"turn"});
  agreesWithTheSkeleton<1>({"flex"});
  agreesWithTheSkeleton<2>({"flex", "turn"});
  agreesWithTheSkeleton<3>({"flex", "lift", "reach"});
  agreesWithTheSkeleton<4>({"reach", "lift", "turn", "flex"});
}

TEST(TreeEnergy, OneCompiledSizeAgreesWithTheDynamicOne) {
  const Model model = fixtures::threeLinkArm();
  for (const char* name : {"lift", "flex"}) {
    const ArticulatedTree tree(model, {{name}, {}});
    const Vector q = Vector::Constant(1, 0.6), v = Vector::Constant(1, -1.4);
    const auto one = energies<1>(tree, q, v);
    const auto any = energies<dynamic>(tree, q, v);
    EXPECT_EQ(one.kinetic, any.kinetic);
    EXPECT_EQ(one.T_qq(0, 0), any.T_qq(0, 0));
    EXPECT_EQ(one.V_qq(0, 0), any.V_qq(0, 0));
  }
}

/// All derivatives along one coordinate's (first n) or one rate's direction.
struct Directional {
  double kinetic, potential;
  Vector T_v, T_q, V_q;
};

Directional dualDerivatives(const ArticulatedTree& tree, const Vector& q, const Vector& v,
                            int direction) {
  using Dual = info::Dual<1>;
  const int n = tree.numCoordinates();
  std::vector<Dual> qDual(q.data(), q.data() + n), vDual(v.data(), v.data() + n);
  auto& moving = direction < n ? qDual : vDual;
  moving[static_cast<std::size_t>(direction % n)].derivatives()[0] = 1;
  auto motion = tree.newMotion<Dual>();
  tree.place(qDual.data(), motion);
  TreeEnergy<dynamic, Dual> energy(tree);
  const auto& jet = energy.evaluate(motion, vDual.data());
  Directional d{jet.kinetic.derivatives()[0], jet.potential.derivatives()[0], Vector(n), Vector(n),
                Vector(n)};
  for (int i = 0; i < n; ++i) {
    d.T_v[i] = jet.T_v[i].derivatives()[0];
    d.T_q[i] = jet.T_q[i].derivatives()[0];
    d.V_q[i] = jet.V_q[i].derivatives()[0];
  }
  return d;
}

TEST(TreeEnergy, DerivativesAreThoseOfDualNumbers) {
  std::mt19937 random(23);
  for (const Model& model : madeModels()) {
    const ArticulatedTree tree(model, allFree(model));
    const int n = tree.numCoordinates();
    const Vector q = drawn(n, random, 1.2), v = drawn(n, random, 2);
    const auto jet = energies(tree, q, v);
    Vector T_q(n), V_q(n), T_v(n);
    Matrix T_vv(n, n), T_vq(n, n), T_qv(n, n), T_qq(n, n), V_qq(n, n);
    for (int i = 0; i < n; ++i) {
      const Directional along = dualDerivatives(tree, q, v, i);
      T_q[i] = along.kinetic;
      V_q[i] = along.potential;
      T_vq.col(i) = along.T_v;
      T_qq.col(i) = along.T_q;
      V_qq.col(i) = along.V_q;
      const Directional faster = dualDerivatives(tree, q, v, n + i);
      T_v[i] = faster.kinetic;
      T_vv.col(i) = faster.T_v;
      T_qv.col(i) = faster.T_q;
    }
    // measured 4e-15 at most
    EXPECT_LT(deviation(jet.T_v, T_v), 1e-12);
    EXPECT_LT(deviation(jet.T_q, T_q), 1e-12);
    EXPECT_LT(deviation(jet.V_q, V_q), 1e-12);
    EXPECT_LT(deviation(jet.T_vv, T_vv), 1e-12);
    EXPECT_LT(deviation(jet.T_vq, T_vq), 1e-12);
    EXPECT_LT(deviation(jet.T_vq.transpose(), T_qv), 1e-12);
    EXPECT_LT(deviation(jet.T_qq, T_qq), 1e-12);
    EXPECT_LT(deviation(jet.V_qq, V_qq), 1e-12);
  }
}

TEST(TreeEnergy, DerivativesAreThoseOfCentralDifferences) {
  std::mt19937 random(29);
  for (const Model& model : madeModels()) {
    const ArticulatedTree tree(model, allFree(model));
    const int n = tree.numCoordinates();
    const Vector q = drawn(n, random, 1.2), v = drawn(n, random, 2);
    const auto jet = energies(tree, q, v);
    Vector T_q(n), V_q(n);
    Matrix T_vq(n, n), T_qq(n, n), V_qq(n, n);
    const double h = 1e-5;
    for (int i = 0; i < n; ++i) {
      const Vector step = h * Vector::Unit(n, i);
      const auto plus = energies(tree, q + step, v), minus = energies(tree, q - step, v);
      T_q[i] = (plus.kinetic - minus.kinetic) / (2 * h);
      V_q[i] = (plus.potential - minus.potential) / (2 * h);
      T_vq.col(i) = (plus.T_v - minus.T_v) / (2 * h);
      T_qq.col(i) = (plus.T_q - minus.T_q) / (2 * h);
      V_qq.col(i) = (plus.V_q - minus.V_q) / (2 * h);
    }
    // measured 3e-10 at most
    EXPECT_LT(deviation(jet.T_q, T_q), 1e-7);
    EXPECT_LT(deviation(jet.V_q, V_q), 1e-7);
    EXPECT_LT(deviation(jet.T_vq, T_vq), 1e-7);
    EXPECT_LT(deviation(jet.T_qq, T_qq), 1e-7);
    EXPECT_LT(deviation(jet.V_qq, V_qq), 1e-7);
  }
}

// What CVODE's Jacobian needs: (∂M/∂q) a is T_vq with a in place of v.
TEST(TreeEnergy, MixedDerivativesAreLinearInTheRates) {
  const Model model = fixtures::branchesOfSixteen();
  const ArticulatedTree tree(model, allFree(model));
  std::mt19937 random(31);
  const Vector q = drawn(16, random, 1), v = drawn(16, random, 2), a = drawn(16, random, 5);
  const Matrix sum = energies(tree, q, v).T_vq + 2 * energies(tree, q, a).T_vq;
  EXPECT_LT(deviation(energies(tree, q, v + 2 * a).T_vq, sum), 1e-13);
}

// A free body in space: shifting or turning the whole tree changes no kinetic energy.
/// What does not depend on the rates is the same number at rest, where a shorter way leads to it.
TEST(TreeEnergy, AtRestIsTheMassMatrixAndGravity) {
  for (const Model& model : {fixtures::bodyOfThirtySeven(), fixtures::threeLinkArm()}) {
    const ArticulatedTree tree(model, allFree(model));
    auto motion = tree.newMotion<double>();
    Vector q = tree.defaultValues();
    q.array() += 0.2;
    tree.place(q.data(), motion);
    TreeEnergy<dynamic> still(tree), moving(tree);
    const Vector v = Vector::LinSpaced(q.size(), -1, 2), none = Vector::Zero(q.size());
    const auto& a = still.evaluate(motion, none.data());
    const auto& b = moving.evaluate(motion, v.data());
    EXPECT_TRUE(a.T_vv == b.T_vv);
    EXPECT_TRUE(a.V_q == b.V_q);
    EXPECT_TRUE(a.V_qq == b.V_qq);
    EXPECT_EQ(a.potential, b.potential);
    EXPECT_EQ(a.kinetic, 0);
    EXPECT_TRUE(a.T_v.isZero(0) && a.T_q.isZero(0) && a.T_vq.isZero(0) && a.T_qq.isZero(0));
  }
}

TEST(TreeEnergy, ShiftingTheWholeTreeChangesNoKineticEnergy) {
  const Model model = fixtures::bodyOfThirtySeven();
  const ArticulatedTree tree(model, allFree(model));
  std::mt19937 random(37);
  const Vector q = drawn(37, random, 1), v = drawn(37, random, 2);
  const auto jet = energies(tree, q, v);
  for (const char* shift : {"q0d", "q0e", "q0f"}) {
    const int i = tree.indexOf(shift);
    EXPECT_NEAR(jet.T_q[i], 0, 1e-11);
    EXPECT_LT(jet.T_qq.col(i).cwiseAbs().maxCoeff(), 1e-11);
  }
}

TEST(TreeEnergy, EvaluatesWithoutAllocation) {
  const Model model = fixtures::bodyOfThirtySeven();
  const ArticulatedTree tree(model, allFree(model));
  auto motion = tree.newMotion<double>();
  TreeEnergy<dynamic> energy(tree);
  const Vector q = tree.defaultValues(), v = Vector::Ones(37);
  const long before = support::allocations();
  tree.place(q.data(), motion);
  energy.evaluate(motion, v.data());
  EXPECT_EQ(support::allocations(), before);
}

TEST(TreeEnergy, RefusesACompiledSizeThatIsNotTheTrees) {
  const Model model = fixtures::threeLinkArm();
  const ArticulatedTree tree(model, {{"lift", "flex"}, {}});
  EXPECT_THROW(TreeEnergy<1>{tree}, std::invalid_argument);
}

}  // namespace
}  // namespace bio
