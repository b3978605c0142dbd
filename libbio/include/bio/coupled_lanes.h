#pragma once

#include <span>
#include <vector>

#include "bio/coupled.h"

namespace bio {

/// One of many simulations; what it points to must outlive the call.
struct LaneJob {
  const Arm* arm;
  const ExcitationSignal* excitation;
  const ArmState* start;
};

/// Which instructions simulateTogether uses. All give the same results, bit for bit.
enum class LaneInstructions {
  best,   ///< what the processor has
  plain,  ///< what every processor of the architecture has
};

/// simulate(arm, excitation, start, options) for each job, four at a time: side by side in the
/// lanes of vector instructions, where the arms turn about one hinge and differ in numbers alone.
///
/// The scheme is that of simulate() and its tolerances are the same; paths and gravity are taken at
/// every iterate in closed form in sin q and cos q, where simulate() uses Taylor's polynomials for
/// the last small changes. Motions agree to 1e-9 rad (docs/decisions/032). A trajectory depends on
/// its own job alone, to the last bit, whatever the others are and wherever it stands among them.
///
/// What lanes do not know is simulated by simulate(), each by itself: other integrators than the
/// two variational ones, progress calls, more free coordinates, sliders, paths over spheres, points
/// that move in their bodies; and a job of which a step does not converge, from its beginning.
/// Trajectory::wallSeconds is 0 for those that went through lanes.
///
/// @throws what simulate() throws
std::vector<Trajectory> simulateTogether(std::span<const LaneJob> jobs,
                                         const SimulationOptions& options,
                                         LaneInstructions instructions = LaneInstructions::best);

}  // namespace bio
