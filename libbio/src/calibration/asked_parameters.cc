#include "calibration/asked_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "info/estimation/estimate.h"
#include "info/estimation/robust_loss.h"

namespace bio {
namespace {

using Eigen::Index;

void requireTransferable(const TrialSet& training, const TrialSet& heldOut) {
  if (heldOut.numCommon() != training.numCommon()) {
    throw std::invalid_argument("held-out trials must have the same common parameters");
  }
  for (const std::size_t index : training.selection()) {
    const ModelParameter& parameter = training.catalogue().parameters()[index];
    if (std::holds_alternative<InitialTarget>(parameter.targets.front())) {
      throw std::invalid_argument(fmt::format(
          "parameter '{}' belongs to one trial and cannot be transferred to held-out trials",
          parameter.name));
    }
  }
}

/// Numbers whose domain does not depend on the others.
bool hasOwnDomain(const ParameterTarget& target) {
  if (const auto* wrap = std::get_if<WrapTarget>(&target)) return wrap->isSize();
  if (const auto* body = std::get_if<BodyTarget>(&target))
    return body->quantity == BodyTarget::Quantity::mass;
  return !std::holds_alternative<PointTarget>(target) &&
         !std::holds_alternative<InitialTarget>(target);
}

/// The bound itself may be the open end of the domain: what lies just inside is tried.
void requireInDomain(const TrialSet& training, std::size_t index, double bound,
                     const std::string& what) {
  const ModelParameter& parameter = training.catalogue().parameters()[index];
  if (!std::isfinite(bound) || !hasOwnDomain(parameter.targets.front())) return;
  const double inside = bound + 1e-9 * (parameter.value - bound);
  try {
    const ParameterCatalogue::Setting there =
        training.catalogue().at({index}, Eigen::VectorXd::Constant(1, inside));
    const MusculoskeletalSystem system(there.model, training.options());
    std::vector<std::string> muscles;
    for (const SystemMuscle& muscle : system.muscles()) muscles.push_back(muscle.name);
    requireValid(muscles, there.mapping);
  } catch (const std::invalid_argument& rule) {
    throw std::invalid_argument(
        fmt::format("{}{} = {:.6g}{}{} is outside of its domain: {}", what, parameter.name, bound,
                    parameter.unit.empty() ? "" : " ", parameter.unit, rule.what()));
  }
}

void setBounds(const TrialSet& training, const CalibrationOptions& options,
               std::vector<info::Parameter>& parameters) {
  for (const auto& [name, bounds] : options.bounds) {
    const std::size_t i = placeOfParameter(training, name, "bounds");
    std::tie(parameters[i].lower, parameters[i].upper) = bounds;
    const std::size_t index = training.selection()[i];
    training.catalogue().requireBelowLimit(index, parameters[i].upper, "upper bound of ");
    requireInDomain(training, index, parameters[i].lower, "lower bound of ");
    requireInDomain(training, index, parameters[i].upper, "upper bound of ");
  }
}

void setPriors(const TrialSet& training, const CalibrationOptions& options,
               AskedParameters& asked) {
  for (std::size_t i = 0; i < training.numCommon() && options.priors; ++i) {
    asked.parameters[i].prior =
        info::GaussianPrior{asked.parameters[i].start, asked.priorSds[static_cast<Index>(i)]};
  }
  for (const auto& [name, prior] : options.prior) {
    const std::size_t i = placeOfParameter(training, name, "prior");
    info::Parameter& parameter = asked.parameters[i];
    parameter.prior = prior;
    asked.priorSds[static_cast<Index>(i)] = prior.sd;
    // a prior given by the user replaces the model's value as the start
    if (parameter.lower <= parameter.upper && std::isfinite(prior.mean)) {
      parameter.start = std::clamp(prior.mean, parameter.lower, parameter.upper);
    }
  }
}

}  // namespace

void requireValid(const CalibrationOptions& options) {
  if (options.noise && !(*options.noise > 0 && std::isfinite(*options.noise))) {
    throw std::invalid_argument(fmt::format("noise {} rad must be > 0", *options.noise));
  }
  if (options.starts < 1) {
    throw std::invalid_argument(fmt::format("starts = {} must be ≥ 1", options.starts));
  }
  if (options.bootstrap != 0 && options.bootstrap < 20) {
    throw std::invalid_argument(
        fmt::format("bootstrap = {} replicates must be 0 or ≥ 20", options.bootstrap));
  }
  info::normalQuantile(options.confidence);
  info::evaluate(options.loss, 0);
}

std::size_t placeOfParameter(const TrialSet& training, const std::string& name, const char* what) {
  if (namesKnot(name)) {
    throw std::invalid_argument(fmt::format(
        "{} of '{}': knots of latent excitations belong to single trials and have the prior that "
        "the trial's header (latent_excitation) or --latent MUSCLE=SD:SECONDS gives, and no other",
        what, name));
  }
  const ParameterCatalogue& catalogue = training.catalogue();
  const std::size_t wanted = catalogue.find(name);
  const auto& selection = training.selection();
  const auto at = std::find(selection.begin(), selection.end(), wanted);
  if (at == selection.end()) {
    throw std::invalid_argument(fmt::format("{} of '{}': is not among the parameters to estimate",
                                            what, catalogue.parameters()[wanted].name));
  }
  return static_cast<std::size_t>(at - selection.begin());
}

AskedParameters askedParameters(const TrialSet& training, const TrialSet* heldOut,
                                const CalibrationOptions& options) {
  if (heldOut) requireTransferable(training, *heldOut);
  AskedParameters asked{training.parameters(), training.priorSds()};
  // bounds first: a prior's mean becomes the start within them
  setBounds(training, options, asked.parameters);
  setPriors(training, options, asked);
  if (options.from) {
    if (options.from->size() != static_cast<Index>(asked.parameters.size())) {
      throw std::invalid_argument(fmt::format("start of {} numbers, must be {}",
                                              options.from->size(), asked.parameters.size()));
    }
    for (std::size_t i = 0; i < asked.parameters.size(); ++i)
      asked.parameters[i].start = (*options.from)[static_cast<Index>(i)];
  }
  info::checkParameters(asked.parameters);
  return asked;
}

}  // namespace bio
