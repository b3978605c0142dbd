#include "info/dynamics/extended_system.h"

#include <gmock/gmock.h>

#include "robots/instances.h"
#include "robots/robot_designs.h"
#include "support/pendulum.h"

namespace {

using namespace info;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const Vector<double, 2> massTheta{0.1, 0.6};

MatrixXd somePsi(Index n, Index p) {
  return MatrixXd::NullaryExpr(n, p, [](Index i, Index j) {
    return 0.4 * std::sin(1.0 + 1.7 * double(i) - 0.9 * double(j));
  });
}

// ∂F/∂w by central differences.
template <class F>
MatrixXd differences(const F& function, VectorXd w, double h = 1e-6) {
  const VectorXd at = function(w);
  MatrixXd out(at.size(), w.size());
  for (Index j = 0; j < w.size(); ++j) {
    const double kept = w[j];
    w[j] = kept + h;
    const VectorXd plus = function(w);
    w[j] = kept - h;
    out.col(j) = (plus - function(w)) / (2 * h);
    w[j] = kept;
  }
  return out;
}

// The derivatives of x and of ψ of one step, and ψ itself, against differences.
void checkStep(const ExtendedStepMap& map, const VectorXd& x, double u0, double u1) {
  const Index n = map.dimensions.state, p = map.dimensions.parameter;
  const MatrixXd psi = somePsi(n, p);
  VectorXd w(n + 2);
  w << x, u0, u1;
  const auto next = [&](const VectorXd& at) {
    return map.step(at.head(n), psi, at.segment(n, 1), at.tail(1));
  };
  const auto exact = map.derivatives(x, psi, w.segment(n, 1), w.tail(1));
  const MatrixXd dx = differences([&](const VectorXd& at) { return next(at).x; }, w);
  const MatrixXd dpsi =
      differences([&](const VectorXd& at) { return VectorXd(next(at).psi.reshaped()); }, w);
  EXPECT_LT((exact.x - dx).norm(), 1e-7 * (1 + dx.norm()));
  EXPECT_LT((exact.psi - dpsi).norm(), 1e-7 * (1 + dpsi.norm())) << exact.psi << "\n\n" << dpsi;
  EXPECT_GT(dpsi.norm(), 1e-3);
}

const VectorXd bob = VectorXd{{0.1, 0.5, -0.3, 1.1}};

TEST(ExtendedStepMap, DifferentiatesAnExplicitMap) {
  checkStep(extend(Rk4<SuspendedMass>{{}, 0.05}, massTheta), bob, 0.7, -0.4);
}

TEST(ExtendedStepMap, DifferentiatesAnImplicitMap) {
  checkStep(extend(ImplicitMidpoint<Pendulum>{{}, 0.05}, {0.8, 0.1}), VectorXd{{0.5, 1.1}}, 0.7,
            -0.4);
}

TEST(ExtendedStepMap, DifferentiatesAVariationalIntegrator) {
  checkStep(doublePendulumSteps(0.05), VectorXd{{0.5, -0.3, 0.01, 0.004}}, 0.02, 0.05);
}

TEST(ExtendedStepMap, CarriesTheSensitivityOfTheStepsTaken) {
  const VectorXd x{{0.5, -0.3, 0.01, 0.004}}, u0{{0.02}}, u1{{0.05}};
  const MatrixXd psi = MatrixXd::Zero(4, 2);
  const MatrixXd exact = doublePendulumSteps(0.05).step(x, psi, u0, u1).psi;
  const MatrixXd dtheta = differences(
      [&](const VectorXd& at) {
        return doublePendulumSteps(0.05, 1e-3, Vector<double, 2>(at)).step(x, psi, u0, u1).x;
      },
      VectorXd{{0.085, 0.5}});
  EXPECT_LT((exact - dtheta).norm(), 1e-8 * dtheta.norm() + 1e-10);
}

TEST(ExtendedFlow, DifferentiatesTheRatesOfStateAndSensitivity) {
  const ExtendedFlow flow = extendFlow(SuspendedMass{}, massTheta);
  const MatrixXd psi = somePsi(4, 2);
  VectorXd w(5);
  w << bob, 0.7;
  const auto exact = flow.derivatives(bob, psi, w.tail(1));
  const auto rate = [&](const VectorXd& at) { return flow.rate(at.head(4), psi, at.tail(1)); };
  const MatrixXd dx = differences([&](const VectorXd& at) { return rate(at).x; }, w);
  const MatrixXd dpsi =
      differences([&](const VectorXd& at) { return VectorXd(rate(at).psi.reshaped()); }, w);
  EXPECT_LT((exact.x - dx).norm(), 1e-8 * dx.norm());
  EXPECT_LT((exact.psi - dpsi).norm(), 1e-8 * dpsi.norm());
}

TEST(ExtendedOutput, DifferentiatesTheSensitivityOfAnOutputWithTheInputInIt) {
  const ExtendedOutput output = extendFlow(SuspendedMass{}, massTheta).output;
  const MatrixXd psi = somePsi(4, 2), P{{0.7, -1.3}};
  VectorXd all(4 + 1 + 8);
  all << bob, 0.7, psi.reshaped();
  const auto product = [&](const VectorXd& at) {
    const MatrixXd s = at.tail(8).reshaped(4, 2);
    const MatrixXd gamma = output.gamma(at.head(4), s, at.segment(4, 1));
    return VectorXd::Constant(1, gamma.cwiseProduct(P).sum());
  };
  const auto exact = output.gradient(bob, psi, all.segment(4, 1), P);
  VectorXd gradient(13);
  gradient << exact.x, exact.u, exact.psi.reshaped();
  const VectorXd central = differences(product, all).transpose();
  EXPECT_LT((gradient - central).norm(), 1e-8 * central.norm());
  EXPECT_GT(std::abs(exact.u[0]), 1e-3);
}

}  // namespace
