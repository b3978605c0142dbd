#pragma once

// The muscles' curves in lanes: each lane remembers the piece of a curve that it used last.

#include <array>

#include "bio/muscle/millard2012.h"
#include "bio/muscle/rigid_tendon.h"
#include "muscle/schutte_law.h"
#include "simulation/simd/lane_law.h"
#include "simulation/simd/lane_number.h"

namespace bio::lanes {
namespace {

/// The piece changes with x; a muscle and its curves belong to one solver.
class LaneCubic {
 public:
  LaneCubic() = default;
  explicit LaneCubic(const CubicPiece<Here>& piece) : piece_(piece) {}

  const CubicPiece<Here>& holding(const LaneNumber& x) const {
    if (!all((x.v >= piece_.lower) & (x.v < piece_.upper))) movePieces(piece_, x.v);
    return piece_;
  }

  /// PiecewiseCubic::evaluate, of a muscle without pieces kept beside it
  struct Elsewhere {};
  muscles::CurvePoint<LaneNumber> evaluate(const LaneNumber& x, Elsewhere) const {
    const CubicPiece<Here>& c = holding(x);
    const Real t = x.v - c.start;
    return {c.value + t * (c.slope + t * (c.quadratic + t * c.cubic)),
            c.slope + t * (2 * c.quadratic + t * 3 * c.cubic), 2 * c.quadratic + 6 * t * c.cubic};
  }

 private:
  mutable CubicPiece<Here> piece_;
};

}  // namespace
}  // namespace bio::lanes

namespace bio::muscles {

/// The curve of every lane.
template <std::size_t n>
class BezierCurve<lanes::LaneNumber, n> {
  using N = lanes::LaneNumber;

 public:
  BezierCurve() = default;
  explicit BezierCurve(const lanes::BezierPiece<lanes::Here, n>& piece) : piece_(piece) {}

  CurvePoint<N> evaluate(const N& x) const {
    lanes::BezierPiece<lanes::Here, n>& c = piece_;
    if (!lanes::all((x.v >= c.lower) & (x.v < c.upper))) lanes::movePieces(c, x.v);
    std::array<N, 6> place;
    std::array<lanes::LanePlane, 6> section;
    for (std::size_t k = 0; k < 6; ++k) {
      place[k] = c.place[k];
      section[k] = {c.x[k], c.y[k]};
    }
    const N u = placeInCell(place, N((x.v - c.start) * c.per));
    return sectionAtAbscissa(section, u, x, [&](N near) {
      lanes::refinePlaces(c, x.v, near.v);
      return near;
    });
  }

 private:
  mutable lanes::BezierPiece<lanes::Here, n> piece_;
};

template <>
class MillardSpeed<lanes::LaneNumber> {
  using N = lanes::LaneNumber;

 public:
  MillardSpeed() = default;
  explicit MillardSpeed(const lanes::LawNumbers<lanes::Here>& law)
      : piece_(law.speed),
        first_{law.firstSpeed.x, law.firstSpeed.y, law.firstSpeed.slope},
        last_{law.lastSpeed.x, law.lastSpeed.y, law.lastSpeed.slope} {}

  FibreSpeed<N> solve(const BezierCurve<N, 4>&, const N& B, const N& P, const N& A) const {
    const auto sum = [&](const N& y, const N& x) { return A * y + B * x; };
    lanes::SpeedPiece<lanes::Here>& c = piece_;
    const lanes::LaneMask below = !(P > sum(c.beginY, c.beginX));
    const lanes::LaneMask outside = below || !(P < sum(c.endY, c.endX));
    return branch(
        outside, [&] { return speedOnLine<N>(choose(below, first_, last_), B, P, A); },
        [&] {
          const lanes::LaneMask holds = sum(c.lowY, c.lowX) <= P && P < sum(c.highY, c.highX);
          if (!everywhere(holds || outside)) {
            lanes::movePieces(c, (!(holds || outside)).v, P.v, A.v, B.v);
          }
          // a lane that is outside looks for what is there for certain
          const N within = choose(outside, sum(c.lowY, c.lowX), P);
          const SpeedCell<N> cell{c.lowX,      c.lowY,       c.highX,      c.highY,  c.lowSpeedX,
                                  c.lowSpeedY, c.highSpeedX, c.highSpeedY, c.lowest, c.cellWidth};
          std::array<lanes::LanePlane, 6> section;
          for (std::size_t k = 0; k < 6; ++k) section[k] = {c.x[k], c.y[k]};
          const SectionPoint<N> point = solveInCell(cell, section, within, A, B);
          return speedAt<N>(point.x, point.y.value, point.y.slope, B, A);
        });
  }

 private:
  struct Line {
    N x, y, slope;
  };
  mutable lanes::SpeedPiece<lanes::Here> piece_;
  Line first_, last_;
};

/// The spline of every lane.
template <>
struct RigidTendonForm<lanes::LaneNumber> {
  struct Curves {
    lanes::LaneCubic activeForceLength, passiveForceLength, forceVelocity;
  };
  using Spline = lanes::LaneCubic;
  static Curves defaults() { return {}; }
};

}  // namespace bio::muscles

namespace bio::lanes {
namespace {

template <class R>
muscles::CurvePoint<R> splinePoint(const LaneCubic& curve, const LaneNumber& x) {
  return curve.evaluate(x, LaneCubic::Elsewhere{});
}

}  // namespace
}  // namespace bio::lanes
