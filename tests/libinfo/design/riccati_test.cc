#include "info/design/riccati.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/throws_saying.h"

namespace {

using support::throwsSaying;
using namespace info;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::HasSubstr;

MatrixXd wave(Index rows, Index columns, double phase) {
  return MatrixXd::NullaryExpr(rows, columns, [&](Index i, Index j) {
    return std::sin(1.3 * double(i) - 2.1 * double(j) + phase);
  });
}

struct Problem {
  LinearSequence system;
  LinearCost cost;
  QuadraticWeights weights;
};

// Time-varying, three states, two inputs, a cross weight small enough to keep the cost convex.
Problem stepProblem(std::size_t steps) {
  Problem p;
  for (std::size_t k = 0; k < steps; ++k) {
    p.system.A.push_back(0.6 * wave(3, 3, 0.3 * double(k)));
    p.system.B.push_back(wave(3, 2, 1 + 0.2 * double(k)));
    p.cost.b.push_back(wave(2, 1, 0.7 * double(k)));
  }
  for (std::size_t k = 0; k <= steps; ++k) p.cost.a.push_back(wave(3, 1, 2 + 0.5 * double(k)));
  p.weights.Q = VectorXd{{1.0, 2.0, 0.5}}.asDiagonal();
  p.weights.R = MatrixXd{{1.5, 0.2}, {0.2, 1.0}};
  p.weights.S = 0.2 * wave(2, 3, 0.4);
  p.weights.Qf = VectorXd{{3.0, 1.0, 2.0}}.asDiagonal();
  return p;
}

TEST(AffineLq, EqualsTheDenseQuadraticProgramme) {
  constexpr std::size_t steps = 6;
  const Problem p = stepProblem(steps);
  // z = G v by rolling out unit inputs, then one dense system for all v at once
  const Index nv = 2 * Index(steps), nz = 3 * Index(steps + 1);
  MatrixXd G = MatrixXd::Zero(nz, nv);
  for (std::size_t k = 0; k < steps; ++k) {
    const Index row = 3 * Index(k);
    G.middleRows(row + 3, 3) = p.system.A[k] * G.middleRows(row, 3);
    G.block(row + 3, 2 * Index(k), 3, 2) += p.system.B[k];
  }
  MatrixXd H = MatrixXd::Zero(nv, nv);
  VectorXd g = VectorXd::Zero(nv);
  for (std::size_t k = 0; k <= steps; ++k) {
    const MatrixXd Gk = G.middleRows(3 * Index(k), 3);
    H += Gk.transpose() * (k == steps ? p.weights.Qf : p.weights.Q) * Gk;
    g += Gk.transpose() * p.cost.a[k];
    if (k == steps) continue;
    H.block(2 * Index(k), 2 * Index(k), 2, 2) += p.weights.R;
    const MatrixXd cross = p.weights.S * Gk;
    H.middleRows(2 * Index(k), 2) += cross;
    H.middleCols(2 * Index(k), 2) += cross.transpose();
    g.segment(2 * Index(k), 2) += p.cost.b[k];
  }
  const VectorXd v = -H.ldlt().solve(g);
  const AffineLqSolution solution = affineLq(p.system, p.cost, p.weights);
  for (std::size_t k = 0; k < steps; ++k)
    EXPECT_LT((solution.v[k] - v.segment(2 * Index(k), 2)).norm(), 1e-11) << k;
  EXPECT_NEAR(solution.slope, g.dot(v), 1e-11 * std::abs(g.dot(v)));
}

TEST(LqrGains, SettleAtTheSolutionOfTheAlgebraicEquation) {
  // scalar z' = a z + v, q = r = 1: p² = p a² … has the root below
  const double a = 1.2;
  LinearSequence system;
  for (int k = 0; k < 60; ++k) {
    system.A.push_back(MatrixXd::Constant(1, 1, a));
    system.B.push_back(MatrixXd::Ones(1, 1));
  }
  const double P = 0.5 * (a * a + std::sqrt(a * a * a * a + 4));
  const auto K = lqrGains(system, {MatrixXd::Ones(1, 1), MatrixXd::Ones(1, 1), {}, {}});
  EXPECT_NEAR(K[0](0, 0), a * P / (1 + P), 1e-12);
  EXPECT_NEAR(K[59](0, 0), a / 2, 1e-15);  // P = Qf = Q at the end
}

TEST(ContinuousLqrGains, FollowTheHyperbolicTangent) {
  // ż = v, q = r = 1: P(t) = tanh(T − t), K = P
  constexpr std::size_t steps = 100;
  const double h = 0.02;
  LinearSequence system;
  system.A.assign(steps + 1, MatrixXd::Zero(1, 1));
  system.B.assign(steps + 1, MatrixXd::Ones(1, 1));
  const auto K =
      continuousLqrGains(system, h, {MatrixXd::Ones(1, 1), MatrixXd::Ones(1, 1), {}, {}});
  for (std::size_t k : {0UL, 30UL, 99UL, 100UL})
    EXPECT_NEAR(K[k](0, 0), std::tanh(2 - h * double(k)), 5e-9);  // 2.4e-9
}

struct ContinuousProblem {
  LinearSequence system;
  LinearCost cost;
  QuadraticWeights weights;
  double step;
};

// Time-varying, three states, one input, over 2 s.
ContinuousProblem continuousProblem(std::size_t steps) {
  ContinuousProblem p;
  p.step = 2.0 / double(steps);
  for (std::size_t k = 0; k <= steps; ++k) {
    const double t = p.step * double(k);
    p.system.A.push_back(0.8 * wave(3, 3, t));
    p.system.B.push_back(wave(3, 1, 1 + t));
    p.cost.a.push_back(wave(3, 1, 2 * t));
    p.cost.b.push_back(wave(1, 1, 1 - t));
  }
  p.weights = {VectorXd{{1.0, 2.0, 0.5}}.asDiagonal(),
               MatrixXd::Constant(1, 1, 0.7),
               {},
               VectorXd{{3.0, 1.0, 2.0}}.asDiagonal()};
  return p;
}

// The same equations by another algorithm: backward differentiation with adaptive steps.
TEST(RiccatiIntegration, AgreesWithSundials) {
  const auto difference = [](std::size_t steps) {
    const ContinuousProblem p = continuousProblem(steps);
    using enum RiccatiIntegration;
    const auto gains = continuousLqrGains(p.system, p.step, p.weights, rungeKutta);
    const auto reference = continuousLqrGains(p.system, p.step, p.weights, adaptive);
    const auto zeta = continuousAffineLq(p.system, p.step, p.cost, p.weights, rungeKutta);
    const auto closer = continuousAffineLq(p.system, p.step, p.cost, p.weights, adaptive);
    double largest = std::abs(zeta.slope - closer.slope);
    for (std::size_t k = 0; k <= steps; ++k) {
      largest = std::max(largest, (gains[k] - reference[k]).cwiseAbs().maxCoeff());
      largest = std::max(largest, (zeta.v[k] - closer.v[k]).cwiseAbs().maxCoeff());
    }
    return largest;
  };
  EXPECT_LT(difference(200), 1e-6);
  EXPECT_GT(difference(10), 1e-5);  // not the same computation twice
}

// ∫ aᵀz + bᵀv = −∫ zᵀQz + vᵀRv at the minimum: the cost's derivative along the minimiser vanishes.
TEST(ContinuousAffineLq, IsStationaryToSecondOrderInTheStep) {
  const auto defect = [](std::size_t steps) {
    ContinuousProblem p = continuousProblem(steps);
    p.weights.Qf = {};
    const QuadraticWeights& weights = p.weights;
    const double h = p.step;
    const AffineLqSolution s = continuousAffineLq(p.system, h, p.cost, weights);
    double quadratic = 0;
    for (std::size_t k = 0; k <= steps; ++k)
      quadratic += (k == 0 || k == steps ? 0.5 : 1.0) * h *
                   (s.z[k].dot(weights.Q * s.z[k]) + s.v[k].dot(weights.R * s.v[k]));
    EXPECT_LT(s.slope, 0);
    return std::abs(1 + quadratic / s.slope);
  };
  const double coarse = defect(50), fine = defect(100);
  EXPECT_LT(coarse, 2e-3);
  EXPECT_NEAR(coarse / fine, 4, 0.8);
}

TEST(Riccati, NamesTheWeightThatBreaksItsRule) {
  Problem p = stepProblem(3);
  const auto with = [&](auto change) {
    return [=, weights = p.weights]() mutable {
      change(weights);
      affineLq(p.system, p.cost, weights);
    };
  };
  throwsSaying(with([](auto& w) { w.R = -w.R; }), "weight R: least eigenvalue");
  throwsSaying(with([](auto& w) { w.Q(0, 0) = -1; }), "weight Q: least eigenvalue is -1");
  throwsSaying(with([](auto& w) { w.Q(0, 1) = 1; }), "weight Q: must be finite and symmetric");
  throwsSaying(with([](auto& w) { w.R(0, 0) = std::nan(""); }), "weight R: must be finite");
  throwsSaying(with([](auto& w) { w.Qf.resize(2, 2); }), "weight Qf");
  throwsSaying(with([](auto& w) { w.S.resize(1, 3); }), "weight S");
  throwsSaying([&] { affineLq(p.system, {p.cost.a, {}}, p.weights); }, "linear cost");
  throwsSaying([&] { lqrGains({p.system.A, {}}, p.weights); }, "linear system");
  throwsSaying(
      [&] {
        continuousLqrGains(p.system, 0, {p.weights.Q, p.weights.R, {}, {}});
      },
      "step between nodes");
}

}  // namespace
