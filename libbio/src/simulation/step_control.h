#pragma once

// Parts of a step by their estimated errors; not public.

#include <algorithm>
#include <cmath>

#include "simulation/first_guess.h"
#include "simulation/integrators.h"

namespace bio::stepping {

/// The last parts of a motion.
template <int N>
struct LastParts {
  LastEnds<Eigen::Matrix<double, N, 1>> q;  ///< [rad] or [m]
  LastEnds<Eigen::VectorXd> fibreLength;    ///< [m]
  PartLengths lengths;
};

/// The error that a part of a step of vi-adaptive may have [rad] or [m]; 0: another integrator. A
/// smooth motion with q‴ = 15 rad/s³ has this error in steps of the whole length.
inline double allowedError(const SimulationOptions& options) {
  constexpr double perCube = 1.25;  // [rad/s³]
  if (options.integrator != Integrator::variationalAdaptive) return 0;
  return perCube * options.step * options.step * options.step;
}

/// How long the parts of a step of vi-adaptive are. With q‴, q⁗ and ℓ‴ from divided differences
/// over the ends of the last parts, a part of length h is taken to have the errors
///     δq = h³ q‴/12,   δq̇ = h³ q⁗/12,   δℓ = h³ ℓ‴/12
/// which the midpoint rule makes in a harmonic motion. Its error is the largest of |δq|, H|δq̇| and
/// |δℓ|/(10 ℓ0) [rad] or [m]: H is the whole step, so that a wrong speed counts for as far as it
/// leads within one, and fibres count little, since what they do to the motion is in q. Where
/// nothing else is asked for, every part is as long as keeps its error at allowedError(). What
/// other values of the constants below do: decision 092.
template <int N>
class StepControl {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  StepControl(const MusculoskeletalSystem& system, const SimulationOptions& options)
      : allowed_(allowedError(options)),
        whole_(options.step),
        longest_(options.step / 16),  // to begin with: nothing is known of the motion
        lengthOlder_(options.step) {
    if (!isUsed()) return;
    third_ = thirdBefore_ = Vector::Zero(system.skeleton().numCoordinates());
    perFibre_.resize(static_cast<Eigen::Index>(system.numMuscles()));
    for (Eigen::Index i = 0; i < perFibre_.size(); ++i) {
      perFibre_[i] = system.muscles()[static_cast<std::size_t>(i)].muscle.perFibre();
    }
    fibreThird_ = Eigen::VectorXd::Zero(perFibre_.size());
  }

  bool isUsed() const { return allowed_ > 0; }

  /// Whether a part of this length [s] is to be halved before it is tried.
  bool isTooLong(double h) const { return isUsed() && h > slack * longest_; }

  /// Whether a part that was solved has an error that is small enough; how long the next one, or a
  /// second try, is to be follows from it.
  template <class Ends>
  bool accepts(double h, const Ends& begin, const Ends& end, const LastParts<N>& last) {
    if (!isUsed()) return true;
    const double error = errorOf(h, begin, end, last);
    if (!(error < tooMuch * allowed_)) {
      longest_ = h * std::clamp(std::cbrt(allowed_ / error), 0.1, 0.5);
      return false;
    }
    longest_ = h * std::min(4.0, std::cbrt(allowed_ / error));
    return true;
  }

  /// The part just judged is one of the motion; `last` are still those before it.
  void take(const LastParts<N>& last) {
    if (!isUsed()) return;
    thirdBefore_.swap(third_);
    lengthOlder_ = last.lengths.before;
  }

 private:
  static constexpr double slack = 1.2;    ///< a part may exceed the length sought by this
  static constexpr double tooMuch = 1.5;  ///< of the error allowed: worth a second try

  template <class Ends>
  double errorOf(double h, const Ends& begin, const Ends& end, const LastParts<N>& last) {
    last.q.thirdUpTo(h, last.lengths, begin.q, end.q, third_);
    last.fibreLength.thirdUpTo(h, last.lengths, begin.fibreLength, end.fibreLength, fibreThird_);
    const double h3 = h + last.lengths.last + last.lengths.before;
    const double cube = h * h * h;
    const double position = cube / 2 * largest(third_);
    // q⁗/24 from the last two q‴/6
    const double speed = 2 * cube * largest(third_ - thirdBefore_) / (h3 + lengthOlder_);
    const double fibre = cube / 20 * largest(fibreThird_.cwiseProduct(perFibre_));
    return std::max({position, whole_ * speed, fibre});
  }

  template <class Values>
  static double largest(const Values& values) {
    return values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0;
  }

  double allowed_, whole_;
  double longest_;      ///< a part should be [s]
  double lengthOlder_;  ///< of the third last part [s]
  Vector third_, thirdBefore_;
  Eigen::VectorXd fibreThird_, perFibre_;
};

}  // namespace bio::stepping
