#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

namespace bio::discover {

/// A generalised force that begins or ends at a time t_c, the same in every trial:
///     τ(t) = A·w(t)·s(t),   s = S((t − t_c)/0.15 s + ½) where it begins, 1 − S where it ends,
/// S the cubic step from 0 to 1 over 0 to 1. w = 1 for a force; for a mass A in the hand
///     w = g·v(ỹ) − |v(ỹ)|²ỹ″ − v·∂v/∂q ỹ′²,   v = ∂(mass centre of the hand)/∂q,
/// its moment on a coordinate that moves as measured.
struct TimedForce {
  enum class Kind { force, mass } kind = Kind::force;
  bool ends = false;
  std::size_t coordinate = 0;  ///< of EncompassingModel::coordinates()
  std::size_t amplitude = 0;   ///< quantities
  std::size_t time = 0;
};

/// s, and ∂s/∂t_c [1/s].
struct TimedShare {
  double value, inTime;
};
TimedShare timedShare(double t, double change, bool ends);

class EncompassingModel;

/// w of a mass at the nodes [N m/kg] along the smoothed measured course (smoothed_motion.h); 0 if
/// the coordinate moves no body or there are fewer than four samples.
Eigen::VectorXd weightOfHeldMass(const EncompassingModel& model, const std::vector<double>& times,
                                 const Eigen::VectorXd& measured, const std::vector<double>& nodes);

}  // namespace bio::discover
