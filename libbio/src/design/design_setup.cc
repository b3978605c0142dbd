#include "bio/design/design_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "bio/analysis/replay.h"
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

DesignLimits withCoordinates(DesignLimits limits, const MusculoskeletalSystem& system,
                             const GivenLimits& given) {
  std::map<std::string, const Coordinate*> free;
  const auto& all = system.skeleton().coordinates();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!system.isPrescribed(static_cast<int>(i))) free[all[i].name] = &all[i];
  }
  const auto checkNames = [&](const char* what, const auto& byName) {
    for (const auto& one : byName) {
      if (one.first.empty() || free.contains(one.first)) continue;
      throw std::invalid_argument(
          fmt::format("{} of '{}': must be a coordinate that is free to move", what, one.first));
    }
  };
  checkNames("range", given.range);
  checkNames("torque", given.torque);
  checkNames("speed", given.speed);
  if (given.range.contains("") && free.size() > 1) {
    throw std::invalid_argument(
        fmt::format("range: must name its coordinate, of which {} are free", free.size()));
  }
  const auto numberOf = [](const std::map<std::string, double>& byName, const std::string& name) {
    const auto at = byName.contains(name) ? byName.find(name) : byName.find("");
    return at == byName.end() ? 0 : at->second;
  };
  limits.coordinates.clear();
  for (const Coordinate& coordinate : all) {
    if (!free.contains(coordinate.name)) continue;
    std::pair<double, double> range(coordinate.rangeMin, coordinate.rangeMax);
    const auto at = given.range.contains(coordinate.name) ? given.range.find(coordinate.name)
                                                          : given.range.find("");
    if (at != given.range.end()) range = at->second;
    if (!(range.first < range.second)) {
      throw std::invalid_argument(fmt::format("range: {:.4g} to {:.4g} {}, must rise", range.first,
                                              range.second, coordinate.isRotation ? "rad" : "m"));
    }
    limits.coordinates.push_back({coordinate.name, range.first, range.second,
                                  numberOf(given.speed, coordinate.name),
                                  numberOf(given.torque, coordinate.name)});
  }
  return limits;
}

std::vector<ChannelCandidate> freeCoordinates(const MusculoskeletalSystem& system, double angle,
                                              double shift) {
  std::vector<ChannelCandidate> observed;
  const auto& all = system.skeleton().coordinates();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (system.isPrescribed(static_cast<int>(i))) continue;
    observed.push_back({ofCoordinate(all[i].name), all[i].isRotation ? angle : shift});
  }
  return observed;
}

std::vector<MuscleGroup> muscleGroups(const MusculoskeletalSystem& system, const Eigen::VectorXd& q,
                                      const std::vector<std::string>& names) {
  std::vector<MuscleGroup> groups;
  for (const std::string& text : names) {
    const auto dot = text.rfind('.');
    const int index =
        dot == std::string::npos ? -1 : system.skeleton().indexOf(text.substr(0, dot));
    const std::string word = index < 0 ? text : text.substr(dot + 1);
    const std::vector<MuscleGroup> named = flexorsAndExtensors(system, q, std::max(0, index));
    const auto at = std::find_if(named.begin(), named.end(),
                                 [&](const MuscleGroup& group) { return group.name == word; });
    groups.push_back({text, at != named.end() ? at->muscles : joinedByPlus(text)});
  }
  return groups;
}

info::MonteCarloResult simulatedRepetitions(const ExperimentDesign& design,
                                            const DesignedExperiment& experiment,
                                            const ParameterCatalogue& catalogue,
                                            const SystemOptions& built,
                                            SimulationOptions simulation,
                                            info::MonteCarloOptions options) {
  const DesignQuestion& q = design.question();
  if (!q.nuisance.empty()) {
    throw std::invalid_argument(
        "repetitions of an experiment with nuisance parameters: must have "
        "none");
  }
  RecordedTrial planned = recordedTrial(experiment.trial, design.system(), std::move(simulation));
  std::vector<ObservedSeries> series;
  for (const ChannelCandidate& candidate : q.observed) {
    series.push_back({candidate.what, experiment.measuredTimes});
  }
  const TrialPredictor predictor(catalogue, built, std::move(planned.excitation), std::move(series),
                                 q.parameters, planned.simulation);
  // in units that give all samples the noise of the first observable
  const double noise = q.observed.front().sd;
  Eigen::VectorXd units(predictor.size());
  const Eigen::Index n = experiment.measuredTimes.size();
  for (std::size_t o = 0; o < q.observed.size(); ++o) {
    units.segment(static_cast<Eigen::Index>(o) * n, n).setConstant(noise / q.observed[o].sd);
  }
  info::Predictor alike = predictor.predictor();
  const auto outputs = alike.outputs;
  const auto withSensitivities = alike.withSensitivities;
  alike.outputs = [&](const Eigen::VectorXd& theta) -> Eigen::MatrixXd {
    return outputs(theta) * units.asDiagonal();
  };
  alike.withSensitivities = [&](const Eigen::VectorXd& theta) {
    info::Prediction at = withSensitivities(theta);
    at.outputs = at.outputs * units.asDiagonal();
    at.gamma = units.asDiagonal() * at.gamma;
    return at;
  };
  options.startSpread = 0.0005;
  options.estimate.decrementTolerance = 1e-6;
  return info::monteCarlo(alike, catalogue.values(q.parameters),
                          info::OutputCovariance(Eigen::MatrixXd::Constant(1, 1, noise * noise)),
                          catalogue.asEstimated(q.parameters, false), options);
}

}  // namespace bio
