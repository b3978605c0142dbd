#pragma once

// Not public.

#include <Eigen/Dense>

namespace info::discover {

/// 1 + WᵀW, the block of one trial's latent force in the information; lower triangle.
inline Eigen::MatrixXd latentBlock(const Eigen::MatrixXd& W) {
  Eigen::MatrixXd C = Eigen::MatrixXd::Identity(W.cols(), W.cols());
  if (W.cols() != 0)  // Eigen would access the first of no columns
    C.selfadjointView<Eigen::Lower>().rankUpdate(W.transpose());
  return C;
}

/// 1 + WWᵀ, the covariance of one trial's n whitened samples; lower triangle.
inline Eigen::MatrixXd outputCovariance(const Eigen::MatrixXd& W, Eigen::Index n) {
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(n, n);
  if (W.cols() != 0) S.selfadjointView<Eigen::Lower>().rankUpdate(W);
  S.diagonal().array() += 1;
  return S;
}

}  // namespace info::discover
