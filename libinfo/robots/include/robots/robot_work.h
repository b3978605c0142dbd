#pragma once

#include <functional>

namespace info::robot {

/// Told what long work does and which fraction of that is done, from any thread, one call at a
/// time. An exception ends the work and is rethrown.
using WorkProgress = std::function<void(const char* doing, double fraction)>;

}  // namespace info::robot
