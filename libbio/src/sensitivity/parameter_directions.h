#pragma once

// Parameters of a catalogue as directions; not public.

#include "bio/parameters/parameters.h"

namespace bio::stepping {

/// One direction per parameter wanted, along all numbers that it sets.
inline std::vector<ParameterDirection> directionsOf(const ParameterCatalogue& catalogue,
                                                    const ParameterCatalogue::Setting& setting,
                                                    const std::vector<std::size_t>& wanted) {
  std::vector<ParameterDirection> directions;
  for (const std::size_t index : wanted) {
    ParameterDirection& direction = directions.emplace_back();
    for (const ParameterTarget& target : catalogue.parameters().at(index).targets) {
      direction.push_back({target, 1, setting.values[static_cast<Eigen::Index>(index)]});
    }
  }
  return directions;
}

}  // namespace bio::stepping
