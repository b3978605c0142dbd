#pragma once

// What the step of lane_step.h works on: arms with one hinge and the same structure, their numbers
// side by side. Plain data and pointers, so that files of several instruction sets can read it.

#include "lanes/lane_real.h"

namespace bio {
class CoordinateForces;
class PiecewiseCubic;
}  // namespace bio

namespace bio::lanes {

/// A curve, and the piece of it that holds each lane's x: lower ≤ x < upper.
template <class T>
struct Curve {
  T lower, upper;
  T start, value, slope, quadratic, cubic;  ///< of PiecewiseCubic::Segment
  const PiecewiseCubic* of[width];
};

/// A point that turns with the hinge, seen from a frame: middle + along cos q + across sin q [m].
template <class T>
struct Turning {
  T middle[3], along[3], across[3];
};

/// A cylinder that a span may go round.
template <class T>
struct Cylinder {
  int surface;         ///< its place in the muscle's path
  bool fixed[2];       ///< whether that end does not move
  T side;              ///< 1 or −1
  T radius;            ///< [m]
  T halfLength;        ///< [m]
  Turning<T> ends[2];  ///< in the cylinder's frame
};

/// Between two points of a path. Straight, its square is constant + cosine·cos q + sine·sin q [m²].
template <class T>
struct LaneSpan {
  T constant, cosine, sine;
  int firstCylinder, numCylinders;  ///< tried in this order
};

/// The path under some of its conditions.
template <class T>
struct Variant {
  T fixedLength;  ///< [m]
  int firstSpan, numSpans;
};

/// Holds where lower ≤ q ≤ upper.
template <class T>
struct Condition {
  T lower, upper;
};

/// See SchutteMuscle.
template <class T>
struct LaneMuscle {
  T force, perFibre, perTendon, speedScale, thickness, damping, activationFloor;
  bool clampsForce, hasPassiveCurve;
  Curve<T> tendon, active, passive;
  int firstCondition, numConditions;
  int firstVariant;  ///< one per set of conditions that hold, by their bits
};

template <class T>
struct LaneArm {
  int numMuscles;
  T mass;                       ///< M [kg m²]
  T gravityCosine, gravitySine;  ///< V = gravityCosine·cos q + gravitySine·sin q [J]
  bool hasForces;               ///< passive ones of the coordinate
  const CoordinateForces* forces[width];
  LaneMuscle<T>* muscles;
  const Condition<T>* conditions;
  const Variant<T>* variants;
  const LaneSpan<T>* spans;
  const Cylinder<T>* cylinders;
};

/// The most cylinders of a muscle.
inline constexpr int maxCylinders = 8;

/// What a muscle comes to in an iteration, for the steps after it.
struct MuscleStep {
  Real momentArm;  ///< dL/dq [m]
  Real dV_dMuscleTendonLength, dF_dFibreLength;
  Real inverse, residual;
};

/// A step of every lane: what is given, what comes out.
struct LaneStep {
  // given
  Mask wanted;
  Real length;      ///< h [s]
  Real q, p;        ///< at the begin
  Real external;    ///< force at the middle of the step [N m]
  Real* fibreLength;
  Real* activation;  ///< at the middle of the step
  double newtonTolerance;
  int maxIterations;
  bool symmetric;  ///< forces on both ends of the step
  // the first guess, then the end; garbage where it did not converge
  Real qEnd;
  Real* fibreLengthEnd;
  // out
  Real pEnd;
  Mask converged;
  int iterations[width];
  Real muscleWork, passiveWork, externalWork;  ///< [J]
  MuscleStep* muscles;                         ///< room for all
};

/// Newton's iteration of VariationalStepper for every lane that is wanted. One per instruction set,
/// all with the same results: they round alike, since nothing is fused.
void solvePlain(const LaneArm<Real>& arm, LaneStep& step);
void solveWide(const LaneArm<Real>& arm, LaneStep& step);

// What the step asks for rarely, or from laws without lanes -----------------------------------------

/// Finds the pieces that hold x again where a lane has left its own.
void movePieces(Curve<Real>& curve, const Real& x);

/// exp(8l − 12), its slope beside it.
void exponentialPassiveForce(const Real& l, Real& value, Real& slope);

/// Whether the way between the ends over a cylinder of finite length touches it within its ends.
bool touchesWithin(const Cylinder<Real>& cylinder, const Real (&P)[3], const Real (&Q)[3],
                   int lane);

/// Force, ∂/∂q and ∂/∂q̇ of the passive coordinate forces in the lanes asked for, else 0.
struct PassiveForce {
  Real force, dForce_dq, dForce_dqDot;
};
void passiveForce(const LaneArm<Real>& arm, const Mask& lanes, const Real& q, const Real& qDot,
                  PassiveForce& out);

}  // namespace bio::lanes
