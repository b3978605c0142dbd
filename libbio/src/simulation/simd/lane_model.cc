#include "simulation/simd/lane_model.h"

#include <cmath>

#include "bio/forces/coordinate_force.h"
#include "bio/muscle/curves/curves.h"
#include "bio/path/surface/wrap_rule.h"

namespace bio::lanes {

void movePieces(Curve<Lanes>& curve, const Real& x) {
  for (int l = 0; l < width; ++l) {
    if (x[l] >= curve.lower[l] && x[l] < curve.upper[l]) continue;
    const PiecewiseCubic::Piece piece = curve.of[l]->pieceAt(x[l]);
    curve.lower[l] = piece.lower;
    curve.upper[l] = piece.upper;
    curve.start[l] = piece.segment->start;
    curve.value[l] = piece.segment->value;
    curve.slope[l] = piece.segment->slope;
    curve.quadratic[l] = piece.segment->quadratic;
    curve.cubic[l] = piece.segment->cubic;
  }
}

void exponentialPassiveForce(const Real& l, Real& value, Real& slope) {
  for (int lane = 0; lane < width; ++lane) value[lane] = std::exp(8 * l[lane] - 12);
  slope = 8 * value;
}

bool touchesWithin(const Cylinder<Lanes>& cylinder, const Real (&P)[3], const Real (&Q)[3],
                   int lane) {
  return cylinderTouches(cylinder.radius[lane], 2 * cylinder.halfLength[lane],
                         cylinder.side[lane] > 0 ? Side::counterclockwise : Side::clockwise,
                         {P[0][lane], P[1][lane], P[2][lane]},
                         {Q[0][lane], Q[1][lane], Q[2][lane]});
}

void passiveForce(const LaneModel<Lanes>& arm, const Mask& lanes, const Real& q, const Real& qDot,
                  PassiveForce& out) {
  using Number = Eigen::Matrix<double, 1, 1>;
  out = {Real{}, Real{}, Real{}};
  for (int l = 0; l < width; ++l) {
    if (lanes[l] == 0) continue;
    Number force(0.0), byPosition(0.0), bySpeed(0.0);
    arm.forces[l]->add<1>(Number(q[l]), Number(qDot[l]), force, byPosition, bySpeed);
    out.force[l] = force[0];
    out.dForce_dq[l] = byPosition(0, 0);
    out.dForce_dqDot[l] = bySpeed(0, 0);
  }
}

}  // namespace bio::lanes
