#include <gtest/gtest.h>

#include "robots/instances.h"
#include "support/allocations.h"

namespace {

using namespace info;
using support::allocations;

TEST(VariationalIntegrator, AllocatesNothingInAStepOrItsDerivativesOfFixedSize) {
  using Integrator = VariationalIntegrator<CartDoublePendulum<>>;
  const Integrator integrator({}, 0.02);
  Integrator::Arguments z{{0.6, -0.3}, {0.0, 0.0}, {}, {}, {}, {0.085, 0.5}};
  z.rho0[0] = 0.0;
  z.rho1[0] = 0.003;
  const auto everything = [&] {
    const auto taken = integrator.step(z);
    const auto d = integrator.secondDerivatives(z, taken);
    const auto c = integrator.contractedSecondDerivatives(z, taken, Integrator::State::Ones());
    return integrator.firstDerivatives(z, taken).sum() + d.second[3].sum() + c.sum();
  };
  const double first = everything();  // a thread's first call may grow its scratch
  const long before = allocations();
  const double second = everything();
  EXPECT_EQ(allocations(), before);
  EXPECT_EQ(first, second);
}

}  // namespace
