#include "active_estimation_modules.h"

namespace info::detail {
namespace {

template <class S>
std::vector<Parameter> unknownParameters(const ActiveEstimationTask& task) {
  const Parameter length{.name = "length",
                         .unit = "m",
                         .start = task.initialLength,
                         .lower = 0.05,
                         .upper = 1.5,
                         .prior = GaussianPrior{task.initialLength, task.lengthSd}};
  if constexpr (S::parameterSize == 1) return {length};
  return {{.name = "mass",
           .unit = "kg",
           .start = task.initialMass,
           .lower = 0.01,
           .upper = 2,
           .prior = GaussianPrior{task.initialMass, task.massSd}},
          length};
}

ClippedSensor loadCell(const ActiveEstimationTask& task) {
  if (!task.modelClipping) return {.sd = task.cell.sd};
  return {.sd = task.cell.sd, .lower = 0, .upper = task.cell.capacity};
}

OnlineOptions onlineOptions(const ActiveEstimationTask& task) {
  OnlineOptions options;
  options.capacity = sampleCapacity(task);
  if (task.window > 0) {
    options.window = static_cast<std::size_t>(std::lround(task.window / kReceiverPeriod));
    options.startSd = Eigen::Vector4d(0, 0.1, 0, 0.5);
  }
  return options;
}

template <class S>
InformationRateCost<S> actionCost(const ActiveEstimationTask& task) {
  InformationRateCost<S> cost;
  cost.inverseCovariance(0, 0) = 1 / (task.informationSd * task.informationSd);
  cost.epsilon = task.epsilon;
  cost.stateWeight = task.trackingWeight.asDiagonal();
  return cost;
}

}  // namespace

template <class S>
EstimatorModule<S>::EstimatorModule(const ActiveEstimationTask& task, Exchange<S>& exchange)
    : exchange_(exchange),
      squares_(Map{modelOf<S>(task), kReceiverPeriod}, initialState<S>(task),
               unknownParameters<S>(task), {loadCell(task)}, onlineOptions(task)) {}

template <class S>
void EstimatorModule<S>::cycle(double time) {
  for (const std::size_t end = exchange_.samples.size(); next_ < end; ++next_) {
    const SystemReading& r = exchange_.samples[next_];
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

template <class S>
ControllerModule<S>::ControllerModule(const ActiveEstimationTask& task, Exchange<S>& exchange)
    : task_(task),
      exchange_(exchange),
      model_(modelOf<S>(task)),
      control_(model_, actionCost<S>(task), Vector<double, 1>(-task.largestInput),
               Vector<double, 1>(task.largestInput), Matrix<double, 1, 1>(task.inputWeight),
               task.action),
      theta_(initialTheta<S>(task)),
      x_(initialState<S>(task)) {
  observed_.reserve(sampleCapacity(task));
}

template <class S>
void ControllerModule<S>::cycle(double now) {
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

template <class S>
void ControllerModule<S>::observe() {
  const Rk4<S> map{model_, kReceiverPeriod};
  for (const std::size_t end = exchange_.samples.size(); next_ < end; ++next_) {
    const SystemReading& r = exchange_.samples[next_];
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
    const double gamma = out.along(0, S::parameterSize - 1) / task_.cell.sd;
    if (r.force > 0 && r.force < task_.cell.capacity) information_ += gamma * gamma;
    observed_.push_back({out.value[0], information_});
  }
}

template <class S>
Action<1> ControllerModule<S>::decide() {
  return control_.decide(x_, StateSensitivityOf<S>::Zero(), theta_);
}

template class EstimatorModule<LengthUnknown>;
template class EstimatorModule<MassAndLengthUnknown>;
template class ControllerModule<LengthUnknown>;
template class ControllerModule<MassAndLengthUnknown>;

}  // namespace info::detail
