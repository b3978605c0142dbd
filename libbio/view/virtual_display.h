#pragma once

#include <memory>

#include "view/child_process.h"

namespace bio::view {

/// An X display to draw on: the one that DISPLAY names if it answers, else an Xvfb started here,
/// which ends with this object. DISPLAY is set for this program as long as the object lives.
class VirtualDisplay {
 public:
  /// @throws std::runtime_error if there is no display and Xvfb is absent or does not start
  VirtualDisplay();
  ~VirtualDisplay();
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  /// The Xvfb started here; null if a display was there already.
  const ChildProcess* server() const { return server_.get(); }

 private:
  std::unique_ptr<ChildProcess> server_;
};

}  // namespace bio::view
