#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "bio/forces/external_force.h"
#include "bio/simulation/musculoskeletal_system.h"

namespace bio {

/// A spring and a damper that hold a coordinate near its measured course (nudging):
///     τ = −Mω²(q − ỹ(t)) − 1.4 Mω(q̇ − ỹ′(t))
/// with ỹ the smoothed course (smoothed_motion.h) and M the mass matrix's entry at mid-range.
///
/// The cost of simulating an unstable system has many narrow valleys as a function of the
/// parameters. With strong nudging it is smooth; estimates that follow ω down to 0 reach the valley
/// of the true values more often than estimates that start without nudging.
struct Nudge {
  std::string coordinate;
  double stiffness = 0;  ///< Mω² [N·m/rad] or [N/m]
  double damping = 0;    ///< 1.4 Mω [N·m·s/rad] or [N·s/m]
  ExternalForce pull;    ///< stiffness·ỹ + damping·ỹ′
};

/// @param freeIndex index of the coordinate in the skeleton
/// @param times      of the samples [s], at least four
/// @param values     measured [rad] or [m]
/// @param frequency  ω [rad/s] > 0
/// @throws std::invalid_argument what smoothed() throws
Nudge nudgeTo(const MusculoskeletalSystem& system, int freeIndex, const std::vector<double>& times,
              const Eigen::VectorXd& values, double frequency);

/// Adds spring and damper to a model, and the pull towards the course to the external forces.
void apply(const Nudge& nudge, Model& model, ExternalForce& external);

}  // namespace bio
