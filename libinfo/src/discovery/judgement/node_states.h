#pragma once

#include <Eigen/Dense>
#include <vector>

#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// States of the simulation of a fit at the nodes of the latent force, by trial.
struct NodeStates {
  std::size_t numAxes = 1;
  std::vector<Likelihood::Linear> linear;  ///< with dy/dd
  std::vector<Eigen::VectorXd> q, qDot;    ///< of each node's axis
  std::vector<Eigen::MatrixXd> response;   ///< ∂q/∂d: nodes × nodes
  std::vector<Eigen::MatrixXd> inputs;     ///< nodes × inputs

  /// Where a trial's nodes of one axis begin, and their number.
  Eigen::Index count(std::size_t trial) const {
    return q[trial].size() / static_cast<Eigen::Index>(numAxes);
  }
  Eigen::Index begin(std::size_t trial, std::size_t axis) const {
    return static_cast<Eigen::Index>(axis) * count(trial);
  }
  /// Positions and speeds at the nodes of one axis, by trial.
  std::vector<Eigen::VectorXd> positions(std::size_t axis) const;
  std::vector<Eigen::VectorXd> speeds(std::size_t axis) const;
  /// Forces at the nodes of one axis as forces at all nodes of a trial: 0 on the others.
  Eigen::MatrixXd placed(std::size_t trial, std::size_t axis, const Eigen::MatrixXd& forces) const;
};

/// Over the entries of all parts.
double rootMeanSquare(const std::vector<Eigen::VectorXd>& parts);

NodeStates statesAtNodes(const Likelihood& likelihood, const Fit& fit);

}  // namespace info::discover
