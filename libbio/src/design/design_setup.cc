#include "bio/design/design_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "bio/observation/trial_predictor.h"

namespace bio {
namespace {

/// "a+b" → a, b
std::vector<std::string> joinedByPlus(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, '+');) parts.push_back(part);
  return parts;
}

}  // namespace

DesignQuestion designQuestion(const ParameterCatalogue& catalogue, const DesignNames& names,
                              DesignQuestion question) {
  question.parameters = catalogue.select(names.parameters);
  question.nuisance.clear();
  if (!names.nuisance.empty()) question.nuisance = catalogue.select(names.nuisance);
  // a pattern among the nuisance parameters may take in what is asked for
  std::erase_if(question.nuisance, [&](std::size_t index) {
    return std::find(question.parameters.begin(), question.parameters.end(), index) !=
           question.parameters.end();
  });
  std::vector<std::size_t> all = question.parameters;
  all.insert(all.end(), question.nuisance.begin(), question.nuisance.end());
  question.priorSd = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(all.size()),
                                               std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (names.priors || i >= question.parameters.size()) {
      question.priorSd[static_cast<Eigen::Index>(i)] = catalogue.parameters()[all[i]].sd;
    }
  }
  for (const auto& [name, sd] : names.priorSd) {
    const auto at = std::find(all.begin(), all.end(), catalogue.find(name));
    if (at == all.end()) {
      throw std::invalid_argument(fmt::format(
          "prior: {} is neither a parameter of interest nor a nuisance parameter", name));
    }
    if (!(sd > 0)) {
      throw std::invalid_argument(fmt::format("prior: {} = {}, must be > 0", name, sd));
    }
    question.priorSd[at - all.begin()] = sd;
  }
  return question;
}

info::Optimality optimalityNamed(const std::string& letter) {
  if (letter == "E") return info::Optimality::e;
  if (letter == "A") return info::Optimality::a;
  if (letter == "D") return info::Optimality::d;
  throw std::invalid_argument(fmt::format("criterion '{}', must be E, A or D", letter));
}

DesignLimits withinRange(DesignLimits limits, const Coordinate& coordinate,
                         const std::optional<std::pair<double, double>>& range) {
  limits.lower = range ? range->first : coordinate.rangeMin;
  limits.upper = range ? range->second : coordinate.rangeMax;
  if (range && !(limits.lower < limits.upper)) {
    throw std::invalid_argument(fmt::format("range: {:.4g} to {:.4g} {}, must rise", limits.lower,
                                            limits.upper, coordinate.isRotation ? "rad" : "m"));
  }
  return limits;
}

std::vector<MuscleGroup> muscleGroups(const MusculoskeletalSystem& arm, const Eigen::VectorXd& q,
                                      const std::vector<std::string>& names) {
  std::vector<MuscleGroup> groups;
  for (const std::string& text : names) {
    const std::vector<MuscleGroup> named = flexorsAndExtensors(arm, q);
    const auto at = std::find_if(named.begin(), named.end(),
                                 [&](const MuscleGroup& group) { return group.name == text; });
    groups.push_back(at != named.end() ? *at : MuscleGroup{text, joinedByPlus(text)});
  }
  return groups;
}

info::MonteCarloResult simulatedRepetitions(const ExperimentDesign& design,
                                            const DesignedExperiment& experiment,
                                            const ParameterCatalogue& catalogue,
                                            const SystemOptions& system,
                                            SimulationOptions simulation,
                                            info::MonteCarloOptions options) {
  const DesignQuestion& q = design.question();
  if (!q.nuisance.empty()) {
    throw std::invalid_argument(
        "repetitions of an experiment with nuisance parameters: must have "
        "none");
  }
  simulation.externalForce = experiment.torque;
  const TrialPredictor predictor(catalogue, system, experiment.excitation, q.coordinate,
                                 {experiment.measuredTimes.begin(), experiment.measuredTimes.end()},
                                 q.parameters, simulation);
  options.startSpread = 0.0005;
  options.estimate.decrementTolerance = 1e-6;
  return info::monteCarlo(
      predictor.predictor(), catalogue.values(q.parameters),
      info::OutputCovariance(Eigen::MatrixXd::Constant(1, 1, q.noise * q.noise)),
      catalogue.asEstimated(q.parameters, false), options);
}

}  // namespace bio
