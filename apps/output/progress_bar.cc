#include "output/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "output/interruption.h"
#include "output/standard_streams.h"

namespace app {
namespace {

std::string durationText(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace

std::string progressLine(const std::string& label, double fraction, double elapsedSeconds) {
  constexpr int width = 30;
  fraction = fraction >= 0 ? std::min(fraction, 1.0) : 0;
  const auto full = static_cast<int>(fraction * width);
  // Too little done says nothing about the rest.
  const std::string left =
      fraction > 0.01 ? durationText(elapsedSeconds * (1 - fraction) / fraction) + " left" : "";
  return fmt::format("{} [{:#<{}}{:.<{}}] {:3.0f} %  {}", label, "", full, "", width - full,
                     100 * fraction, left);
}

ProgressBar::ProgressBar(std::string label, bool quiet)
    : label_(std::move(label)), visible_(!quiet && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (visible_ && drawn_ != start_) tell("\r\033[K");
}

void ProgressBar::update(double fraction) {
  stopIfInterrupted();
  if (!visible_) return;
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  tell(fmt::format("\r{}\033[K", progressLine(label_, fraction, elapsed)));
}

}  // namespace app
