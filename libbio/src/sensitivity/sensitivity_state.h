#pragma once

// What the sensitivities of a run carry from step to step; not public.

#include "sensitivity/activation_columns.h"
#include "sensitivity/sensitivity_columns.h"

namespace bio::stepping {

/// d(state)/dθ of N free coordinates at the time reached.
template <int N>
struct SensitivityState {
  using Rows = Eigen::Matrix<double, N, Eigen::Dynamic, Eigen::RowMajor>;

  SensitivityColumns columns;
  Rows dq, dp;              ///< of coordinates and momenta
  SensitivityMatrix fibre;  ///< of fibre lengths; rows = muscles
  ActivationColumns activation;

  void widen() {
    for (Rows* rows : {&dq, &dp}) columns.widen(*rows);
    columns.widen(fibre);
    activation.widen(columns);
  }

  /// Total derivatives from those at a held time, in whose own column stands that in the time.
  void moveAlong(const Eigen::RowVectorXd& dt) {
    for (Rows* rows : {&dq, &dp}) columns.moveAlong(*rows, dt);
    for (SensitivityMatrix* rows : {&fibre, &activation.end()}) columns.moveAlong(*rows, dt);
  }
};

}  // namespace bio::stepping
