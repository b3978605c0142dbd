#include "info/design/information_rate_cost.h"

#include <gtest/gtest.h>

#include "robots/instances.h"

namespace {

using namespace info;
using Both = MassAndLengthUnknown;
using Length = LengthUnknown;

TEST(InformationRateCost, IsTheInverseOfTheInformationOfOneParameter) {
  InformationRateCost<Length> cost;
  cost.inverseCovariance(0, 0) = 25;
  cost.epsilon = 0.3;
  cost.stateWeight(0, 0) = 2;
  cost.desired[0] = 0.5;
  const Length system{{}, {0.2, 0.45}};
  const Vector<double, 4> x(0.1, 0.4, 0.2, -1.5), psi(0, 0.3, 0, 0.8);
  const Vector<double, 1> u(1.3), theta(0.4);
  // by hand: F = m (g cos φ + ℓ φ̇² + u sin φ)
  const double gamma = 0.2 * (1.5 * 1.5 + (-9.81 * std::sin(0.4) + 1.3 * std::cos(0.4)) * 0.3 +
                              2 * 0.4 * -1.5 * 0.8);
  EXPECT_NEAR(cost.value(system, x, psi, u, theta), 1 / (25 * gamma * gamma + 0.3) + 2 * 0.16,
              1e-12);
}

TEST(InformationRateCost, HasTheGradientOfItsValue) {
  InformationRateCost<Both> cost;
  cost.inverseCovariance(0, 0) = 25;
  cost.epsilon = 0.3;
  cost.scale << 0.05, 0.2;
  cost.stateWeight << 2, 0.1, 0, 0, 0.1, 1, 0, 0, 0, 0, 3, 0.2, 0, 0, 0.2, 0.5;
  cost.desired << 0.5, -0.2, 0.1, 0.4;
  const Both system{{}, {0, 0}};
  const Vector<double, 2> theta(0.22, 0.4);
  const Vector<double, 4> x(0.1, 0.4, 0.2, -1.5);
  Matrix<double, 4, 2> psi;
  psi << 0.1, 0, 0.2, 0.3, -0.1, 0, 0.5, 0.8;
  const Vector<double, 1> u(1.3);
  Vector<double, 13> z;
  z << x, psi.reshaped(), u;
  const auto value = [&](const Vector<double, 13>& at) {
    return Vector<double, 1>(
        cost.value(system, at.head<4>(), at.segment<8>(4).reshaped(4, 2), at.tail<1>(), theta));
  };
  const Vector<double, 13> expected = finiteDifferenceJacobian(value, z).transpose();
  const auto got = cost.gradient(system, x, psi, u, theta);
  Vector<double, 13> all;
  all << got.x, got.psi.reshaped(), got.u;
  EXPECT_LT((all - expected).norm(), 1e-7 * expected.norm());
  EXPECT_GT(std::abs(got.u[0]), 1e-3 * expected.norm());
}

TEST(FreeParameters, GivesTheSystemItsValuesInOrder) {
  using Swapped = FreeParameters<SuspendedMass, 1, 0>;
  const Swapped swapped{{}, {7, 7}};
  const Length length{{}, {0.2, 99}};
  const SuspendedMass whole;
  const Vector<double, 4> x(0.1, 0.4, 0.2, -1.5);
  const Vector<double, 1> u(1.3);
  const Vector<double, 2> theta(0.2, 0.4);
  EXPECT_EQ(swapped.g(x, u, Vector<double, 2>(0.4, 0.2)), whole.g(x, u, theta));
  EXPECT_EQ(length.g(x, u, Vector<double, 1>(0.4)), whole.g(x, u, theta));
  EXPECT_EQ(length.f(x, u, Vector<double, 1>(0.4)), whole.f(x, u, theta));
  EXPECT_EQ(length.parameterNames(), std::vector<std::string>{"length"});
  EXPECT_EQ(swapped.parameterNames(), (std::vector<std::string>{"length", "mass"}));
  static_assert(SmoothSystem<Swapped> && SmoothSystem<Length>);
}

}  // namespace
