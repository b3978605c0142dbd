#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "bio/muscle/bracketed_root.h"
#include "bio/muscle/muscle_variant.h"

/// Muscles and states that the tests of every muscle class run over.
namespace support {

/// A muscle class as tests take it: its shape in any number type, and the sets of numbers tried.
struct ThelenClass {
  template <class T>
  using Shape = bio::muscles::Thelen2003<T>;
  template <class T>
  using Parameters = bio::muscles::Thelen2003Parameters<T>;
  static std::vector<Parameters<double>> numbers() {
    Parameters<double> usual;
    usual.pennation = 0.3;
    Parameters<double> gait = usual;
    gait.tendonStrainAtMaxForce = 0.033;
    gait.activeWidth = 0.5;
    gait.passiveShape = 4;
    gait.velocityShape = 0.3;
    gait.maxLengtheningForce = 1.8;
    return {usual, gait};
  }
};

struct MillardClass {
  template <class T>
  using Shape = bio::muscles::Millard2012<T>;
  template <class T>
  using Parameters = bio::muscles::Millard2012Parameters<T>;
  static std::vector<Parameters<double>> numbers() {
    Parameters<double> damped;
    damped.pennation = 0.25;
    Parameters<double> undamped = damped;
    undamped.fibreDamping = 0;
    undamped.minActiveForce = 0.15;
    Parameters<double> mobl = damped;
    mobl.minActiveLength = 0.4327;
    mobl.transitionLength = 0.728;
    mobl.maxActiveLength = 1.595;
    mobl.shallowSlope = 0.4613;
    mobl.minActiveForce = 0;
    mobl.passiveShapeIsGiven = mobl.tendonShapeIsGiven = true;
    mobl.passiveUnitStrain = 0.6405;
    mobl.passiveLowStiffness = 0.0751;
    mobl.passiveUnitStiffness = 6.3163;
    mobl.passiveCurviness = 0.6658;
    mobl.tendonUnitStrain = 0.033;
    mobl.tendonUnitStiffness = 37.393;
    mobl.tendonToeForce = 0.2255;
    mobl.tendonCurviness = 0.4504;
    return {damped, undamped, mobl};
  }
};

struct DeGrooteClass {
  template <class T>
  using Shape = bio::muscles::DeGrooteFregly2016<T>;
  template <class T>
  using Parameters = bio::muscles::DeGrooteFregly2016Parameters<T>;
  static std::vector<Parameters<double>> numbers() {
    Parameters<double> usual;
    usual.pennation = 0.2;
    Parameters<double> damped = usual;
    damped.fibreDamping = 0.1;
    damped.activeWidth = 1.2;
    Parameters<double> active = usual;
    active.ignorePassiveFibreForce = true;
    return {usual, damped, active};
  }
};

struct MuscleState {
  double activation, fibreLength, pathLength;
  double fibreVelocity;  ///< [m/s] at which the muscle balances; tendons below slack: any
  double pathSpeed;      ///< [m/s]
};

/// States in balance at fibre speeds of −1.2 … 1.2 of the largest, over the lengths that muscles
/// have, and every eighth with a slack tendon.
template <class Shape>
std::vector<MuscleState> muscleStates(const bio::muscles::HillMuscle<Shape>& muscle, int count,
                                      unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto& p = muscle.parameters();
  const Shape& shape = muscle.shape();
  std::vector<MuscleState> states;
  while (states.size() < static_cast<std::size_t>(count)) {
    MuscleState s;
    s.activation = 0.02 + 0.96 * unit(random);
    const double l = 0.6 + 0.85 * unit(random), v = 2.4 * unit(random) - 1.2;
    s.fibreLength = l * p.optimalFibreLength;
    s.fibreVelocity = v * muscle.speedScale();
    s.pathSpeed = 0.6 * unit(random) - 0.3;
    const double d = muscle.projected(s.fibreLength);
    const double fibre =
        s.activation * shape.activeForce(l).value * shape.forceVelocity(v, s.activation).value +
        shape.passiveForce(l).value + shape.damping() * v;
    const double force = fibre * d / s.fibreLength;
    double strain = -0.02 * unit(random);
    if (states.size() % 8 != 0) {
      if (!(force > 1e-3)) continue;
      const auto excess = [&](double x) { return shape.tendonForce(x).value - force; };
      strain = bio::muscles::bracketedRoot(excess, 0.0, excess(0), 0.2, excess(0.2), 1e-16);
    }
    s.pathLength = d + p.tendonSlackLength * (1 + strain);
    states.push_back(s);
  }
  return states;
}

/// |x − y| over the size of the numbers around them.
inline double relativeError(double x, double y, double scale) {
  return std::abs(x - y) / (scale + std::abs(y));
}

}  // namespace support
