#pragma once

// How a wrapped span follows its surface's radius; not public.

#include "bio/path/compiled_path.h"

namespace bio {

/// ∂L/∂r of a wrapped span and of its end tangents.
struct RadiusDerivatives {
  double length;
  Eigen::Vector3d dL_dP, dL_dQ;
};

/// Over a cylinder: L_r = β s/L, and with r the tangents turn about the ends.
RadiusDerivatives inRadius(const CylinderDyads<double>& span, Side side);
/// Over a sphere or cylinder; of a sphere through the scalar type.
RadiusDerivatives inRadius(const PathSurface& surface, const SpanSurface& way,
                           const Eigen::Vector3d& P, const Eigen::Vector3d& Q);

}  // namespace bio
