#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "bio/arm.h"
#include "bio/external_force.h"

namespace bio {

/// A spring and a damper that hold a coordinate near its measured course (nudging):
///     τ = −Mω²(q − ỹ(t)) − 1.4 Mω(q̇ − ỹ′(t))
/// with ỹ the smoothed course (smoothed_motion.h) and M the mass matrix's entry at mid-range.
///
/// The simulation of an unstable system depends on its parameters in many narrow valleys. Held
/// firmly it depends on them smoothly; estimates that follow ω down to 0 end in the valley of the
/// truth more often than those that begin there.
struct Nudge {
  std::string coordinate;
  double stiffness = 0;  ///< Mω² [N·m/rad] or [N/m]
  double damping = 0;    ///< 1.4 Mω [N·m·s/rad] or [N·s/m]
  ExternalForce pull;    ///< stiffness·ỹ + damping·ỹ′
};

/// @param freeIndex  of the coordinate in the arm's skeleton
/// @param times      of the samples [s], at least four
/// @param values     measured [rad] or [m]
/// @param frequency  ω [rad/s] > 0
/// @throws std::invalid_argument what smoothed() throws
Nudge nudgeTo(const Arm& arm, int freeIndex, const std::vector<double>& times,
              const Eigen::VectorXd& values, double frequency);

/// Adds spring and damper to a model, and the pull to the forces from outside.
void apply(const Nudge& nudge, Model& model, ExternalForce& external);

}  // namespace bio
