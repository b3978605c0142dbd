#include "info/realtime/periodic.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cmath>
#include <thread>

namespace info {
namespace {

/// Sleeps in naps of at most a tenth of a second; false: stopped before the time has come.
bool sleepUntil(Clock::time_point due, const std::stop_token& stop) {
  constexpr auto nap = std::chrono::milliseconds(100);
  while (!stop.stop_requested()) {
    const bool last = due - Clock::now() <= nap;
    std::this_thread::sleep_until(last ? due : Clock::now() + nap);
    if (last) return !stop.stop_requested();
  }
  return false;
}

}  // namespace

void CycleTimes::add(double late, double busy, double period) {
  ++cycles_;
  worstLate_ = std::max(worstLate_, late);
  if (late + busy > period) ++misses_;
  if (busy_.size() < busy_.capacity()) busy_.push_back(busy);
}

DeadlineReport CycleTimes::report() const {
  DeadlineReport out{cycles_, misses_, skipped_, 0, 0, worstLate_};
  if (busy_.empty()) return out;
  std::vector<double> sorted = busy_;
  std::sort(sorted.begin(), sorted.end());
  out.median = sorted[sorted.size() / 2];
  out.worst = sorted.back();
  return out;
}

void runPeriodically(Clock::time_point start, Clock::time_point end, double period,
                     CycleTimes& times, const std::function<bool(std::size_t)>& body,
                     const std::stop_token& stop) {
  const auto step =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period));
  const auto seconds = [](Clock::duration d) { return std::chrono::duration<double>(d).count(); };
  for (std::size_t cycle = 0;;) {
    const Clock::time_point due = start + static_cast<Clock::rep>(cycle) * step;
    if (due >= end) return;
    if (!sleepUntil(due, stop)) return;
    const Clock::time_point woke = Clock::now();
    const bool more = body(cycle);
    const Clock::time_point done = Clock::now();
    times.add(seconds(woke - due), seconds(done - woke), period);
    if (!more) return;
    const auto next = static_cast<std::size_t>((done - start) / step) + 1;
    if (next > cycle + 1) times.skip(next - cycle - 1);
    cycle = next;
  }
}

bool askForRealTime(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

}  // namespace info
