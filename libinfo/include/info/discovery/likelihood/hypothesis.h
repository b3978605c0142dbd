#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"

namespace info::discover {

/// A free quantity of a hypothesis, in the coordinate ξ in which its prior is N(0, 1):
///     value = nominal + deviation·ξ,   of a logarithmic one   value = nominal·exp(deviation·ξ)
struct FreeQuantity {
  std::size_t quantity = 0;  ///< index into DiscoveryProblem::quantities()
  double nominal = 0, sd = 1;
  bool logarithmic = false;
  double lowest = 0, highest = 0;  ///< bounds of ξ
  double nominalShare = 0;         ///< prior probability of ξ = 0 exactly

  double value(double xi) const;
  double slope(double xi) const;  ///< dvalue/dξ
  double coordinate(double value) const;
};

/// A set of effects assumed present, and the resulting free quantities: the nuisance parameters of
/// the base model, the initial states of the given trials, and the quantities of the effects.
struct Hypothesis {
  std::vector<std::size_t>
      effects;  ///< indices into DiscoveryProblem::candidates(); none: the base model
  std::vector<FreeQuantity> free;

  /// Index of a quantity in `free`; −1: not free.
  int indexOf(std::size_t quantity) const;
};

/// A parameter error widens the prior of a nuisance parameter, which is free in any case.
/// @param trials the trials in use; initial states of others are not free
/// @throws std::invalid_argument if a quantity breaks a rule of Quantity, or an index is too large
Hypothesis makeHypothesis(const DiscoveryProblem& data, const std::vector<std::size_t>& effects,
                          const std::vector<int>& trials);
/// The hypothesis in which only the initial states of the given trials are free, as for held-out
/// trials.
Hypothesis startsOnly(const DiscoveryProblem& data, const std::vector<int>& trials);

/// Nominal values of all quantities.
Eigen::VectorXd nominalValues(const DiscoveryProblem& data);

/// "visc + bias"; "base" without effects.
std::string describe(const DiscoveryProblem& data, const std::vector<std::size_t>& effects);

}  // namespace info::discover
