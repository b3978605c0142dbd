#include "simulation/simd/lane_model.h"

#include "bio/forces/coordinate_force.h"
#include "bio/path/surface/wrap_rule.h"

namespace bio::lanes {

LaneSolver::~LaneSolver() = default;

bool touchesWithin(const Cylinder<Lanes>& cylinder, const Real (&P)[3], const Real (&Q)[3],
                   int lane) {
  return cylinderTouches(cylinder.radius[lane], 2 * cylinder.halfLength[lane],
                         cylinder.side[lane] > 0 ? Side::counterclockwise : Side::clockwise,
                         {P[0][lane], P[1][lane], P[2][lane]},
                         {Q[0][lane], Q[1][lane], Q[2][lane]});
}

void passiveForce(const LaneModel<Lanes>& system, const Mask& lanes, const Real& q,
                  const Real& qDot, PassiveForce& out) {
  using Number = Eigen::Matrix<double, 1, 1>;
  out = {Real{}, Real{}, Real{}};
  for (int l = 0; l < width; ++l) {
    if (lanes[l] == 0) continue;
    Number force(0.0), byPosition(0.0), bySpeed(0.0);
    system.forces[l]->add<1>(Number(q[l]), Number(qDot[l]), force, byPosition, bySpeed);
    out.force[l] = force[0];
    out.dForce_dq[l] = byPosition(0, 0);
    out.dForce_dqDot[l] = bySpeed(0, 0);
  }
}

}  // namespace bio::lanes
