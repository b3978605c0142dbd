#pragma once

// What the step of lane_step.h works on: systems with one hinge and the same structure, their
// numbers side by side. Plain data and pointers, so that files of several instruction sets can read
// it.

#include "simulation/simd/lane_real.h"

namespace bio {
class CoordinateForces;
class PiecewiseCubic;
class SimulatedMuscle;
}  // namespace bio

namespace bio::lanes {

/// A point that turns with the hinge, seen from a frame: middle + along cos q + across sin q [m].
template <class Of>
struct Turning {
  using T = typename Of::Number;
  T middle[3], along[3], across[3];
};

/// A cylinder that a span may go round.
template <class Of>
struct Cylinder {
  using T = typename Of::Number;
  int surface;    ///< its place in the muscle's path
  bool fixed[2];  ///< whether that end does not move
  T side;         ///< 1 or −1
  T radius;       ///< [m]
  T halfLength;   ///< [m]
  T slipCosine;   ///< of the slip angle
  T slipSine;
  Turning<Of> ends[2];  ///< in the cylinder's frame
};

/// Between two points of a path. Straight, its square is constant + cosine·cos q + sine·sin q [m²].
template <class Of>
struct LaneSpan {
  using T = typename Of::Number;
  T constant, cosine, sine;
  int firstCylinder, numCylinders;  ///< tried in this order
};

/// The path under some of its conditions.
template <class Of>
struct Variant {
  using T = typename Of::Number;
  T fixedLength;  ///< [m]
  int firstSpan, numSpans;
};

/// Holds where lower ≤ q ≤ upper.
template <class Of>
struct Condition {
  using T = typename Of::Number;
  T lower, upper;
};

template <class Of>
struct LaneMuscle {
  using T = typename Of::Number;
  const SimulatedMuscle* of[Of::width];  ///< its law (lane_law.h)
  bool hasFibreState;
  T perFibre;  ///< 1/ℓ0 [1/m]
  int firstCondition, numConditions;
  int firstVariant;  ///< one per set of conditions that hold, by their bits
};

template <class Of>
struct LaneModel {
  using T = typename Of::Number;
  int numMuscles;
  T mass;                        ///< M [kg m²]
  T gravityCosine, gravitySine;  ///< V = gravityCosine·cos q + gravitySine·sin q [J]
  bool hasForces;                ///< passive ones of the coordinate
  const CoordinateForces* forces[Of::width];
  LaneMuscle<Of>* muscles;
  const Condition<Of>* conditions;
  const Variant<Of>* variants;
  const LaneSpan<Of>* spans;
  const Cylinder<Of>* cylinders;
};

/// The most cylinders of a muscle.
inline constexpr int maxCylinders = 8;

/// A step of one muscle.
template <class Of>
struct MuscleStep {
  using Real = typename Of::Number;
  // given
  Real fibreLength;     ///< at the begin [m]
  Real activation;      ///< at the middle of the step
  Real fibreLengthEnd;  ///< the first guess, then the end [m]
  // of the last iteration
  Real momentArm;  ///< dL/dq [m]
  Real dV_dMuscleTendonLength, dF_dFibreLength;
  Real inverse, residual;
};

/// A step of every lane: what is given, what comes out.
template <class Of>
struct LaneStep {
  using Real = typename Of::Number;
  using Mask = typename Of::Mask;
  // given
  Mask wanted;    ///< stays so until it is done
  Real length;    ///< h [s]
  Real q, p;      ///< at the begin
  Real external;  ///< force at the middle of the step [N m]
  double newtonTolerance;
  int maxIterations;
  bool symmetric;  ///< forces on both ends of the step
  // the first guess, then the end; garbage where it did not converge
  Real qEnd;
  // of the iteration, before its first 0, 0 and NaN
  int iterations[Of::width];
  Real previous;  ///< largest correction of the one before
  Real place;     ///< q where paths' conditions were last looked at
  // out
  Mask done;  ///< wanted, and now finished or given up
  Mask converged;
  Real pEnd;
  Real muscleWork, passiveWork, externalWork;  ///< [J]
  MuscleStep<Of>* muscles;                     ///< all of the system
};

/// The solver of steps of some systems.
template <class Of>
class LaneSolver {
 public:
  LaneSolver() = default;
  virtual ~LaneSolver() = default;
  LaneSolver(const LaneSolver&) = delete;
  LaneSolver& operator=(const LaneSolver&) = delete;
  /// Newton's iteration of VariationalStepper for every lane that is wanted, until one of them is
  /// done; the others go on in the next call.
  virtual void solve(LaneStep<Of>& step) = 0;
};
/// Made with `new`; what the model points to must outlive it. One per instruction set, all with the
/// same results: they round alike, since nothing is fused.
LaneSolver<Lanes<4>>* plainSolver(const LaneModel<Lanes<4>>& system);
LaneSolver<Lanes<4>>* avx2Solver(const LaneModel<Lanes<4>>& system);
LaneSolver<Lanes<8>>* avx512Solver(const LaneModel<Lanes<8>>& system);

// What the step asks for rarely; for four and eight lanes
// -----------------------------------------

/// Whether the way between the ends over a cylinder of finite length touches it within its ends.
template <class Of>
bool touchesWithin(const Cylinder<Of>& cylinder, const typename Of::Number (&P)[3],
                   const typename Of::Number (&Q)[3], int lane);

/// Force, ∂/∂q and ∂/∂q̇ of the passive coordinate forces in the lanes asked for, else 0.
template <class Of>
struct PassiveForce {
  typename Of::Number force, dForce_dq, dForce_dqDot;
};
template <class Of>
void passiveForce(const LaneModel<Of>& system, const typename Of::Mask& lanes,
                  const typename Of::Number& q, const typename Of::Number& qDot,
                  PassiveForce<Of>& out);

}  // namespace bio::lanes
