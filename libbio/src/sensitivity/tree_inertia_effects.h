#pragma once

// Where masses and gravity enter the equations of a tree; not public.

#include "bio/simulation/tree_configuration.h"
#include "sensitivity/parameter_effects.h"
#include "sensitivity/sensitivity_columns.h"

namespace bio::stepping {

using TreeRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Adds ∂(M v)/∂θ to `momentum` and ∂(½ vᵀ∂M v − ∂V)/∂θ to `slope`, one column per θ. Both are
/// linear in a segment's moments: with δI its changed inertia and V its velocity, for every
/// mobility j on the way to it (symbols of tree_energy.h)
///     S_j·δI V   and   −b_j·δI V + g·(linear part of δI S_j)
void addTreeInertia(const MusculoskeletalSystem& system,
                    const SystemConfiguration<Eigen::Dynamic>& configuration,
                    const ParameterEffects& effects, const Eigen::VectorXd& v, TreeRows& momentum,
                    TreeRows& slope);

}  // namespace bio::stepping
