#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "reduced/reduced_elbow.h"

namespace reduced {

/// What one data set is made of.
struct Recipe {
  /// Hidden effects by id of the catalogue, or of what it lacks: cubic, powerdamp, qdamp, tremor,
  /// hysteresis, flwidth. Sizes are amplitudes in the effect's own unit; of a parameter the factor.
  std::vector<std::pair<std::string, double>> effects;
  double emgNoise = 0;  ///< relative, 80 ms Ornstein–Uhlenbeck, of what the muscles get
  double outputNoise = 0.5 * 0.017453292519943295;  ///< [rad]
  /// Parameters drawn from their tolerances, those beyond 2.5 deviations again; false: nominal
  bool nuisances = true;
  int trials = 3;
  double seconds = 4.6;
};

/// Size 1 of an effect, in its unit; what benchmarks multiply.
double fullSize(const std::string& effect);

/// Draws targets, lets a feedback controller in the true system track them, and records excitations
/// and noisy angle. The true system is code of its own, solved in steps of 0.5 ms.
std::vector<Trial> record(const Recipe& recipe, std::uint64_t seed);

}  // namespace reduced
