#pragma once

// What is listed in a ParameterCatalogue, and where it is in a Model; not public.

#include "bio/parameters/parameters.h"

namespace bio {

/// Every parameter that moves the system, with its default bounds and deviation.
std::vector<ModelParameter> collectParameters(const Model& model,
                                              const MusculoskeletalSystem& system,
                                              const StartPoint& start, const EmgMapping& mapping);

/// The member of SchutteParameters that a quantity is; null for a scale of a curve.
using SchutteNumber = double SchutteParameters::*;
SchutteNumber schutteNumber(MuscleQuantity quantity);

/// The number of a passive force that a quantity of its target means.
double& limitForceNumber(CoordinateLimitForce& force, LimitForceTarget::Quantity quantity);
double& springForceNumber(SpringGeneralizedForce& force, SpringForceTarget::Quantity quantity);

/// The number of a force on bodies or of an actuator.
double* forceNumber(Model& model, const ForceNumberTarget& target);
double forceNumber(const Model& model, const ForceNumberTarget& target);

/// A name of OpenSim's, with unit and what is taken for granted about it.
struct ForceNumberRule {
  std::string name;  ///< empty: a law of this kind has no such number
  const char* unit;
  const char* meaning;
  double lower, upper, sd;
};
/// Rule of a number of a force.
ForceNumberRule forceNumberRule(const Model& model, const ForceNumberTarget& target);
/// How many numbers it has.
int numForceNumbers(ForceNumberTarget::Kind kind);

}  // namespace bio
