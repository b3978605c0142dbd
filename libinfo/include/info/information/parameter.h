#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace info {

/// Prior of a parameter: normal with mean `mean`.
struct GaussianPrior {
  double mean = 0;  ///< in the parameter's unit
  double sd = 1;    ///< standard deviation in the parameter's unit > 0
};

/// An unknown parameter of a model, for estimators and reports. lower == upper fixes it.
struct Parameter {
  std::string name;
  std::string unit = "";  ///< empty if dimensionless
  double start = 0;       ///< initial value of an estimation; lower ≤ start ≤ upper
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::optional<GaussianPrior> prior = std::nullopt;
};

/// "m1 [kg]", or "m1" if dimensionless; for error messages and reports.
std::string label(const Parameter& parameter);

/// Throws std::invalid_argument unless every name is used once, every start is finite and within
/// its bounds, and every prior's deviation is > 0; the message names parameter, value, unit and
/// rule.
void checkParameters(const std::vector<Parameter>& parameters);

}  // namespace info
