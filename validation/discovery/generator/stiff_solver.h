#pragma once

#include <Eigen/Core>
#include <memory>

#include "generator/true_elbow.h"

namespace hidden {

/// CVODE's BDF with relative and absolute tolerance 1e-10 on a true elbow, dense Jacobian by its
/// own differences. Steps end wherever the caller asks for a state, so asking at every corner of
/// the excitation keeps steps from reaching over one.
class StiffSolver {
 public:
  /// The elbow and the recording must outlive the solver; the recording may grow meanwhile.
  StiffSolver(const TrueElbow& elbow, const Recording& recording, const Eigen::VectorXd& start,
              double tolerance = 1e-10);
  ~StiffSolver();

  /// The state at time t ≥ the last one. @throws std::runtime_error if CVODE finds none
  const Eigen::VectorXd& advanceTo(double t);
  const Eigen::VectorXd& state() const;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace hidden
