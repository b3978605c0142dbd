#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "reduced/reduced_elbow.h"
#include "reduced/reduced_formula.h"

namespace reduced {

/// What is to be simulated of a trial, and differentiated by what.
struct MotionTask {
  const Trial& trial;
  const std::vector<double>& times;  ///< of the samples [s]
  Eigen::Index numNodes;             ///< of the latent force
  Eigen::Index start;                ///< place of the trial's start among the values
  const std::vector<StateTerm>& formula;
  Eigen::Index formulaAt;  ///< place of its first quantity
  double step;             ///< [s]
  const Eigen::VectorXd& values;
  const Eigen::VectorXd& latent;  ///< at the nodes [N·m]; empty: 0
  const std::vector<std::size_t>& wanted;
  bool latentToo;  ///< also by the latent force at each node
};

/// Angles that are read, and their derivatives by `wanted`, then by the nodes; NaN from where the
/// motion runs away.
struct Motion {
  Eigen::VectorXd outputs, speeds, scale;
  Eigen::VectorXd q, qDot;       ///< at the nodes; with `latentToo`
  Eigen::MatrixXd courseByNode;  ///< ∂q/∂d, nodes × nodes; with `latentToo`
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> gamma;
};

template <bool derivatives>
Motion solveMotion(const MotionTask& task);

}  // namespace reduced
