#include "info/parallel_for.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace info {

struct ThreadLimit::Control {
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(new Control{
          {tbb::global_control::max_allowed_parallelism,
           static_cast<std::size_t>(std::clamp(threads, 1, tbb::info::default_concurrency()))}}) {}

ThreadLimit::~ThreadLimit() = default;

void parallelFor(int n, int threads, const std::function<void(int)>& body) {
  // more than there are cores gains nothing, and TBB complains about it on standard error
  const int cores = tbb::info::default_concurrency();
  tbb::task_arena arena(threads > 0 ? std::min(threads, cores) : cores);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<int>(0, n, 1), [&](const tbb::blocked_range<int>& range) {
      for (int i = range.begin(); i < range.end(); ++i) body(i);
    });
  });
}

}  // namespace info
