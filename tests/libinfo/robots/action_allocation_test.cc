#include <gtest/gtest.h>

#include "active_estimation_modules.h"
#include "support/allocations.h"

namespace {

using namespace info;
using support::allocations;

// Two seconds of all modules: a control cycle, with new samples and new estimates, allocates
// nothing; nor do arm and receiver.
template <class S>
void expectNoAllocations(const ActiveEstimationTask& task) {
  detail::Exchange<S> exchange(detail::sampleCapacity(task));
  detail::ArmModule<S> arm(task, exchange);
  detail::ReceiverModule<S> receiver(exchange);
  detail::EstimatorModule<S> estimator(task, exchange);
  detail::ControllerModule<S> controller(task, exchange);
  long inControl = 0, inArm = 0, inEstimator = 0, before = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    before = allocations();
    if (tick % 500 == 499) estimator.cycle(0.001 * tick);
    inEstimator += allocations() - before;
    before = allocations();
    arm.tick();
    if (tick % 10 == 0) receiver.cycle();
    inArm += allocations() - before;
    before = allocations();
    if (tick % 20 == 0) controller.cycle(0.001 * tick);
    inControl += allocations() - before;
  }
  EXPECT_EQ(inControl, 0);
  EXPECT_EQ(inArm, 0);
  EXPECT_GT(inEstimator, 0);  // it may, and is seen to
  EXPECT_EQ(controller.observed().size(), 199u);
  EXPECT_GT(controller.actions(), 50u);
}

TEST(SequentialActionControl, AllocatesNothingInAControlCycle) {
  ActiveEstimationTask task;
  expectNoAllocations<LengthUnknown>(task);
  task.action.searchTime = true;
  task.estimateMass = true;
  expectNoAllocations<MassAndLengthUnknown>(task);
}

TEST(Allocations, AreCountedWhetherEigenOrNewTakesThem) {
  const long before = allocations();
  Eigen::VectorXd matrix = Eigen::VectorXd::Ones(1000);
  EXPECT_EQ(allocations(), before + 1);
  std::vector<double> vector(1000, 2.0);
  EXPECT_EQ(allocations(), before + 2);
  EXPECT_EQ(matrix.sum() + vector.back(), 1002);
}

}  // namespace
