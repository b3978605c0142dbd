#pragma once

#include "bio/model/model.h"

namespace support {

/// The curves that the eight elbow muscles share (MoBL-ARMS, Saul et al. 2015), with the passive
/// curve's knot at 1.15 given twice, as the file has it.
inline bio::SchutteParameters elbowCurves() {
  bio::SchutteParameters p;
  p.timeScale = 0.1;
  p.damping = 0.017;
  p.tendonForceLength = {{-10, -0.002, -0.001, 0, 0.00131, 0.00281, 0.00431, 0.00581, 0.00731,
                          0.00881, 0.0103, 0.0118, 0.0123, 9.2, 9.201, 9.202, 20},
                         {0, 0, 0, 0, 0.0108, 0.0257, 0.0435, 0.0652, 0.0915, 0.123, 0.161, 0.208,
                          0.227, 345, 345, 345, 345}};
  p.activeForceLength = {
      {-35, 0, 0.401, 0.402, 0.4035, 0.52725, 0.62875, 0.71875, 0.86125, 1.045, 1.2175, 1.43875,
       1.61875, 1.62, 1.621, 2.2, 35},
      {0, 0, 0, 0, 0, 0.226667, 0.636667, 0.856667, 0.95, 0.993333, 0.77, 0.246667, 0, 0, 0, 0, 0}};
  p.passiveForceLength =
      bio::SplineFunction{{-35, 1, 1.05, 1.1, 1.125, 1.14, 1.145, 1.15, 1.15, 1.25, 1.35, 1.45,
                           1.55, 1.65, 1.75, 1.7501, 1.7502, 35},
                          {0, 0, 0, 0, 0, 0, 0, 0, 0, 0.035, 0.12, 0.26, 0.55, 1.17, 2, 2, 2, 2}};
  return p;
}

/// One of the eight muscles by its four numbers.
inline bio::SchutteParameters elbowMuscle(double force, double fibre, double tendon,
                                          double pennation) {
  bio::SchutteParameters p = elbowCurves();
  p.maxIsometricForce = force;
  p.optimalFibreLength = fibre;
  p.tendonSlackLength = tendon;
  p.pennation = pennation;
  return p;
}

inline bio::SchutteParameters tricepsLongHead() {
  return elbowMuscle(771.8, 0.134, 0.143, 0.20943951);
}

}  // namespace support
