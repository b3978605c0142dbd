#pragma once

// Not public.

#include <stdexcept>
#include <string>

namespace bio {

/// @throws std::invalid_argument with the message unless the rule holds
inline void require(bool holds, const std::string& message) {
  if (!holds) throw std::invalid_argument(message);
}

}  // namespace bio
