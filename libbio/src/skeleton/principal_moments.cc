#include "skeleton/principal_moments.h"

namespace bio {

Eigen::Vector3d principalMoments(const Body& body) {
  const auto& i = body.inertia;
  Eigen::Matrix3d tensor;
  tensor << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

bool hasNegativeMoment(const Eigen::Vector3d& principal) {
  return principal.minCoeff() < -1e-12 * principal.cwiseAbs().maxCoeff();
}

}  // namespace bio
