#pragma once

#include <functional>

namespace info {

/// body(0) … body(n−1) on at most `threads` threads (0: all cores). An exception in a body ends the
/// loop and is rethrown.
void parallelFor(int n, int threads, const std::function<void(int)>& body);

}  // namespace info
