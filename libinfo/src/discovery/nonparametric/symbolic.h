#pragma once

#include <functional>
#include <string>
#include <vector>

#include "discovery/judgement/node_states.h"
#include "info/discovery/nonparametric/unknown.h"

// Not public.

namespace info::discover {

/// Searches the formula of Unknown on its axis: sets terms, evidence, explained, stable and
/// formula.
void findFormula(const Likelihood& likelihood, const Fit& fit, Unknown& unknown);

/// A generalised force on an axis that is a function of its position and speed.
struct StateForce {
  std::string expression;  ///< in q and qdot
  std::function<double(double q, double qDot)> at;
};

/// Coefficients of forces on one axis by one linear step from a fit, with priors N(0, sd²),
/// together with the free quantities of the fit and its latent force.
Eigen::VectorXd linearCoefficients(const Likelihood& likelihood, const Fit& fit,
                                   const NodeStates& states, std::size_t axis,
                                   const std::vector<StateForce>& forces, double sd);

}  // namespace info::discover
