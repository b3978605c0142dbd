#include "ensemble/worker_pool.h"

#include <algorithm>
#include <mutex>

#include "info/parallel_for.h"

namespace app {

void RowNumbers::add(std::uint64_t number) {
  if (ranges_.empty() || ranges_.back().first + (size_ - ranges_.back().place) != number)
    ranges_.push_back({number, size_});
  ++size_;
}

std::vector<std::uint64_t> RowNumbers::part(std::size_t first, std::size_t count) const {
  std::vector<std::uint64_t> numbers;
  auto range = std::ranges::upper_bound(ranges_, first, {}, &Range::place);
  const std::size_t last = std::min(size_, first + count);
  for (std::size_t place = first; place < last; ++place) {
    if (range != ranges_.end() && range->place == place) ++range;
    numbers.push_back((range - 1)->first + (place - (range - 1)->place));
  }
  return numbers;
}

void inBatches(const RowWork& work, const RowNumbers& numbers, int threads,
               const std::function<void(std::uint64_t, const std::string&)>& take) {
  const std::size_t batches = (numbers.size() + work.together - 1) / work.together;
  info::parallelFor(static_cast<int>(batches), threads, [&](int i) {
    const std::size_t first = static_cast<std::size_t>(i) * work.together;
    const std::vector<std::uint64_t> batch = numbers.part(first, work.together);
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
