#pragma once

#include <span>
#include <vector>

#include "bio/simulation/simulate.h"

namespace bio {

/// One of many simulations; the objects it points to must outlive the call.
struct LaneJob {
  const MusculoskeletalSystem* system;
  const ExcitationSignal* excitation;
  const SystemState* start;
};

/// The vector instructions that simulateTogether uses. All give bitwise the same results.
enum class LaneInstructions {
  best,    ///< the best that the processor supports
  avx512,  ///< AVX-512, where the processor supports it, else `plain`
  avx2,    ///< AVX2, likewise
  plain,   ///< those of every processor of the architecture
};

/// simulate(system, excitation, start, options) for each job, four or eight at a time in SIMD
/// registers, for models with one hinge that differ in numerical values only.
///
/// The scheme is that of simulate() and its tolerances are the same; paths and gravity are taken at
/// every iterate in closed form in sin q and cos q, where simulate() uses Taylor's polynomials for
/// the last small changes. Muscles of all classes; motions agree to 1e-9 rad where the iterations
/// of a step are as many, else to its tolerance. A trajectory depends bitwise on its own job only,
/// not on the other jobs or their order.
///
/// Jobs that the SIMD kernel does not support are simulated one by one with simulate(): integrators
/// other than the two variational ones, progress calls, several free coordinates, sliders, paths
/// over spheres, points that move in their bodies; also, from its beginning, a job that halves more
/// than sixteen steps or finds no solution. Trajectory::wallSeconds is 0 for jobs of the SIMD
/// kernel.
///
/// @throws what simulate() throws
std::vector<Trajectory> simulateTogether(std::span<const LaneJob> jobs,
                                         const SimulationOptions& options,
                                         LaneInstructions instructions = LaneInstructions::best);

}  // namespace bio
