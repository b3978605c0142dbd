#include "simulation/simd/lane_model.h"

#include "bio/forces/coordinate_force.h"
#include "bio/path/surface/wrap_rule.h"

namespace bio::lanes {

template <class Of>
bool touchesWithin(const Cylinder<Of>& cylinder, const typename Of::Number (&P)[3],
                   const typename Of::Number (&Q)[3], int lane) {
  return cylinderTouches(cylinder.radius[lane], 2 * cylinder.halfLength[lane],
                         cylinder.side[lane] > 0 ? Side::counterclockwise : Side::clockwise,
                         {P[0][lane], P[1][lane], P[2][lane]},
                         {Q[0][lane], Q[1][lane], Q[2][lane]});
}

template <class Of>
void passiveForce(const LaneModel<Of>& system, const typename Of::Mask& lanes,
                  const typename Of::Number& q, const typename Of::Number& qDot,
                  PassiveForce<Of>& out) {
  using Number = Eigen::Matrix<double, 1, 1>;
  const typename Of::Number none{};
  out = {none, none, none};
  for (int l = 0; l < Of::width; ++l) {
    if (lanes[l] == 0) continue;
    Number force(0.0), byPosition(0.0), bySpeed(0.0);
    system.forces[l]->template add<1>(Number(q[l]), Number(qDot[l]), force, byPosition, bySpeed);
    out.force[l] = force[0];
    out.dForce_dq[l] = byPosition(0, 0);
    out.dForce_dqDot[l] = bySpeed(0, 0);
  }
}

template bool touchesWithin(const Cylinder<Lanes<4>>&, const Lanes<4>::Number (&)[3],
                            const Lanes<4>::Number (&)[3], int);
template bool touchesWithin(const Cylinder<Lanes<8>>&, const Lanes<8>::Number (&)[3],
                            const Lanes<8>::Number (&)[3], int);
template void passiveForce(const LaneModel<Lanes<4>>&, const Lanes<4>::Mask&,
                           const Lanes<4>::Number&, const Lanes<4>::Number&,
                           PassiveForce<Lanes<4>>&);
template void passiveForce(const LaneModel<Lanes<8>>&, const Lanes<8>::Mask&,
                           const Lanes<8>::Number&, const Lanes<8>::Number&,
                           PassiveForce<Lanes<8>>&);

}  // namespace bio::lanes
