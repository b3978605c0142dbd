#include "info/dynamics/variational.h"

#include <gtest/gtest.h>

#include "robots/instances.h"
#include "support/dual_variational_map.h"

namespace {

using namespace info;

/// A Lagrangian in which nothing is zero: configuration-dependent mass matrix, velocity cubes,
/// explicit coupling of every argument, a force that depends on everything.
struct GenericMechanism {
  static constexpr int coordinateSize = 2, kinematicSize = 1, forceInputSize = 1, parameterSize = 2,
                       measurementSize = 1;
  std::vector<std::string> parameterNames() const { return {"a", "b"}; }
  template <class T>
  T lagrangian(const Vector<T, 2>& q, const Vector<T, 2>& v, const Vector<T, 1>& rho,
               const Vector<T, 1>& w, const Vector<T, 2>& theta) const {
    using std::cos, std::exp, std::sin;
    const T angle = q[0] - q[1] * rho[0];
    const T cosine = cos(angle);
    const T mass = 1.5 + 0.3 * cosine + theta[0] * q[1] * q[1];
    const T cubic = 0.1 * v[0] * v[0] * v[1] * (1.0 + 0.2 * q[0] * theta[1]);
    const T kinetic = 0.5 * mass * v[0] * v[0] + theta[1] * v[1] * v[1] + 0.2 * v[0] * v[1] * q[0];
    const T bend = 0.3 * q[1] * rho[0];
    const T growth = exp(bend);
    const T drive =
        w[0] * (v[0] * cosine + 0.4 * v[1] * theta[0] * q[0]) + w[0] * w[0] * v[1] * 0.1;
    return kinetic + cubic + drive - theta[0] * growth - 0.5 * theta[1] * q[0] * q[0] * q[1];
  }
  template <class T>
  Vector<T, 2> force(const Vector<T, 2>& q, const Vector<T, 2>& v, const Vector<T, 1>& rho,
                     const Vector<T, 1>& w, const Vector<T, 1>& u,
                     const Vector<T, 2>& theta) const {
    using std::sin;
    const T sine = sin(q[0]);
    Vector<T, 2> f;
    f << u[0] * (1.0 + 0.3 * sine) - theta[0] * v[0] * v[1] + 0.2 * rho[0] * w[0] * theta[1],
        u[0] * u[0] * q[1] * theta[1] - 0.3 * v[1] * w[0];
    return f;
  }
  template <class T>
  Vector<T, 1> measure(const Vector<T, 2>& q, const Vector<T, 1>&, const Vector<T, 2>&) const {
    return q.template head<1>();
  }
};
using Integrator = VariationalIntegrator<GenericMechanism>;

static_assert(LagrangianSystem<CartDoublePendulum<>> && SmoothSystem<CartDoublePendulum<>>);
static_assert(DifferentiatedStepMap<Integrator>);

constexpr double dt = 0.05;
const Integrator::State x{0.4, -0.3, 1.1, 0.6};
const Integrator::Input u0{0.7, 0.2}, u1{0.0, 0.35};
const Vector<double, 2> theta{0.6, 0.8};

using Z = Vector<double, Integrator::zSize>;
Integrator::Arguments unpack(const Z& z) {
  return {z.head<2>(),     z.segment<2>(2), z.segment<1>(4),
          z.segment<1>(5), z.segment<1>(6), z.tail<2>()};
}
const Z z = (Z() << x, u0, u1.tail<1>(), theta).finished();

class VariationalStep : public testing::TestWithParam<Forcing> {
 public:
  Integrator integrator{GenericMechanism{}, dt, GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Forcings, VariationalStep,
                         testing::Values(Forcing::left, Forcing::symmetric));

TEST_P(VariationalStep, SolvesTheDiscreteEulerLagrangeEquationsWrittenByTheirDefinition) {
  const auto taken = integrator.step(unpack(z));
  ASSERT_TRUE(taken.converged);
  EXPECT_LE(taken.iterations, 6);
  const DualVariationalMap<GenericMechanism> reference{{}, dt, GetParam()};
  Integrator::State x1;
  x1 << taken.q1, taken.p1;
  EXPECT_LT(reference.residual(x1, x, u0, u1, theta).cwiseAbs().maxCoeff(), 1e-13);
}

TEST_P(VariationalStep, FirstDerivativesEqualThoseOfAutomaticDifferentiation) {
  const DualVariationalMap<GenericMechanism> reference{{}, dt, GetParam()};
  const auto expected = linearise(reference, x, u0, u1, theta);
  const auto got = integrator.linearise(x, u0, u1, theta);
  EXPECT_LT((got.dx - expected.dx).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((got.du0 - expected.du0).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((got.du1 - expected.du1).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((got.dtheta - expected.dtheta).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_P(VariationalStep, FirstDerivativesEqualFiniteDifferencesOfTheStep) {
  const auto map = [&](const Z& at) {
    const auto taken = integrator.step(unpack(at));
    return (Integrator::State() << taken.q1, taken.p1).finished();
  };
  const auto expected = finiteDifferenceJacobian(map, z);
  const auto got = integrator.firstDerivatives(unpack(z), integrator.step(unpack(z)));
  EXPECT_LT((got - expected).cwiseAbs().maxCoeff(), 1e-8 * expected.cwiseAbs().maxCoeff());
}

TEST_P(VariationalStep, SecondDerivativesEqualFiniteDifferencesOfTheFirst) {
  const auto got = integrator.secondDerivatives(unpack(z), integrator.step(unpack(z)));
  for (int i = 0; i < 4; ++i) {
    const auto row = [&](const Z& at) {
      const auto arguments = unpack(at);
      return Z(
          integrator.firstDerivatives(arguments, integrator.step(arguments)).row(i).transpose());
    };
    const auto expected = finiteDifferenceJacobian(row, z);
    const auto& hessian = got.second[std::size_t(i)];
    // every block (q, p, u, rho_k, rho_k+1, theta)^2 by itself, so that no small one can hide
    const int starts[] = {0, 2, 4, 5, 6, 7, 9};
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b) {
        const int r = starts[a], c = starts[b], h = starts[a + 1] - r, w = starts[b + 1] - c;
        const double scale = std::max(1e-3, expected.block(r, c, h, w).cwiseAbs().maxCoeff());
        EXPECT_LT((hessian - expected).block(r, c, h, w).cwiseAbs().maxCoeff(), 1e-6 * scale)
            << "component " << i << ", blocks " << a << " " << b;
      }
    EXPECT_LT((hessian - hessian.transpose()).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST_P(VariationalStep, ContractedSecondDerivativesEqualTheSumOverComponents) {
  const auto arguments = unpack(z);
  const auto taken = integrator.step(arguments);
  const auto all = integrator.secondDerivatives(arguments, taken);
  EXPECT_EQ(all.first, integrator.firstDerivatives(arguments, taken));
  const Integrator::State w{0.3, -1.2, 0.7, 2.0};
  Integrator::Hessian sum = Integrator::Hessian::Zero();
  for (int i = 0; i < 4; ++i) sum += w[i] * all.second[std::size_t(i)];
  EXPECT_LT(
      (integrator.contractedSecondDerivatives(arguments, taken, w) - sum).cwiseAbs().maxCoeff(),
      1e-12 * sum.cwiseAbs().maxCoeff());
}

TEST_P(VariationalStep, ContractedHessianOfTheStepMapEqualsFiniteDifferences) {
  const Integrator::State w{0.3, -1.2, 0.7, 2.0};
  const auto gradient = [&](const Vector<double, 10>& at) {
    const auto l =
        integrator.linearise(at.head<4>(), at.segment<2>(4), at.segment<2>(6), at.tail<2>());
    Vector<double, 10> out;
    out << l.dx.transpose() * w, l.du0.transpose() * w, l.du1.transpose() * w,
        l.dtheta.transpose() * w;
    return out;
  };
  const auto expected =
      finiteDifferenceJacobian(gradient, packArgument<Integrator>(x, u0, u1, theta));
  const auto got = integrator.contractedHessian(x, u0, u1, theta, w);
  EXPECT_LT((got - expected).cwiseAbs().maxCoeff(), 1e-7 * expected.cwiseAbs().maxCoeff());
}

TEST(VariationalIntegrator, IsReversibleWithoutForce) {
  // with f = 0 the step back is the step with p reversed
  CartDoublePendulum<DoublePendulumUnknowns::bothMasses> pendulum;
  const VariationalIntegrator integrator(pendulum, 0.02);
  using I = decltype(integrator);
  std::remove_const_t<I>::Arguments a{
      {0.7, -0.4}, {0.003, 0.001}, {}, Vector<double, 1>(0.0), Vector<double, 1>(0.0), {0.1, 0.08}};
  const auto there = integrator.step(a);
  ASSERT_TRUE(there.converged);
  a.q = there.q1;
  a.p = -there.p1;
  const auto back = integrator.step(a);
  EXPECT_LT((back.q1 - Vector<double, 2>(0.7, -0.4)).norm(), 1e-13);
  EXPECT_LT((back.p1 + Vector<double, 2>(0.003, 0.001)).norm(), 1e-15);
}

TEST(VariationalIntegrator, ReportsAStepItCannotSolve) {
  // momentum far beyond what one step of this length can carry
  const VariationalIntegrator integrator(CartDoublePendulum<>{}, 5.0);
  using I = std::remove_const_t<decltype(integrator)>;
  const I::Arguments a{
      {2.0, 1.0}, {40.0, -35.0}, {}, Vector<double, 1>(0.0), Vector<double, 1>(3.0), {0.085, 0.5}};
  const auto taken = integrator.step(a);
  EXPECT_FALSE(taken.converged);
  EXPECT_GT(taken.residualNorm, 1e-6);
}

TEST(VariationalIntegrator, DoesNotClaimASolutionForNumbersThatAreNone) {
  const Integrator integrator({}, dt);
  for (int i = 0; i < Integrator::zSize; ++i) {
    Z broken = z;
    broken[i] = std::nan("");
    EXPECT_FALSE(integrator.step(unpack(broken)).converged) << "argument " << i;
  }
}

TEST(VariationalIntegrator, RefusesATimeStepThatIsNotPositive) {
  for (const double bad : {0.0, -0.1, std::nan(""), HUGE_VAL})
    EXPECT_THROW(VariationalIntegrator(CartDoublePendulum<>{}, bad), std::domain_error);
}

}  // namespace
