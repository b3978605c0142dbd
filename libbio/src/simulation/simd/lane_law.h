#pragma once

// What the muscles' laws in lanes are made of: numbers side by side, and the curves of every lane.
// Plain data, so that files of several instruction sets can read it.

#include <cstddef>

#include "simulation/simd/lane_model.h"

namespace bio::muscles {
template <class T, std::size_t n>
class BezierCurve;
template <class T>
class MillardSpeed;
}  // namespace bio::muscles

namespace bio::lanes {

/// A piecewise cubic, and the piece of it that holds each lane's x: lower ≤ x < upper.
struct CubicPiece {
  Real lower, upper;
  Real start, value, slope, quadratic, cubic;  ///< of PiecewiseCubic::Segment
  const PiecewiseCubic* of[width];
};

/// A curve of Bézier sections, and the cell of it that holds each lane's x; a straight line counts
/// as a section, u = x − start.
template <std::size_t n>
struct BezierPiece {
  Real lower, upper;
  Real start, per;  ///< of BezierCurve::Cell
  Real place[6];
  Real x[6], y[6];  ///< the section in powers of u
  const muscles::BezierCurve<double, n>* of[width];
};

/// Millard's force–velocity curve, and the cell of MillardSpeed that holds each lane's P.
struct SpeedPiece {
  Real lowX, lowY, highX, highY;  ///< of SpeedCell
  Real lowSpeedX, lowSpeedY, highSpeedX, highSpeedY;
  Real lowest, cellWidth;
  Real x[6], y[6];
  Real beginX, beginY, endX, endY;  ///< of all cells
  const muscles::BezierCurve<double, 4>* curve[width];
  const muscles::MillardSpeed<double>* of[width];
};

/// A straight line through (x, y).
struct LineNumbers {
  Real x, y, slope;
};

enum class LaneClass { schutte, thelen, millard, deGroote, rigidTendon };

/// The most properties of a class.
inline constexpr std::size_t mostLawNumbers = 40;

/// A muscle's law.
struct LawNumbers {
  LaneClass law;
  /// In the order of the class's properties; of Schutte's those of MuscleQuantity, then the
  /// activation floor.
  Real numbers[mostLawNumbers];
  bool ignoresTendonCompliance;
  bool clampsForce, hasPassiveCurve;  ///< Schutte's
  bool ignoresPassiveForce;           ///< De Groote's
  CubicPiece cubics[3];  ///< Schutte's tendon, active, passive; RigidTendonMuscle's active,
                         ///< passive, velocity
  Real damping;          ///< B of Millard's
  BezierPiece<2> tendon, passive;
  BezierPiece<5> active;
  BezierPiece<4> forceVelocity;
  LineNumbers firstSpeed, lastSpeed;
  SpeedPiece speed;
};

/// Whether two muscles are of one class and form, so that lanes can hold them side by side.
bool sameForm(const SimulatedMuscle& a, const SimulatedMuscle& b);

/// The law of a muscle in every lane, all of one form.
void gather(const SimulatedMuscle* const (&of)[width], LawNumbers& law);

// Find the pieces again that hold x, or P, where a lane has left its own.
void movePieces(CubicPiece& curve, const Real& x);
template <std::size_t n>
void movePieces(BezierPiece<n>& curve, const Real& x);
void movePieces(SpeedPiece& curve, const Mask& wanted, const Real& P, const Real& A, const Real& B);

/// u of every lane's x to rounding, in place of those that the table has.
template <std::size_t n>
void refinePlaces(const BezierPiece<n>& curve, const Real& x, Real& u);

}  // namespace bio::lanes
