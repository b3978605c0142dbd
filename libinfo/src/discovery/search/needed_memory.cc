#include "info/discovery/search/needed_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>

namespace info::discover {
namespace {

// The number behind a word at the beginning of a line; empty: there is none.
std::optional<double> numberAfter(const char* file, const std::string& word) {
  std::ifstream in(file);
  for (std::string first; in >> first;) {
    double value = 0;
    if (first == word && in >> value) return value;
    in.clear();
    in.ignore(1000, '\n');
  }
  return std::nullopt;
}

std::optional<double> onlyNumber(const char* file) {
  std::ifstream in(file);
  double value = 0;
  return in >> value ? std::optional(value) : std::nullopt;  // "max": no limit
}

}  // namespace

double neededMemory(const DiscoveryProblem& data, const std::vector<int>& trials) {
  double numbers = 0;
  for (const int t : trials) {
    numbers +=
        static_cast<double>(data.times(t).size()) * static_cast<double>(data.nodes(t).size());
  }
  return 4 * sizeof(double) * numbers;
}

double availableMemory() {
  double bytes = HUGE_VAL;
  if (const auto free = numberAfter("/proc/meminfo", "MemAvailable:")) bytes = 1024 * *free;
  const auto most = onlyNumber("/sys/fs/cgroup/memory.max");
  const auto used = onlyNumber("/sys/fs/cgroup/memory.current");
  if (most && used) bytes = std::min(bytes, std::max(0.0, *most - *used));
  return bytes;
}

void requireMemory(const DiscoveryProblem& data, const std::vector<int>& trials, double available) {
  const double needed = neededMemory(data, trials);
  if (!(needed > available)) return;
  double longest = 0;
  for (const int t : trials) {
    const auto& times = data.times(t);
    if (!times.empty()) longest = std::max(longest, times.back() - times.front());
  }
  throw std::invalid_argument(fmt::format(
      "the search needs {:.1f} GB of memory and {:.1f} GB are available: it grows with the square "
      "of a trial's length, and the longest lasts {:.4g} s; cut it into several shorter trials",
      needed / 1e9, available / 1e9, longest));
}

}  // namespace info::discover
