#include "simulation/other_forces.h"

namespace bio::stepping {
namespace {

Vector6 plain(const SpatialVector<double>& S) {
  return Eigen::Map<const Vector6>(S.data());
}

/// A × B of two screws: how B changes as it moves with A.
Vector6 moved(const Vector6& A, const Vector6& B) {
  const Eigen::Vector3d w = A.head<3>();
  Vector6 change;
  change << w.cross(Eigen::Vector3d(B.head<3>())),
      w.cross(Eigen::Vector3d(B.tail<3>())) +
          Eigen::Vector3d(A.tail<3>()).cross(Eigen::Vector3d(B.head<3>()));
  return change;
}

}  // namespace

void moveSegments(const MusculoskeletalSystem& system,
                  const SystemConfiguration<Eigen::Dynamic>& configuration,
                  std::vector<MovingSegment>& segments) {
  const ArticulatedTree& tree = *system.tree();
  const TreeMotion<double>& motion = configuration.motion();
  for (MovingSegment& segment : segments) {
    segment.X = configuration.placement(segment.segment);
    std::fill(segment.S.begin(), segment.S.end(), Vector6::Zero());
    std::fill(segment.dS.begin(), segment.dS.end(), Vector6::Zero());
    const std::size_t n = segment.S.size();
    for (int j = tree.mobilityOf(configuration.places().segmentOf(segment.segment)); j >= 0;) {
      const auto sj = static_cast<std::size_t>(j);
      const Mobility& mobility = tree.mobilities()[sj];
      const auto row = static_cast<std::size_t>(mobility.coordinate);
      const Vector6 S = plain(motion.screw[sj]);
      segment.S[row] += S;
      segment.dS[row * n + row] += plain(motion.screw1[sj]);
      for (int k = mobility.parent; k >= 0;) {
        const auto sk = static_cast<std::size_t>(k);
        const auto column = static_cast<std::size_t>(tree.mobilities()[sk].coordinate);
        segment.dS[row * n + column] += moved(plain(motion.screw[sk]), S);
        k = tree.mobilities()[sk].parent;
      }
      j = mobility.parent;
    }
  }
}

}  // namespace bio::stepping
