#pragma once

#include <Eigen/Dense>
#include <vector>

#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// States of the simulation of a fit at the nodes of the latent force, by trial.
struct NodeStates {
  std::vector<Likelihood::Linear> linear;  ///< with dy/dd
  std::vector<Eigen::VectorXd> q, qDot;    ///< of the first output
  std::vector<Eigen::MatrixXd> response;   ///< ∂q/∂d: nodes × nodes
  std::vector<Eigen::MatrixXd> inputs;     ///< nodes × inputs
};

NodeStates statesAtNodes(const Likelihood& likelihood, const Fit& fit);

}  // namespace info::discover
