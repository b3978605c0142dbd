#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"

namespace info::discover {

/// A quantity that a hypothesis leaves free, in the coordinate ξ in which its prior is N(0, 1):
///     value = nominal + deviation·ξ,   of a logarithmic one   value = nominal·exp(deviation·ξ)
struct FreeQuantity {
  std::size_t quantity = 0;  ///< index into DiscoveryProblem::quantities()
  double nominal = 0, sd = 1;
  bool logarithmic = false;
  double lowest = 0, highest = 0;  ///< bounds of ξ

  double value(double xi) const;
  double slope(double xi) const;  ///< dvalue/dξ
  double coordinate(double value) const;
};

/// Which effects are held to be present, and so what is free: the nuisances of the base model, the
/// starts of the trials in question, and the quantities of the effects.
struct Hypothesis {
  std::vector<std::size_t>
      effects;  ///< indices into DiscoveryProblem::candidates(); none: the base
  std::vector<FreeQuantity> free;

  /// Where in `free` a quantity is; −1: it is not free.
  int indexOf(std::size_t quantity) const;
};

/// A parameter error widens the prior of a nuisance that is free anyway.
/// @param trials whose data are looked at; starts of others are not free
/// @throws std::invalid_argument if a quantity breaks a rule of Quantity, or an index is too large
Hypothesis makeHypothesis(const DiscoveryProblem& data, const std::vector<std::size_t>& effects,
                          const std::vector<int>& trials);
/// Only the starts of the given trials free, all else as it is: what a trial that was held out may
/// adjust.
Hypothesis startsOnly(const DiscoveryProblem& data, const std::vector<int>& trials);

/// Nominal values of all quantities.
Eigen::VectorXd nominalValues(const DiscoveryProblem& data);

/// "visc + bias", "base" for none.
std::string describe(const DiscoveryProblem& data, const std::vector<std::size_t>& effects);

}  // namespace info::discover
