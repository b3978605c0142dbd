#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// One element of a score map: a disturbance of the generalised force on one axis that is local in
/// time or in (q, q̇), or proportional to an input.
struct Score {
  std::size_t axis = 0;                 ///< on which it acts
  int trial = -1;                       ///< −1: over all trials
  double from = 0, to = 0;              ///< times [s], of a hat
  double lowerQ = 0, upperQ = 0;        ///< position of the axis, of a cell
  double lowerQDot = 0, upperQDot = 0;  ///< its rate, of a cell
  std::string input;                    ///< of an input
  double z = 0;              ///< N(0, 1) under the base model with any admissible parameters
  double amplitude = 0;      ///< estimated force [unit of the generalised force]
  bool significant = false;  ///< by Benjamini and Hochberg's procedure
};

struct Localisation {
  std::vector<Score> times, cells, inputs;
  /// Per fitted trial: latent force and its standard deviation at DiscoveryProblem::nodes().
  std::vector<int> trials;
  std::vector<Eigen::VectorXd> force, forceSd;
};

struct LocaliseOptions {
  double width = 0.25;  ///< of a hat [s]
  int cellsQ = 8, cellsQDot = 6;
  double falseDiscoveries = 0.05;
};

/// Score map: z_j = g_j/√S_jj with score and information of disturbance j after elimination of
/// everything that is free in the fit (parameters with their priors, initial states, latent force).
/// @param fit of the base model, with a latent force of the size tolerated as input noise
/// @param smoothing fit of the base model with a latent force of the estimated size: gives r(t)
Localisation localise(const Likelihood& likelihood, const Fit& fit, const Fit& smoothing,
                      const LocaliseOptions& options = {});

/// Marks the elements that are significant by Benjamini and Hochberg's procedure at the given false
/// discovery rate.
void benjaminiHochberg(std::vector<Score>& scores, double share);

}  // namespace info::discover
