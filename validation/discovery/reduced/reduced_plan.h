#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reduced/reduced_truth.h"

namespace reduced {

/// A data set of the reduced elbow's benchmark, as make_hidden_elbow's plan is one of the large
/// elbow's. Everything else follows from the seed.
struct Plan {
  std::uint64_t seed = 0;
  /// null, single, parameter, two, equivalents or out; what they hide: reduced_elbow.md
  std::string suite = "null";
  std::string effect;  ///< id of the first that is hidden; empty: by seed
  double size = 1;     ///< share of the full size; of a parameter 5 of its tolerances
  double emgNoise = 0;
  int trials = 4;  ///< the last one is held out
  double seconds = 4.6;
};

struct DataSet {
  Recipe recipe;
  std::vector<Trial> trials;
  /// For the scorer alone (discovery_score.h): suite, size, emg_noise, effects with their
  /// amplitudes and declared equivalents. A parameter has no amplitude there: it was drawn within
  /// its tolerance as well.
  nlohmann::ordered_json label;

  std::vector<std::string> hidden() const;  ///< ids
  /// These and their declared equivalents: what a catalogue must lack that has no name for them.
  std::vector<std::string> explaining() const;
};

/// @throws std::invalid_argument for an unknown suite or effect; std::domain_error if the arm goes
///   out of range, a seed that is to be left out
DataSet makeDataSet(const Plan& plan);

}  // namespace reduced
