#pragma once

#include <memory>

#include "simulation/activation_player.h"
#include "simulation/integrators.h"
#include "simulation/simd/lane_model.h"
#include "simulation/switch_search.h"

namespace bio::lanes {

/// Activations of all muscles at the middle and the end of every step of a simulation: they follow
/// from the excitations alone.
struct ActivationCourse {
  Eigen::MatrixXd middle, end;  ///< one column per step; the first of `end` is the start

  ActivationCourse(const MusculoskeletalSystem& arm, const ExcitationSignal& excitation,
                   const SystemState& start, const SimulationOptions& options);
};

/// One simulation of those that are advanced together: asks for steps and takes their ends. Does
/// between steps what VariationalRun does, and gives up where that would halve a step.
class LaneDriver {
 public:
  /// All must outlive the driver.
  /// @param course  of this arm, excitation and start
  LaneDriver(const MusculoskeletalSystem& arm, const ExcitationSignal& excitation,
             const SystemState& start, const SimulationOptions& options,
             const ActivationCourse& course, double mass);

  /// Writes the next step into a lane; false if there is none.
  bool ask(int lane, LaneStep& step);
  /// Takes the end of the step asked for.
  void take(int lane, const LaneStep& step);

  /// False: the lanes cannot do it, the motion is not to be used.
  bool succeeded() const { return phase_ == Phase::finished; }
  Trajectory finish() { return recorder_.finish(); }

 private:
  enum class Phase {
    wholeStep,   ///< to the end of a row
    meetSwitch,  ///< to where a conditional path point comes or goes
    jumpSwitch,  ///< to the end of a row, since the switch could not be met
    finished,
    failed
  };
  void chooseActivation();
  void meetSwitch();
  void accept(bool endsRow);

  const MusculoskeletalSystem* arm_;
  const SimulationOptions* options_;
  const ActivationCourse* course_;
  bool within_ = false;  ///< the step begins or ends within a row
  stepping::ActivationPlayer player_;
  stepping::Recorder recorder_;
  double mass_;
  Phase phase_ = Phase::wholeStep;
  std::size_t row_ = 1, rows_;
  double t0_, t1_, tEnd_;  ///< of the step asked for; of the row [s]
  double q_, p_;
  double velocity_, velocityBefore_, length_, lengthBefore_;
  Eigen::VectorXd fibre_, fibreVelocity_, fibreVelocityBefore_;
  Eigen::VectorXd activation_, middle_, kept_;  ///< at the end, the middle, the begin of the step
  // the end that was last taken
  double qEnd_ = 0, pEnd_ = 0;
  Eigen::VectorXd fibreEnd_;
  double works_[3] = {0, 0, 0};  ///< of the step
  double sums_[3] = {0, 0, 0};
  stepping::SwitchSearch search_;
};

}  // namespace bio::lanes
