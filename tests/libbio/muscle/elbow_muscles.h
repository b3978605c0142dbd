#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "bio/muscle/schutte_muscle.h"
#include "support/elbow_curves.h"

/// The eight muscles of an elbow of Schutte's class, and states that they can be in.
namespace elbow_muscles {

using bio::SchutteCurves;
using bio::SchutteMuscle;
using bio::SchutteOptions;
using bio::SchutteParameters;

inline const std::vector<SchutteParameters>& elbowMuscles() {
  static const std::vector<SchutteParameters> muscles = {
      support::elbowMuscle(771.8, 0.134, 0.143, 0.20943951),
      support::elbowMuscle(717.5, 0.1138, 0.098, 0.15707963),
      support::elbowMuscle(717.5, 0.1138, 0.0908, 0.15707963),
      support::elbowMuscle(283.2, 0.027, 0.018, 0),
      support::elbowMuscle(525.1, 0.1157, 0.2723, 0),
      support::elbowMuscle(316.8, 0.1321, 0.1923, 0),
      support::elbowMuscle(1177.37, 0.0858, 0.0535, 0),
      support::elbowMuscle(276, 0.1726, 0.133, 0)};
  return muscles;
}

struct State {
  double activation, fibreLength, muscleTendonLength;
};

/// A state in the working range, off the kinks by chance.
inline State randomState(std::mt19937& random, const SchutteParameters& p,
                         double maxStrain = 0.05) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double activation = 0.01 + 0.98 * unit(random);
  const double fibre = p.optimalFibreLength * (0.5 + unit(random));
  const double thickness = p.optimalFibreLength * std::sin(p.pennation);
  const double strain = -0.01 + (maxStrain + 0.01) * unit(random);
  const double length =
      std::sqrt(fibre * fibre - thickness * thickness) + p.tendonSlackLength * (1 + strain);
  return {activation, fibre, length};
}

struct Compiled {
  SchutteCurves curves;
  SchutteMuscle<double> muscle;
  explicit Compiled(const SchutteParameters& p, SchutteOptions options = {})
      : curves(p), muscle(bio::schutteQuantities(p), curves, options) {}
};

}  // namespace elbow_muscles
