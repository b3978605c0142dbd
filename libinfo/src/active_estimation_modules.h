#pragma once

#include "info/free_parameters.h"
#include "info/integrate.h"
#include "info/latest_value.h"
#include "info/sample_log.h"
#include "info/systems/active_estimation.h"

/// The modules of active_estimation.h and what they exchange.
namespace info::detail {

struct Command {
  double value = 0;         // [m/s²]
  double from = 0, to = 0;  // [s]
};

/// S is the suspended mass with its length, or mass and length, unknown.
template <class S>
struct EstimateMessage {
  ParametersOf<S> theta, deviation;
  StateOf<S> x;
  StateSensitivityOf<S> psi;
  std::size_t samples;
  bool converged;
  int iterations;
};

template <class S>
struct Exchange {
  explicit Exchange(std::size_t capacity) : serialLine(capacity), samples(capacity) {}
  SampleLog<ArmReading> serialLine;  // arm to receiver
  SampleLog<ArmReading> samples;     // receiver to estimator and controller
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

template <class S>
class EstimatorModule {
 public:
  using Map = Rk4<S>;
  EstimatorModule(const ActiveEstimationTask& task, Exchange<S>& exchange)
      : exchange_(exchange),
        squares_(Map{modelOf<S>(task), kReceiverPeriod}, initialState<S>(task), parameters(task),
                 {sensor(task)}, options(task)) {}

  void cycle(double time) {
    for (const std::size_t end = exchange_.samples.size(); next_ < end; ++next_) {
      const ArmReading& r = exchange_.samples[next_];
      squares_.add(Vector<double, 1>(r.acceleration), Vector<double, 1>(r.force));
    }
    if (next_ == 0) return;
    const OnlineEstimate<Map> e = squares_.update();
    EstimateMessage<S> message{
        e.parameters, e.covariance.diagonal().cwiseSqrt(), e.x, e.psi, e.samples, e.converged,
        e.iterations};
    exchange_.estimate.publish(message);
    history_.emplace_back(time, message);
  }
  const std::vector<std::pair<double, EstimateMessage<S>>>& history() const { return history_; }

 private:
  static std::vector<Parameter> parameters(const ActiveEstimationTask& task) {
    const Parameter length{.name = "length",
                           .unit = "m",
                           .start = task.initialLength,
                           .lower = 0.05,
                           .upper = 1.5,
                           .prior = GaussianPrior{task.initialLength, task.lengthDeviation}};
    if constexpr (S::parameterSize == 1) return {length};
    return {{.name = "mass",
             .unit = "kg",
             .start = task.initialMass,
             .lower = 0.01,
             .upper = 2,
             .prior = GaussianPrior{task.initialMass, task.massDeviation}},
            length};
  }
  static ClippedSensor sensor(const ActiveEstimationTask& task) {
    if (!task.modelClipping) return {.deviation = task.cell.deviation};
    return {.deviation = task.cell.deviation, .lower = 0, .upper = task.cell.capacity};
  }
  static OnlineOptions options(const ActiveEstimationTask& task) {
    OnlineOptions options;
    options.capacity = sampleCapacity(task);
    if (task.window > 0) {
      options.window = static_cast<std::size_t>(std::lround(task.window / kReceiverPeriod));
      options.startDeviation = Eigen::Vector4d(0, 0.1, 0, 0.5);
    }
    return options;
  }

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
  ControllerModule(const ActiveEstimationTask& task, Exchange<S>& exchange)
      : task_(task),
        exchange_(exchange),
        model_(modelOf<S>(task)),
        control_(model_, cost(task), Vector<double, 1>(-task.largestInput),
                 Vector<double, 1>(task.largestInput), Matrix<double, 1, 1>(task.inputWeight),
                 task.action),
        theta_(initialTheta<S>(task)),
        x_(initialState<S>(task)) {
    observed_.reserve(sampleCapacity(task));
  }

  /// Allocates nothing.
  void cycle(double now) {
    observe();
    EstimateMessage<S> message;
    if (exchange_.estimate.take(message)) {
      theta_ = message.theta;
      x_ = message.x;
      psi_ = message.psi;
      next_ = message.samples;
      observe();
    }
    const Action<1> action = decide();
    if (decisions_++ == 0) first_ = action.why;
    const bool acts = action.why == ActionEnd::acts;
    ++(acts ? actions_ : idle_);
    const double from = now + action.start;
    exchange_.command.publish(
        {action.value[0], from, from + std::min(action.duration, task_.longestApplied)});
  }

  /// Brings x̄ to the last sample; each sample is predicted once, at the estimate of its time.
  void observe() {
    const Rk4<S> map{model_, kReceiverPeriod};
    for (const std::size_t end = exchange_.samples.size(); next_ < end; ++next_) {
      const ArmReading& r = exchange_.samples[next_];
      const Vector<double, 1> u(r.acceleration);
      if (next_ > 0) {
        const Vector<double, 1> before(exchange_.samples[next_ - 1].acceleration);
        const auto step = advance(map, x_, psi_, before, u, theta_);
        x_ = step.solution.x1;
        psi_ = step.psi1;
      }
      x_[0] = r.position;
      x_[2] = r.velocity;
      if (next_ < observed_.size() || observed_.size() == observed_.capacity()) continue;
      const auto out = extendedOutput(model_, x_, psi_, u, theta_);
      const double gamma = out.along(0, S::parameterSize - 1) / task_.cell.deviation;
      if (r.force > 0 && r.force < task_.cell.capacity) information_ += gamma * gamma;
      observed_.push_back({out.value[0], information_});
    }
  }

  struct Observed {
    double predictedForce, information;
  };
  const std::vector<Observed>& observed() const { return observed_; }
  std::size_t actions() const { return actions_; }
  std::size_t idle() const { return idle_; }
  ActionEnd first() const { return first_; }
  /// What to do now. ψ starts from 0, so that information the next seconds add is what counts; with
  /// the ψ of the whole trial there would soon be nothing left to gain.
  Action<1> decide() { return control_.decide(x_, StateSensitivityOf<S>::Zero(), theta_); }

 private:
  static InformationRateCost<S> cost(const ActiveEstimationTask& task) {
    InformationRateCost<S> cost;
    cost.inverseCovariance(0, 0) = 1 / (task.informationDeviation * task.informationDeviation);
    cost.epsilon = task.epsilon;
    cost.stateWeight = task.trackingWeight.asDiagonal();
    return cost;
  }

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

}  // namespace info::detail
