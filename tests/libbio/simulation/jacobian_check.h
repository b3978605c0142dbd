#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "simulation/system_dynamics.h"

namespace bio::fixtures {

/// ∂f/∂y against central differences of f at a state and time.
template <int N>
void expectJacobianOfDifferences(stepping::SystemDynamics<N>& dynamics, double time,
                                 const Eigen::VectorXd& y) {
  Eigen::MatrixXd J(y.size(), y.size());
  dynamics.jacobian(time, y, J);
  Eigen::VectorXd plus(y.size()), minus(y.size());
  for (Eigen::Index j = 0; j < y.size(); ++j) {
    const double h = 1e-7;
    Eigen::VectorXd shifted = y;
    shifted[j] = y[j] + h;
    dynamics.derivative(time, shifted, plus);
    shifted[j] = y[j] - h;
    dynamics.derivative(time, shifted, minus);
    const Eigen::VectorXd difference = (plus - minus) / (2 * h);
    const double scale = std::max(1.0, difference.cwiseAbs().maxCoeff());
    EXPECT_LT((difference - J.col(j)).cwiseAbs().maxCoeff() / scale, 2e-6) << "column " << j;
  }
}

}  // namespace bio::fixtures
