#pragma once

// Not public.

#include <Eigen/Dense>

namespace info::discover {

/// 1 + WᵀW/σ_y², the block of one trial's latent force in the information; lower triangle.
inline Eigen::MatrixXd latentBlock(const Eigen::MatrixXd& W, double output) {
  Eigen::MatrixXd C = Eigen::MatrixXd::Identity(W.cols(), W.cols());
  if (W.cols() != 0)  // Eigen would access the first of no columns
    C.selfadjointView<Eigen::Lower>().rankUpdate(W.transpose(), 1 / (output * output));
  return C;
}

/// σ_y² + WWᵀ, the covariance of one trial's n samples; lower triangle.
inline Eigen::MatrixXd outputCovariance(const Eigen::MatrixXd& W, Eigen::Index n, double output) {
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(n, n);
  if (W.cols() != 0) S.selfadjointView<Eigen::Lower>().rankUpdate(W);
  S.diagonal().array() += output * output;
  return S;
}

}  // namespace info::discover
