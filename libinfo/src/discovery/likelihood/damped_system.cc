#include "discovery/likelihood/damped_system.h"

#include <cmath>

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double JointVector::norm() const {
  double squares = xi.squaredNorm();
  for (const VectorXd& one : eta) squares += one.squaredNorm();
  return std::sqrt(squares);
}

DampedSystem::DampedSystem(const Blocks& blocks, double damping)
    : blocks_(blocks), reduced_(blocks.information) {
  reduced_.diagonal() *= 1 + damping;
  for (std::size_t t = 0; t < blocks.latent.size(); ++t) {
    MatrixXd C = blocks.latent[t];
    C.diagonal().array() += damping;
    factors_.push_back(C.llt());
    if (blocks.coupling[t].size() == 0) continue;
    const MatrixXd half = factors_[t].matrixL().solve(blocks.coupling[t]);
    reduced_.noalias() -= half.transpose() * half;
  }
}

VectorXd DampedSystem::pull(const JointVector& right) const {
  VectorXd pull = right.xi;
  for (std::size_t t = 0; t < factors_.size(); ++t)
    if (blocks_.coupling[t].size() > 0)
      pull.noalias() -= blocks_.coupling[t].transpose() * factors_[t].solve(right.eta[t]);
  return pull;
}

VectorXd DampedSystem::solve(const VectorXd& pull, const std::vector<Index>& moving) const {
  VectorXd xi = VectorXd::Zero(pull.size());
  if (moving.empty()) return xi;
  const MatrixXd free = reduced_(moving, moving);
  const VectorXd right = pull(moving);
  const VectorXd solved = free.llt().solve(right);
  xi(moving) = solved;
  return xi;
}

std::vector<VectorXd> DampedSystem::follow(const JointVector& right, const VectorXd& xi) const {
  std::vector<VectorXd> eta;
  for (std::size_t t = 0; t < factors_.size(); ++t)
    eta.push_back(blocks_.coupling[t].rows() == 0
                      ? VectorXd(VectorXd::Zero(right.eta[t].size()))
                      : VectorXd(factors_[t].solve(right.eta[t] - blocks_.coupling[t] * xi)));
  return eta;
}

}  // namespace info::discover
