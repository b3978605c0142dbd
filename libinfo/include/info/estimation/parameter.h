#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace info {

/// What is known of a parameter before the experiment: normally distributed about `mean`.
struct GaussianPrior {
  double mean = 0;  ///< in the parameter's unit
  double sd = 1;    ///< standard deviation in the parameter's unit > 0
};

/// An unknown of a model, as estimators and reports see it. lower == upper holds it fixed.
struct Parameter {
  std::string name;
  std::string unit = "";  ///< empty for a pure number
  double start = 0;       ///< where estimation starts; lower ≤ start ≤ upper
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::optional<GaussianPrior> prior = std::nullopt;
};

/// "m1 [kg]", or "m1" for a pure number; names errors and report lines.
std::string label(const Parameter& parameter);

/// Throws std::invalid_argument unless every name is used once, every start is finite and within
/// its bounds, and every prior's deviation is > 0; the message names parameter, value, unit and
/// rule.
void checkParameters(const std::vector<Parameter>& parameters);

}  // namespace info
