#include "robots/active_estimation.h"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "active_estimation_modules.h"

namespace info {
namespace {

void check(const ActiveEstimationTask& task) {
  const auto positive = [](const char* what, double value, const char* unit) {
    if (!(value > 0 && std::isfinite(value)))
      throw std::domain_error(fmt::format("{}: {} {}, must be > 0 and finite", what, value, unit));
  };
  positive("initial length", task.initialLength, "m");
  positive("initial mass", task.initialMass, "kg");
  positive("duration", task.duration, "s");
  positive("largest input", task.largestInput, "m/s²");
  positive("standard deviation in the cost of information", task.informationSd, "N");
  positive("longest application of an action", task.longestApplied, "s");
  if (!(task.initialLength >= 0.05 && task.initialLength <= 1.5))
    throw std::domain_error(
        fmt::format("initial length: {} m, must be 0.05 to 1.5", task.initialLength));
  if (!(task.window >= 0) || (task.window > 0 && task.window < 0.1))
    throw std::domain_error(fmt::format("window: {} s, must be 0 or ≥ 0.1", task.window));
}

/// All modules of one trial.
template <class S>
struct Trial {
  explicit Trial(const ActiveEstimationTask& given)
      : task(given),
        exchange(detail::sampleCapacity(task)),
        arm(task, exchange),
        receiver(exchange),
        estimator(task, exchange),
        controller(task, exchange) {}

  ActiveEstimationResult result(const CycleTimes& cycles) {
    controller.observe();
    ActiveEstimationResult out;
    constexpr int last = S::parameterSize - 1;
    const auto at = [&](double time, const auto& theta, const auto& sd, bool converged,
                        int iterations) {
      out.estimates.push_back({time, theta[last], sd[last], last > 0 ? theta[0] : task.trueMass,
                               last > 0 ? sd[0] : 0.0, converged, iterations});
    };
    ParametersOf<S> prior;
    prior[0] = task.massSd;
    prior[last] = task.lengthSd;
    at(0, detail::initialTheta<S>(task), prior, true, 0);
    for (const auto& [time, m] : estimator.history())
      at(time, m.theta, m.sd, m.converged, m.iterations);
    for (std::size_t k = 0; k < controller.observed().size(); ++k) {
      const SystemReading& r = exchange.samples[k];
      out.samples.push_back(
          {r, controller.observed()[k].predictedForce, controller.observed()[k].information});
      if (r.force >= task.cell.capacity || r.force <= 0) ++out.clippedSamples;
    }
    out.actions = controller.actions();
    out.idle = controller.idle();
    out.leastTension = arm.leastTension();
    out.firstDecision = controller.first();
    out.controller = cycles.report();
    out.cycleSeconds = cycles.busy();
    return out;
  }

  ActiveEstimationTask task;
  detail::Exchange<S> exchange;
  detail::ArmModule<S> arm;
  detail::ReceiverModule<S> receiver;
  detail::EstimatorModule<S> estimator;
  detail::ControllerModule<S> controller;
};

std::size_t cyclesOf(const ActiveEstimationTask& task, double period) {
  return static_cast<std::size_t>(std::ceil(task.duration / period)) + 2;
}

template <class S>
ActiveEstimationResult runInOneThread(const ActiveEstimationTask& task) {
  Trial<S> trial(task);
  CycleTimes cycles(cyclesOf(task, kControllerPeriod));
  const long ticks = std::lround(task.duration / CompliantArm::tick);
  const auto every = [](double period) { return std::lround(period / CompliantArm::tick); };
  const long receiver = every(kReceiverPeriod), controller = every(kControllerPeriod),
             estimator = every(kEstimatorPeriod);
  for (long k = 0;; ++k) {
    const double now = static_cast<double>(k) * CompliantArm::tick;
    if (k > 0) trial.arm.tick();
    if (k % receiver == 0) trial.receiver.cycle();
    if (k > 0 && (k % estimator == 0 || k == ticks)) trial.estimator.cycle(now);
    if (k == ticks) break;
    if (k % controller == 0) {
      const Clock::time_point begin = Clock::now();
      trial.controller.cycle(now);
      cycles.add(0, std::chrono::duration<double>(Clock::now() - begin).count(), kControllerPeriod);
    }
  }
  return trial.result(cycles);
}

template <class S>
ActiveEstimationResult runInThreads(const ActiveEstimationTask& task,
                                    const std::function<bool(double)>& keepGoing) {
  Trial<S> trial(task);
  CycleTimes control(cyclesOf(task, kControllerPeriod)), receive(cyclesOf(task, kReceiverPeriod)),
      estimate(cyclesOf(task, kEstimatorPeriod)), move(cyclesOf(task, CompliantArm::tick));
  std::atomic<bool> priority = true;
  const Clock::time_point start = Clock::now() + std::chrono::milliseconds(50);
  const Clock::time_point end = start + std::chrono::duration_cast<Clock::duration>(
                                            std::chrono::duration<double>(task.duration));
  const auto run = [&](double period, int urgency, CycleTimes& times, auto body) {
    return std::jthread([&, period, urgency, body](const std::stop_token& stop) {
      if (!askForRealTime(urgency)) priority = false;
      const auto cycleOn = [&](std::size_t cycle) {
        body(cycle);
        return true;
      };
      runPeriodically(start, end, period, times, cycleOn, stop);
    });
  };
  {
    // the arm makes up for ticks that its thread slept through: time in the world does not wait
    const auto moveSystem = [&](std::size_t cycle) {
      while (std::lround(trial.arm.time() / CompliantArm::tick) <= static_cast<long>(cycle))
        trial.arm.tick();
    };
    // a keepGoing that throws leaves through their destructors, which stop and join
    std::array<std::jthread, 4> modules = {
        run(CompliantArm::tick, 40, move, moveSystem),
        run(kReceiverPeriod, 30, receive, [&](std::size_t) { trial.receiver.cycle(); }),
        run(kControllerPeriod, 35, control,
            [&](std::size_t cycle) {
              trial.controller.cycle(static_cast<double>(cycle) * kControllerPeriod);
            }),
        run(kEstimatorPeriod, 10, estimate, [&](std::size_t cycle) {
          if (cycle > 0) trial.estimator.cycle(static_cast<double>(cycle) * kEstimatorPeriod);
        })};
    bool goOn = true;
    while (goOn && Clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      goOn = !keepGoing || keepGoing(std::chrono::duration<double>(Clock::now() - start).count());
    }
    for (std::jthread& module : modules) {
      if (!goOn) module.request_stop();
    }
    for (std::jthread& module : modules) module.join();
  }
  // what came in after the estimator's last turn
  trial.receiver.cycle();
  trial.estimator.cycle(task.duration);
  ActiveEstimationResult out = trial.result(control);
  out.receiver = receive.report();
  out.estimator = estimate.report();
  out.armLoop = move.report();
  out.realTimePriority = priority;
  return out;
}

}  // namespace

ActiveEstimationResult runActiveEstimation(const ActiveEstimationTask& task) {
  check(task);
  return task.estimateMass ? runInOneThread<MassAndLengthUnknown>(task)
                           : runInOneThread<LengthUnknown>(task);
}

ActiveEstimationResult runActiveEstimationInRealTime(
    const ActiveEstimationTask& task, const std::function<bool(double time)>& keepGoing) {
  check(task);
  return task.estimateMass ? runInThreads<MassAndLengthUnknown>(task, keepGoing)
                           : runInThreads<LengthUnknown>(task, keepGoing);
}

Action<1> firstAction(const ActiveEstimationTask& task) {
  check(task);
  if (task.estimateMass) return Trial<MassAndLengthUnknown>(task).controller.decide();
  return Trial<LengthUnknown>(task).controller.decide();
}

std::vector<double> initialLengths() {
  std::vector<double> lengths;
  for (int i = 0; i < 9; ++i) lengths.push_back(0.308 + 0.02 * i);
  return lengths;
}

}  // namespace info
