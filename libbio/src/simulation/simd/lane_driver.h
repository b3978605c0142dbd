#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "simulation/activation_player.h"
#include "simulation/first_guess.h"
#include "simulation/integrators.h"
#include "simulation/simd/lane_model.h"
#include "simulation/switch_jump.h"
#include "simulation/switch_search.h"

namespace bio::lanes {

/// Activations of all muscles at the middle and the end of every step of a simulation: they follow
/// from the excitations alone.
class ActivationCourse {
 public:
  /// All must outlive the course.
  ActivationCourse(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                   const SystemState& start, const SimulationOptions& options);

  /// Activations in the step that ends row k ≥ 1. Rows are computed when they are first asked for.
  auto middle(Eigen::Index k) {
    reach(k);
    return middle_.col(k);
  }
  auto end(Eigen::Index k) {
    reach(k);
    return end_.col(k);
  }

 private:
  void reach(Eigen::Index k);

  const SimulationOptions* options_;
  stepping::ActivationPlayer player_;
  Eigen::MatrixXd middle_, end_;  ///< one column per step; the first is the start
  Eigen::VectorXd activation_;    ///< at the end of the last row reached
  Eigen::Index reached_ = 0;
};

/// One simulation of those that are advanced together: asks for steps and takes their ends. Does
/// between steps what VariationalRun does, and gives up where the smallest step fails or many are
/// halved.
class LaneDriver {
 public:
  /// All must outlive the driver.
  /// @param course  of this system, excitation and start
  LaneDriver(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
             const SystemState& start, const SimulationOptions& options, ActivationCourse& course,
             double mass);

  /// Writes the next step into a lane; false if there is none.
  template <class Of>
  bool ask(int lane, LaneStep<Of>& step);
  /// Takes the end of the step asked for.
  template <class Of>
  void take(int lane, const LaneStep<Of>& step);

  /// False: the lanes cannot do it, the motion is not to be used.
  bool succeeded() const { return phase_ == Phase::finished; }
  Trajectory finish() { return recorder_.finish(); }

 private:
  enum class Phase {
    wholeStep,   ///< to the end of a row or of a part of it
    meetSwitch,  ///< to where a conditional path point comes or goes
    jumpSwitch,  ///< to the same end, since the switch could not be met
    finished,
    failed
  };
  /// Where a step is to end: that of the row, and inside of it those of halved steps.
  struct Target {
    double time;  ///< [s]
    int halvings;
  };
  void takeEnd();
  void chooseActivation();
  void shortenAfterJump();
  void noteJump();
  bool jumps();
  void returnToBegin();
  void meetSwitch();
  void jumpSwitch();
  void meetFailure();
  void accept(bool endsTarget);

  const MusculoskeletalSystem* system_;
  const SimulationOptions* options_;
  ActivationCourse* course_;
  bool within_ = false;  ///< the step begins or ends within a row
  stepping::ActivationPlayer player_;
  stepping::Recorder recorder_;
  double mass_;
  Phase phase_ = Phase::wholeStep;
  std::size_t row_ = 1, rows_;
  double t0_, t1_;               ///< of the step asked for [s]
  std::vector<Target> targets_;  ///< the next one last
  bool fromRest_ = false;        ///< the first guess is the begin: the extrapolated one has failed
  double q_, p_;
  stepping::PartLengths lengths_;
  stepping::LastEnds<double> lastQ_;
  double lastJump_ = -std::numeric_limits<double>::infinity();  ///< of a length [s]
  std::optional<stepping::SwitchSides<1>> sides_;               ///< where there are switches
  Eigen::VectorXd fibre_;
  stepping::LastEnds<Eigen::VectorXd> lastFibre_;
  Eigen::VectorXd activation_, middle_, kept_;  ///< at the end, the middle, the begin of the step
  // the end that was last taken
  double qEnd_ = 0, pEnd_ = 0;
  Eigen::VectorXd fibreEnd_;
  double works_[3] = {0, 0, 0};  ///< of the step
  double sums_[3] = {0, 0, 0};
  stepping::SwitchSearch search_;
};

}  // namespace bio::lanes
