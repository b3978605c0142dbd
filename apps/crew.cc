#include "crew.h"

#include <mutex>

#include "info/monte_carlo.h"

namespace app {
namespace {

class ThreadCrew : public Crew {
 public:
  bool leads() const override { return true; }
  int ranks() const override { return 1; }
  int defaultThreads(const CommandContext& context) const override { return context.threads; }
  bool start() override { return true; }

  void work(const RowWork& work, int threads) override {
    std::mutex taking;
    info::parallelFor(static_cast<int>(work.numbers.size()), threads, [&](int i) {
      const std::uint64_t number = work.numbers[static_cast<std::size_t>(i)];
      const std::string row = work.row(number);
      const std::lock_guard lock(taking);
      work.take(number, row);
    });
  }
};

}  // namespace

std::unique_ptr<Crew> threadCrew() {
  return std::make_unique<ThreadCrew>();
}

}  // namespace app
