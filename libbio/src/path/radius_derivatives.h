#pragma once

// How a wrapped span follows its surface's radius; not public.

#include "bio/path/compiled_path.h"

namespace bio {

/// ∂L/∂r of a wrapped span and of its end tangents, through the scalar type.
struct RadiusDerivatives {
  double length;
  Eigen::Vector3d dL_dP, dL_dQ;
};

RadiusDerivatives inRadius(const PathSurface& surface, const SpanSurface& way,
                           const Eigen::Vector3d& P, const Eigen::Vector3d& Q);

}  // namespace bio
