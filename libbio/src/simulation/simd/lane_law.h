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
template <class Of>
struct CubicPiece {
  using Real = typename Of::Number;
  Real lower, upper;
  Real start, value, slope, quadratic, cubic;  ///< of PiecewiseCubic::Segment
  const PiecewiseCubic* of[Of::width];
};

/// A curve of Bézier sections, and the cell of it that holds each lane's x; a straight line counts
/// as a section, u = x − start.
template <class Of, std::size_t n>
struct BezierPiece {
  using Real = typename Of::Number;
  Real lower, upper;
  Real start, per;  ///< of BezierCurve::Cell
  Real place[6];
  Real x[6], y[6];  ///< the section in powers of u
  const muscles::BezierCurve<double, n>* of[Of::width];
};

/// Millard's force–velocity curve, and the cell of MillardSpeed that holds each lane's P.
template <class Of>
struct SpeedPiece {
  using Real = typename Of::Number;
  Real lowX, lowY, highX, highY;  ///< of SpeedCell
  Real lowSpeedX, lowSpeedY, highSpeedX, highSpeedY;
  Real lowest, cellWidth;
  Real x[6], y[6];
  Real beginX, beginY, endX, endY;  ///< of all cells
  const muscles::BezierCurve<double, 4>* curve[Of::width];
  const muscles::MillardSpeed<double>* of[Of::width];
};

/// A straight line through (x, y).
template <class Of>
struct LineNumbers {
  typename Of::Number x, y, slope;
};

enum class LaneClass { schutte, thelen, millard, deGroote, rigidTendon };

/// The most properties of a class.
inline constexpr std::size_t mostLawNumbers = 40;

/// A muscle's law.
template <class Of>
struct LawNumbers {
  using Real = typename Of::Number;
  LaneClass law;
  /// In the order of the class's properties; of Schutte's those of MuscleQuantity, then the
  /// activation floor.
  Real numbers[mostLawNumbers];
  bool ignoresTendonCompliance;
  bool clampsForce, hasPassiveCurve;  ///< Schutte's
  bool ignoresPassiveForce;           ///< De Groote's
  CubicPiece<Of> cubics[3];           ///< Schutte's tendon, active, passive; RigidTendonMuscle's
                                      ///< active, passive, velocity
  Real damping;                       ///< B of Millard's
  BezierPiece<Of, 2> tendon, passive;
  BezierPiece<Of, 5> active;
  BezierPiece<Of, 4> forceVelocity;
  LineNumbers<Of> firstSpeed, lastSpeed;
  SpeedPiece<Of> speed;
};

/// Whether two muscles are of one class and form, so that lanes can hold them side by side.
bool sameForm(const SimulatedMuscle& a, const SimulatedMuscle& b);

// For four and eight lanes
// -----------------------------------------

/// The law of a muscle in every lane, all of one form.
template <class Of>
void gather(const SimulatedMuscle* const (&of)[Of::width], LawNumbers<Of>& law);

// Find the pieces again that hold x, or P, where a lane has left its own.
template <class Of>
void movePieces(CubicPiece<Of>& curve, const typename Of::Number& x);
template <class Of, std::size_t n>
void movePieces(BezierPiece<Of, n>& curve, const typename Of::Number& x);
template <class Of>
void movePieces(SpeedPiece<Of>& curve, const typename Of::Mask& wanted,
                const typename Of::Number& P, const typename Of::Number& A,
                const typename Of::Number& B);

/// u of every lane's x to rounding, in place of those that the table has.
template <class Of, std::size_t n>
void refinePlaces(const BezierPiece<Of, n>& curve, const typename Of::Number& x,
                  typename Of::Number& u);

}  // namespace bio::lanes
