#include "ensemble/worker_pool.h"

#include <algorithm>
#include <mutex>

#include "info/parallel_for.h"

namespace app {

void inBatches(const RowWork& work, std::span<const std::uint64_t> numbers, int threads,
               const std::function<void(std::uint64_t, const std::string&)>& take) {
  const std::size_t batches = (numbers.size() + work.together - 1) / work.together;
  info::parallelFor(static_cast<int>(batches), threads, [&](int i) {
    const std::size_t first = static_cast<std::size_t>(i) * work.together;
    const auto batch = numbers.subspan(first, std::min(work.together, numbers.size() - first));
    const std::vector<std::string> rows = work.rows(batch);
    for (std::size_t k = 0; k < batch.size(); ++k) take(batch[k], rows[k]);
  });
}

namespace {

class ThreadPool : public WorkerPool {
 public:
  bool leads() const override { return true; }
  int ranks() const override { return 1; }
  int defaultThreads(const CommandContext& context) const override { return context.threads; }
  bool start() override { return true; }

  void work(const RowWork& work, int threads) override {
    std::mutex taking;
    inBatches(work, work.numbers, threads, [&](std::uint64_t number, const std::string& row) {
      const std::lock_guard lock(taking);
      work.take(number, row);
    });
  }
};

}  // namespace

std::unique_ptr<WorkerPool> threadPool() {
  return std::make_unique<ThreadPool>();
}

}  // namespace app
