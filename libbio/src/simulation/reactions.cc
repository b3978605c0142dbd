#include "simulation/integrators.h"
#include "simulation/system_dynamics.h"

namespace bio::stepping {

void addReactions(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                  const SimulationOptions& options, Trajectory& motion) {
  if (system.prescribed().empty()) return;
  const auto rows = static_cast<Eigen::Index>(motion.time.size());
  motion.reaction.setZero(system.skeleton().numCoordinates(), rows);
  const bool addsWork = isVariational(options.integrator);
  withCoordinates(system.skeleton(), [&](auto N) {
    SystemDynamics<decltype(N)::value> dynamics(system, excitation, options.externalForce,
                                                options.prescribed);
    Eigen::VectorXd y(dynamics.size()), yDot(y);
    double work = 0, powerBefore = 0;
    for (Eigen::Index k = 0; k < rows; ++k) {
      y << motion.q.col(k), motion.qDot.col(k), motion.activation.col(k), motion.fibreLength.col(k);
      dynamics.derivative(motion.time[static_cast<std::size_t>(k)], y, yDot);
      motion.reaction.col(k) = dynamics.reaction();
      const double power = motion.reaction.col(k).dot(motion.qDot.col(k));
      if (k > 0) {
        const auto sk = static_cast<std::size_t>(k);
        work += (motion.time[sk] - motion.time[sk - 1]) * (powerBefore + power) / 2;
      }
      powerBefore = power;
      if (addsWork) motion.externalWork[k] += work;
    }
  });
}

}  // namespace bio::stepping
