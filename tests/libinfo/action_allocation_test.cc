// Eigen's own allocations stop at an assertion here; those of operator new are counted.
#define EIGEN_RUNTIME_NO_MALLOC
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "../../libinfo/src/active_estimation_modules.h"

namespace {
long allocations = 0;
}

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* place = std::malloc(size)) return place;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t align) {
  ++allocations;
  if (void* place = std::aligned_alloc(static_cast<std::size_t>(align), size)) return place;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* place) noexcept {
  std::free(place);
}
[[gnu::noinline]] void operator delete(void* place, std::size_t) noexcept {
  std::free(place);
}
[[gnu::noinline]] void operator delete(void* place, std::align_val_t) noexcept {
  std::free(place);
}
[[gnu::noinline]] void operator delete(void* place, std::size_t, std::align_val_t) noexcept {
  std::free(place);
}

namespace {

using namespace info;

// Two seconds of all modules: a control cycle, with new samples and new estimates, allocates
// nothing; nor do arm and receiver.
template <class S>
void expectNoAllocations(const ActiveEstimationTask& task) {
  detail::Exchange<S> exchange(detail::sampleCapacity(task));
  detail::ArmModule<S> arm(task, exchange);
  detail::ReceiverModule<S> receiver(exchange);
  detail::EstimatorModule<S> estimator(task, exchange);
  detail::ControllerModule<S> controller(task, exchange);
  long inControl = 0, inArm = 0, before = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    if (tick % 500 == 499) estimator.cycle(0.001 * tick);
    Eigen::internal::set_is_malloc_allowed(false);
    before = allocations;
    arm.tick();
    if (tick % 10 == 0) receiver.cycle();
    inArm += allocations - before;
    before = allocations;
    if (tick % 20 == 0) controller.cycle(0.001 * tick);
    inControl += allocations - before;
    Eigen::internal::set_is_malloc_allowed(true);
  }
  EXPECT_EQ(inControl, 0);
  EXPECT_EQ(inArm, 0);
  EXPECT_EQ(controller.observed().size(), 199u);
  EXPECT_GT(controller.actions(), 50u);
  EXPECT_GT(before, 0);
}

TEST(SequentialActionControl, AllocatesNothingInAControlCycle) {
  ActiveEstimationTask task;
  expectNoAllocations<FreeParameters<SuspendedMass, 1>>(task);
  task.action.searchTime = true;
  task.estimateMass = true;
  expectNoAllocations<FreeParameters<SuspendedMass, 0, 1>>(task);
}

}  // namespace
