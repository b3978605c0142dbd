#pragma once

#include "bio/parameters/parameters.h"

namespace bio {

/// Whether a parameter is positive or 0 by its nature, as a mass, a radius, a muscle's number, a
/// stiffness and a damping are.
bool cannotBeNegative(const ModelParameter& parameter);

}  // namespace bio
