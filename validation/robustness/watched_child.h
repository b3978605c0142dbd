#pragma once

#include <functional>
#include <string>

namespace robustness {

/// How a piece of work ended.
struct WatchedEnd {
  bool finished = false;  ///< the work returned
  std::string answer;     ///< what it returned, if it did; else how it ended, one line
};

/// Items of work, one after the other in a child process that may crash, hang or eat memory
/// without harm: it is then replaced by a new one for the items that are left.
/// @param count    how many items
/// @param work     item → one line; run in the child
/// @param ended    called here for every item, in order
/// @param limit_s  an item that takes longer is ended
/// @param limit_MiB memory that the child may take beyond what it has at the start
void runWatched(long count, const std::function<std::string(long)>& work,
                const std::function<void(long, const WatchedEnd&)>& ended, int limit_s = 5,
                long limit_MiB = 1024);

}  // namespace robustness
