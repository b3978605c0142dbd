#pragma once

#include "discovery/first_part.h"

namespace bio::fixtures {

/// The beginning of a trial.
inline Trial cut(const Trial& trial, double seconds) {
  return discover::partUntil(trial, seconds + 1e-9);
}

}  // namespace bio::fixtures
