#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "bio/simulation/musculoskeletal_system.h"
#include "simulation/switch_crossing.h"

namespace bio::stepping {

/// Whether a length jumps by more than 1e-5 m where a path gains or loses points.
/// @param configuration  of the system; is moved
/// @param q              on the switch
template <int N>
bool lengthJumps(SystemConfiguration<N>& configuration, const MusculoskeletalSystem& arm,
                 const PathSwitch& met, const typename SystemConfiguration<N>::Vector& q) {
  constexpr double noticeable = 1e-5;
  std::vector<double> lengths(arm.numPaths());
  configuration.moveTo(beyondSwitch(met, q, 1));
  for (std::size_t i = 0; i < lengths.size(); ++i) lengths[i] = configuration.length(i).length;
  configuration.moveTo(beyondSwitch(met, q, -1));
  double largest = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    largest = std::max(largest, std::abs(configuration.length(i).length - lengths[i]));
  }
  return largest > noticeable;
}

}  // namespace bio::stepping
