#include <algorithm>

#include "bio/forces/body_forces.h"
#include "forces/bushing_deflection.h"

// Derivatives of forces on bodies in their own numbers.

namespace bio {

using Eigen::MatrixXd;
using Eigen::Vector3d;

namespace {

template <class Compiled>
const Compiled* withIndex(const std::vector<Compiled>& all, std::size_t index) {
  const auto at = std::find_if(all.begin(), all.end(),
                               [&](const Compiled& compiled) { return compiled.index == index; });
  return at == all.end() ? nullptr : &*at;
}

}  // namespace

bool BodyForces::hasSpring(std::size_t index) const {
  return withIndex(springs_, index) != nullptr;
}

bool BodyForces::hasBushing(std::size_t index) const {
  return withIndex(bushings_, index) != nullptr;
}

// τ_j = −k (d − d₀) ∂_jd
void BodyForces::springInNumbers(std::size_t index, const std::vector<MovingSegment>& segments,
                                 MatrixXd& tau) const {
  const Spring& spring = *withIndex(springs_, index);
  const MovingSegment& a = segments[spring.segment[0]];
  const MovingSegment& b = segments[spring.segment[1]];
  const Vector3d x_a = a.X.R * spring.point[0] + a.X.p, x_b = b.X.R * spring.point[1] + b.X.p;
  const Vector3d apart = x_b - x_a;
  const double distance = apart.norm();
  const auto n = static_cast<Eigen::Index>(a.S.size());
  tau.setZero(n, 2);
  if (!(distance > 0)) return;
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto sj = static_cast<std::size_t>(j);
    const double d_j = apart.dot(b.moves(sj, x_b) - a.moves(sj, x_a)) / distance;
    tau(j, 0) = -(distance - spring.restLength) * d_j;
    tau(j, 1) = spring.stiffness * d_j;
  }
}

// τ_j = −Σ_c (K_c δ_c + C_c δ̇_c) ∂_jδ_c
void BodyForces::bushingInNumbers(std::size_t index, const std::vector<MovingSegment>& segments,
                                  const Eigen::VectorXd& v, MatrixXd& tau) const {
  const Bushing& bushing = *withIndex(bushings_, index);
  const MovingSegment& a = segments[bushing.segment[0]];
  const MovingSegment& b = segments[bushing.segment[1]];
  const BushingDeflection deflection(a.X * bushing.frame[0], b.X * bushing.frame[1]);
  const auto n = static_cast<Eigen::Index>(a.S.size());
  tau.setZero(n, 12);
  Vector6 rate = Vector6::Zero();
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto sj = static_cast<std::size_t>(j);
    const Vector6 slope = deflection.slope(a.S[sj], b.S[sj]);
    rate += v[j] * slope;
    tau.row(j).tail<6>() = -slope.transpose();
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    tau.row(j).head<6>() = tau.row(j).tail<6>().cwiseProduct(deflection.value.transpose());
    tau.row(j).tail<6>() = tau.row(j).tail<6>().cwiseProduct(rate.transpose()).eval();
  }
}

}  // namespace bio
