#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "bio/muscle/activation/excitation.h"
#include "bio/simulation/musculoskeletal_system.h"

namespace bio::stepping {

/// Advances activations along the excitation, row by row of its table, so that corners of the
/// excitation are met exactly whatever the step of the simulation.
class ActivationPlayer {
 public:
  ActivationPlayer(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                   double time)
      : system_(&system),
        excitation_(&excitation),
        from_(excitation.numMuscles()),
        to_(from_.size()) {
    excitation.at(time, hint_, from_);
  }

  /// activation(t0) becomes activation(t1); calls must follow each other in time, or restart().
  void advance(double t0, double t1, Eigen::VectorXd& activation) {
    const std::vector<double>& rows = excitation_->times();
    const auto behind = [](double t) { return t + 1e-15 * (1 + std::abs(t)); };
    double t = t0;
    while (t < t1) {
      std::size_t next = hint_;
      while (next < rows.size() && rows[next] <= behind(t)) ++next;
      const double stop = next < rows.size() ? std::min(rows[next], t1) : t1;
      excitation_->at(stop, hint_, to_);
      for (Eigen::Index i = 0; i < activation.size(); ++i) {
        activation[i] = system_->muscles()[static_cast<std::size_t>(i)].activation.step(
            from_[i], to_[i], activation[i], stop - t);
      }
      from_.swap(to_);
      t = stop;
    }
  }

  void restart(double time) {
    hint_ = 0;
    excitation_->at(time, hint_, from_);
  }

 private:
  const MusculoskeletalSystem* system_;
  const ExcitationSignal* excitation_;
  Eigen::VectorXd from_;
  Eigen::VectorXd to_;
  std::size_t hint_ = 0;
};

}  // namespace bio::stepping
