#pragma once

#include <optional>
#include <vector>

#include "bio/path/compiled_path.h"

namespace bio {

/// A muscle's length as OpenSim finds it (GeometryPath, OpenSim 4.6), restated: each object in turn
/// is led over the first segment of the present path that cuts it, or the one that it lengthens
/// least; up to eight rounds, which end when the length changes by less than 0.5 mm. Ellipsoids by
/// OpenSim's method "hybrid"; cylinders by the closed form on the side that OpenSim would choose in
/// this posture, spheres on the one that FisherHill has decided.
///
/// @return [m]; nothing where the path has a torus, whose rule is not restated, or is a function of
///   coordinates
std::optional<double> openSimLength(const CompiledPath& path, const Posture& posture);

}  // namespace bio
