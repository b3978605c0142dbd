#pragma once

#include "info/realtime/latest_value.h"
#include "info/realtime/sample_log.h"
#include "robots/active_estimation.h"
#include "robots/instances.h"

/// The modules of active_estimation.h and what they exchange.
namespace info::detail {

struct Command {
  double value = 0;         // [m/s²]
  double from = 0, to = 0;  // [s]
};

// In what follows S is LengthUnknown or MassAndLengthUnknown.

template <class S>
struct EstimateMessage {
  ParametersOf<S> theta, sd;
  StateOf<S> x;
  StateSensitivityOf<S> psi;
  std::size_t samples;
  bool converged;
  int iterations;
};

template <class S>
struct Exchange {
  explicit Exchange(std::size_t capacity) : serialLine(capacity), samples(capacity) {}
  SampleLog<SystemReading> serialLine;  // arm to receiver
  SampleLog<SystemReading> samples;     // receiver to estimator and controller
  LatestValue<EstimateMessage<S>> estimate;
  LatestValue<Command> command;
};

inline std::size_t sampleCapacity(const ActiveEstimationTask& task) {
  return static_cast<std::size_t>(std::ceil(task.duration / kReceiverPeriod)) + 2;
}

template <class S>
S modelOf(const ActiveEstimationTask& task) {
  return {SuspendedMass{}, Vector<double, 2>(task.trueMass, task.initialLength)};
}

template <class S>
ParametersOf<S> initialTheta(const ActiveEstimationTask& task) {
  if constexpr (S::parameterSize == 1)
    return ParametersOf<S>(task.initialLength);
  else
    return ParametersOf<S>(task.initialMass, task.initialLength);
}

template <class S>
StateOf<S> initialState(const ActiveEstimationTask& task) {
  return {task.arm.start, 0, 0, 0};
}

/// Simulates the arm; every tenth tick a reading leaves on the serial line.
template <class S>
class ArmModule {
 public:
  ArmModule(const ActiveEstimationTask& task, Exchange<S>& exchange)
      : arm_(task.arm, task.cell, task.disturbance,
             Vector<double, 2>(task.trueMass, task.trueLength), task.seed, task.stream),
        exchange_(exchange) {
    exchange_.serialLine.append(arm_.read());
  }
  void tick() {
    exchange_.command.take(command_);
    const double t = arm_.time();
    arm_.advance(t >= command_.from && t < command_.to ? command_.value : 0.0);
    leastTension_ = std::min(leastTension_, arm_.tension());
    if (++ticks_ % 10 == 0) exchange_.serialLine.append(arm_.read());
  }
  double leastTension() const { return leastTension_; }
  double time() const { return arm_.time(); }

 private:
  CompliantArm arm_;
  Exchange<S>& exchange_;
  Command command_;
  long ticks_ = 0;
  double leastTension_ = std::numeric_limits<double>::infinity();
};

/// Takes what came over the line and passes on what makes sense.
template <class S>
class ReceiverModule {
 public:
  explicit ReceiverModule(Exchange<S>& exchange) : exchange_(exchange) {}
  void cycle() {
    for (const std::size_t end = exchange_.serialLine.size(); next_ < end; ++next_)
      exchange_.samples.append(exchange_.serialLine[next_]);
  }

 private:
  Exchange<S>& exchange_;
  std::size_t next_ = 0;
};

/// Estimates from all samples so far.
template <class S>
class EstimatorModule {
 public:
  using Map = Rk4<S>;
  EstimatorModule(const ActiveEstimationTask& task, Exchange<S>& exchange);

  void cycle(double time);
  const std::vector<std::pair<double, EstimateMessage<S>>>& history() const { return history_; }

 private:
  Exchange<S>& exchange_;
  OnlineLeastSquares<Map> squares_;
  std::size_t next_ = 0;
  std::vector<std::pair<double, EstimateMessage<S>>> history_;
};

/// Sequential action control on the state that the observer has.
///
/// The observer is the model at the latest estimate, run under the measured motion of the gripper
/// from the state the estimator gave.
template <class S>
class ControllerModule {
 public:
  ControllerModule(const ActiveEstimationTask& task, Exchange<S>& exchange);

  /// Allocates nothing.
  void cycle(double now);
  /// Brings x̄ to the last sample; each sample is predicted once, at the estimate of its time.
  void observe();
  /// The action to take now. ψ starts from 0: only information of the next seconds counts; with
  /// the ψ of the whole trial there would soon be nothing left to gain.
  Action<1> decide();

  struct Observed {
    double predictedForce, information;
  };
  const std::vector<Observed>& observed() const { return observed_; }
  std::size_t actions() const { return actions_; }
  std::size_t idle() const { return idle_; }
  ActionEnd first() const { return first_; }

 private:
  const ActiveEstimationTask& task_;
  Exchange<S>& exchange_;
  S model_;
  SequentialActionControl<S> control_;
  ParametersOf<S> theta_;
  StateOf<S> x_;
  StateSensitivityOf<S> psi_ = StateSensitivityOf<S>::Zero();
  std::size_t next_ = 0;
  std::vector<Observed> observed_;
  double information_ = 0;
  std::size_t actions_ = 0, idle_ = 0, decisions_ = 0;
  ActionEnd first_ = ActionEnd::notFinite;
};

// Instantiated once, in active_estimation_modules.cc.
extern template class EstimatorModule<LengthUnknown>;
extern template class EstimatorModule<MassAndLengthUnknown>;
extern template class ControllerModule<LengthUnknown>;
extern template class ControllerModule<MassAndLengthUnknown>;

}  // namespace info::detail
