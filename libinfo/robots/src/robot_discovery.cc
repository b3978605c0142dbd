#include "robots/robot_discovery.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace info::robot {
namespace {

constexpr double kShortestStep = 1e-3;  // [s]

[[noreturn]] void refuseSystem(const std::string& system) {
  throw std::invalid_argument(
      fmt::format("system '{}', must be double-pendulum or suspended-mass", system));
}

}  // namespace

std::vector<Channel> channelsOf(const std::string& system) {
  if (system == "double-pendulum") return doublePendulum().channels;
  if (system == "suspended-mass") return suspendedMass(0, 1).channels;
  refuseSystem(system);
}

Model modelFor(const std::string& system, const std::vector<Trial>& trials) {
  if (system == "double-pendulum") return doublePendulum();
  if (system != "suspended-mass") refuseSystem(system);
  double least = HUGE_VAL, greatest = -HUGE_VAL;
  for (const Trial& trial : trials)
    for (const double force : trial.measured.reshaped()) {
      if (std::isnan(force)) continue;
      least = std::min(least, force);
      greatest = std::max(greatest, force);
    }
  if (!(greatest > least))
    throw std::invalid_argument("the measured force is constant in all trials, must change");
  return suspendedMass(least, greatest);
}

std::vector<std::string> buildIn(const std::vector<KnownEffect>& effects, Model& model) {
  std::vector<std::string> removed;
  for (const KnownEffect& effect : effects) {
    const auto at = std::find_if(model.candidates.begin(), model.candidates.end(),
                                 [&](const auto& c) { return c.id == effect.id; });
    if (at == model.candidates.end())
      throw std::invalid_argument(fmt::format("effect {} is not in the catalogue", effect.id));
    for (const std::size_t q : at->quantities) {
      discover::Quantity& quantity = model.quantities[q];
      const auto given = effect.values.find(quantity.name);
      if (given == effect.values.end())
        throw std::invalid_argument(
            fmt::format("effect {} has no value of {}, must have one", effect.id, quantity.name));
      const double value = given->second;
      if (!(value >= quantity.lower && value <= quantity.upper))
        throw std::invalid_argument(fmt::format("{}: {} {}, must be {} to {}", quantity.name, value,
                                                quantity.unit, quantity.lower, quantity.upper));
      quantity.nominal = value;
    }
    if (at->kind == discover::EffectKind::parameter) {
      at->starts = {Eigen::VectorXd::Constant(1, model.quantities[at->quantities[0]].nominal)};
    } else {
      model.candidates.erase(at);
      removed.push_back(effect.id);
    }
  }
  return removed;
}

DiscoveryResult discover(const DiscoveryRequest& request) {
  for (const Trial& trial : request.trials) {
    const double duration = trial.times.size() < 2 ? 0 : trial.times.back() - trial.times.front();
    if (request.step && *request.step > duration)
      throw std::invalid_argument(
          fmt::format("step: {} s, must not be longer than {}, which lasts {} s", *request.step,
                      trial.name, duration));
  }
  DisagreementOptions problem = request.problem;
  discover::TrialSearch asked{request.trials.size(), request.numHeldOut, request.step,
                              problem.step,          kShortestStep,      request.search};
  if (!problem.sds.empty())
    asked.options.sds = discover::Whitening(
        Eigen::VectorXd::Map(problem.sds.data(), static_cast<Eigen::Index>(problem.sds.size())));
  DiscoveryResult result;
  result.found =
      discover::searchTrials(asked, [&](double step) -> const discover::DiscoveryProblem& {
        problem.step = step;
        result.data = std::make_unique<RobotProblem>(request.model, request.trials, problem);
        return *result.data;
      });
  result.fitted = discover::fittedNumbers(*result.data, result.found.verdict);
  return result;
}

}  // namespace info::robot
