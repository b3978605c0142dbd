// Eigen's own allocations stop at an assertion here; those of operator new are counted.
#define EIGEN_RUNTIME_NO_MALLOC
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "info/systems/cart_double_pendulum.h"
#include "info/variational.h"

namespace {
long allocations = 0;
}

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* place = std::malloc(size)) return place;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* place) noexcept {
  std::free(place);
}
[[gnu::noinline]] void operator delete(void* place, std::size_t) noexcept {
  std::free(place);
}

namespace {

using namespace info;

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
  Eigen::internal::set_is_malloc_allowed(false);
  const long before = allocations;
  const double second = everything();
  EXPECT_EQ(allocations, before);
  Eigen::internal::set_is_malloc_allowed(true);
  EXPECT_EQ(first, second);
  EXPECT_GT(before, 0);
}

}  // namespace
