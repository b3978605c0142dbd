#include "bio/muscle/fibre_rest.h"

#include <fmt/format.h>

namespace bio::muscles {

const char* describe(FibreRest::Why why) {
  switch (why) {
    case FibreRest::Why::found:
      return "fibre and tendon force balance";
    case FibreRest::Why::forceFree:
      return "neither fibre nor tendon carries force; the tendon is just slack";
    case FibreRest::Why::held:
      return "the fibre is held at the least length of its class";
    case FibreRest::Why::tendonTooShort:
      return "the muscle is shorter than its slack tendon, so nothing holds the fibre";
    case FibreRest::Why::notBracketed:
      return "no fibre length balances the tendon";
  }
  return "";
}

void requireFiniteRest(double activation, double pathLength) {
  if (!std::isfinite(activation)) {
    throw std::invalid_argument(fmt::format("activation is {}, must be finite", activation));
  }
  if (!std::isfinite(pathLength)) {
    throw std::invalid_argument(fmt::format("path length is {} m, must be finite", pathLength));
  }
}

}  // namespace bio::muscles
