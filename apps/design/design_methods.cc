#include "design/design_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bio/model/units.h"
#include "design/planned_figures.h"
#include "output/text.h"

namespace app {
namespace {

void sayMeasured(const std::vector<bio::ChannelCandidate>& observed, double period,
                 const bio::Model& model, Methods& methods) {
  methods.say(Methods::Part::inference,
              fmt::format("The experiment lasts as long as the trial; what is measured is {}, with "
                          "independent normal noise of that standard deviation.",
                          measurementText(observed, period, model)));
}

/// The designed inputs with their limits.
void sayInputs(const PlannedInputs& planned, double knots, Methods& methods) {
  const bio::DesignLimits& limits = planned.inputs.limits();
  std::vector<std::string> inputs;
  for (const bio::CoordinateLimits& one : planned.inputs.torques()) {
    const std::string unit = planned.torqueUnit(one.coordinate);
    inputs.push_back(fmt::format("a {} on {} (at most {} {} and {} {}/s)",
                                 planned.coordinate(one.coordinate).isRotation ? "torque" : "force",
                                 one.coordinate, numberText(one.torque), unit,
                                 numberText(limits.torqueRate), unit));
  }
  for (const bio::MuscleGroup& group : planned.inputs.groups()) {
    inputs.push_back(fmt::format("an excitation of {} ({} to {}, at most {} per second)",
                                 listed(group.muscles), numberText(limits.leastExcitation),
                                 numberText(limits.largestExcitation),
                                 numberText(limits.excitationRate)));
  }
  methods.say(Methods::Part::inference,
              fmt::format("The designed inputs are {}, piecewise linear between knots every {} s; "
                          "everything else is as in the trial.",
                          listed(inputs), numberText(knots)));
  if (limits.coordinates.empty()) return;
  std::vector<std::string> ranges;
  for (const bio::CoordinateLimits& one : limits.coordinates) {
    const bio::ShownUnit unit = planned.unitOf(one.coordinate);
    ranges.push_back(fmt::format("{} stays between {} and {} {} with speeds up to {} {}/s",
                                 one.coordinate, numberText(one.lower * unit.factor),
                                 numberText(one.upper * unit.factor), unit.name,
                                 numberText(one.speed * unit.factor), unit.name));
  }
  methods.say(Methods::Part::inference, fmt::format("In the result {}.", listed(ranges)));
}

void saySearch(const DesignOptions& typed, bool hasGradients, Methods& methods) {
  const bio::DesignSearchSettings& settings = typed.settings;
  std::vector<std::string> stages;
  std::vector<Publication> cited;
  if (settings.candidates > 0) stages.push_back(counted(settings.candidates, "random design"));
  if (settings.generations > 0) {
    stages.push_back(fmt::format("{} of CMA-ES ({}) from the best of them",
                                 counted(settings.generations, "generation"),
                                 citation(Publication::hansen2016)));
    cited.push_back(Publication::hansen2016);
  }
  if (hasGradients && settings.iterations > 0) {
    stages.push_back(
        fmt::format("{} along exact gradients", counted(settings.iterations, "iteration")));
  }
  if (stages.empty()) return;
  methods.say(Methods::Part::inference,
              fmt::format("The search has {} (seed {}) and keeps the best experiment that respects "
                          "every limit.",
                          listed(stages), settings.seed),
              cited);
}

std::vector<std::string> namesIn(const std::vector<bio::ModelParameter>& parameters,
                                 std::size_t from, std::size_t to) {
  std::vector<std::string> names;
  for (std::size_t i = from; i < to; ++i) names.push_back(parameters[i].name);
  return names;
}

void sayCriterion(const DesignFindings& f, Methods& methods) {
  const bio::DesignQuestion& question = f.design.question();
  const std::size_t asked = question.parameters.size();
  std::string unknown = listed(namesIn(f.parameters, 0, asked));
  if (!question.nuisance.empty()) {
    unknown += fmt::format(", with {} unknown as well",
                           listed(namesIn(f.parameters, asked, f.parameters.size())));
  }
  std::vector<std::string> withPrior;
  for (std::size_t i = 0; i < f.parameters.size(); ++i) {
    if (std::isfinite(question.priorSd[static_cast<Eigen::Index>(i)]))
      withPrior.push_back(f.parameters[i].name);
  }
  std::string criterion;
  switch (question.criterion) {
    case info::Optimality::a:
      criterion = "A-optimality: the trace of the inverse of I is least";
      break;
    case info::Optimality::d:
      criterion = "D-optimality: the determinant of I is largest";
      break;
    default:
      criterion = "E-optimality: the least eigenvalue of I is largest";
  }
  methods.say(
      Methods::Part::inference,
      fmt::format("It was designed for {}, by {}, where I = Σ ΓᵀΓ/σ² is the Fisher "
                  "information of all samples about the parameters, each in units of its "
                  "default prior standard deviation, Γ their exact sensitivities and σ the "
                  "noise{}.",
                  unknown, criterion,
                  question.nuisance.empty()
                      ? ""
                      : "; the nuisance parameters are eliminated by the Schur complement"));
  if (!withPrior.empty()) {
    methods.say(Methods::Part::inference,
                fmt::format("I includes the prior of {}.", listed(withPrior)));
  }
}

}  // namespace

void sayDesign(const DesignFindings& f, const DesignOptions& typed, Methods& methods) {
  const bio::DesignQuestion& question = f.design.question();
  const PlannedInputs planned{f.model, f.design.inputs(), f.result.before.trial,
                              f.result.after.trial};
  sayMeasured(question.observed, question.period, f.model, methods);
  sayCriterion(f, methods);
  sayInputs(planned, typed.knots, methods);
  const double robustness = planned.inputs.limits().robustness;
  if (robustness > 0 && !planned.inputs.limits().coordinates.empty()) {
    methods.say(Methods::Part::inference,
                fmt::format("The ranges are respected, to first order, even if the "
                            "parameters of interest are {} prior standard deviations "
                            "off.",
                            numberText(robustness)));
  }
  saySearch(typed, true, methods);
  if (f.monteCarlo) {
    methods.say(Methods::Part::inference,
                fmt::format("{} repetitions of the designed experiment with independent noise were "
                            "simulated, and the parameters of interest estimated from each by "
                            "least squares (Levenberg–Marquardt).",
                            f.monteCarlo->trials.size()));
  }
  methods.assume(
      "The model is right, and all parameters that are not named as unknown have the model's "
      "values; bounds are Cramér–Rao bounds at the model's values.");
}

void saySeparation(const SeparatingFindings& f, const DesignOptions& typed, Methods& methods) {
  const auto& question = f.design.question();
  sayMeasured(question.observed, question.period, f.model, methods);
  const auto sized = [](const std::string& name, double size, const std::string& unit) {
    return fmt::format("{} of {}", name, withUnit(size, unit, 3));
  };
  methods.say(
      Methods::Part::inference,
      fmt::format("It was designed to discriminate between {} and {}: the smaller of both expected "
                  "log Bayes factors, of either effect if it is present against the other with a "
                  "free size ({}), is largest.",
                  sized(f.design.first().name, question.firstSize, f.design.unitOfFirst()),
                  sized(f.design.second().name, question.secondSize, f.design.unitOfSecond()),
                  citation(Publication::kassRaftery1995)),
      {Publication::kassRaftery1995});
  const PlannedInputs planned{f.model, f.design.inputs(), f.result.before.trial,
                              f.result.after.trial};
  sayInputs(planned, typed.knots, methods);
  saySearch(typed, false, methods);
  methods.assume(
      "Every parameter of the model is uncertain by its default prior, and outputs are linear in "
      "what is uncertain; effects outside the catalogue are not considered.");
}

void sayDynamometer(const bio::DynamometerPlan& plan, const bio::DynamometerQuestion& question,
                    bool turns, Methods& methods) {
  std::vector<std::string> kinds, efforts, positions;
  const bio::ShownUnit unit = bio::positionUnit(turns);
  for (const auto kind : question.kinds) kinds.emplace_back(bio::name(kind));
  for (const double effort : question.efforts) efforts.push_back(numberText(100 * effort));
  for (const double position : question.positions)
    positions.push_back(numberText(unit.factor * position));
  const bool contracts = std::any_of(question.kinds.begin(), question.kinds.end(), [](auto kind) {
    return kind != bio::DynamometerExperiment::Kind::passive;
  });
  methods.say(
      Methods::Part::inference,
      fmt::format("{} experiments on a dynamometer at {} were simulated: {}, at {} {}{}, with {} "
                  "samples per second and independent normal noise of {} {} of the moment.",
                  plan.candidates, question.coordinate, listed(kinds), listed(positions), unit.name,
                  contracts ? fmt::format(" and efforts of {} % MVC", listed(efforts)) : "",
                  numberText(question.rate), numberText(question.noise), turns ? "N m" : "N"));
  std::vector<std::string> names;
  for (const bio::ModelParameter& parameter : plan.parameters) names.push_back(parameter.name);
  methods.say(
      Methods::Part::inference,
      fmt::format(
          "{} of them were chosen one after the other, each the one that adds most to "
          "½ ln det(I + Λ) about {}{}, with I the Fisher information of what is measured by "
          "exact sensitivities and Λ that of the default priors; none is chosen twice.",
          plan.chosen.size(), listed(names),
          question.nuisance.empty()
              ? ""
              : fmt::format(" ({} being unknown as well)", listed(question.nuisance))));
  methods.assume(
      "Nothing else is unknown, antagonists rest, and the excitation is the EMG over that of a "
      "maximum voluntary contraction.");
}

}  // namespace app
