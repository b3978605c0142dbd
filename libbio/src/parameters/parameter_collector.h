#pragma once

// What is listed in a ParameterCatalogue, and where it is in a Model; not public.

#include "bio/parameters/parameters.h"

namespace bio {

/// Every parameter that moves the arm, with its default bounds and deviation.
std::vector<ModelParameter> collectParameters(const Model& model, const MusculoskeletalSystem& arm,
                                              const StartPoint& start, const EmgMapping& mapping);

/// The member of SchutteParameters that a quantity is; null for a scale of a curve.
using SchutteNumber = double SchutteParameters::*;
SchutteNumber schutteNumber(MuscleQuantity quantity);

/// The number of a passive force that a component of its target means.
double* limitForceValue(CoordinateLimitForce& force, int component);
double* springForceValue(SpringGeneralizedForce& force, int component);

}  // namespace bio
