#include "arm_discovery.h"

#include <fmt/format.h>

#include <cmath>

#include "angle_unit.h"
#include "arm_input.h"
#include "arm_options.h"
#include "bio/discover/add_effects.h"
#include "bio/discover/elbow_disagreement.h"
#include "bio/osim_file.h"
#include "discover_report.h"
#include "discover_search.h"
#include "driven_trial.h"
#include "follow_up.h"
#include "foreseen_words.h"
#include "info/version.h"
#include "input_rules.h"
#include "interruption.h"
#include "json_text.h"
#include "result.h"

namespace app {
namespace {

using info::discover::Finding;

std::string observedIn(const SimulationOptions& simulation) {
  if (simulation.coordinates.size() != 1) {
    throw std::invalid_argument(fmt::format("--coordinate: {} are free; discover observes one",
                                            simulation.coordinates.size()));
  }
  return simulation.coordinates.front();
}

DiscoverWording wordingOf(const bio::discover::ElbowDisagreement& data) {
  const bio::Coordinate& coordinate = data.widest().coordinate();
  const bool isAngle = coordinate.isRotation;
  DiscoverWording wording;
  wording.outputs = {{coordinate.name, isAngle ? "deg" : "m", 1}};
  wording.unit = isAngle ? radian : 1;
  wording.gapEnd = isAngle ? "_deg" : "_m";
  wording.force = isAngle ? "Torque [N·m]" : "Force [N]";
  wording.forceUnit = "N·m";
  wording.ofForce = "part of the muscles' moments";
  wording.push = "a push";
  wording.inputs = "muscles";
  wording.input = "muscle";
  wording.commands = "excitations";
  wording.present = data.widest().present();
  return wording;
}

bool concernsTrials(const bio::discover::Augmented& added) {
  const bio::EmgMapping& m = added.mapping;
  const bio::discover::SensorLaw& s = added.sensor;
  return !added.muscles.empty() || !m.gain.empty() || m.delay != 0 || m.nonlinearity != 0 ||
         !m.offset.empty() || !m.crosstalk.empty() || m.fatigue != 0 || s.bias != 0 ||
         s.gain != 0 || s.clock != 0;
}

/// What is missing has no name, but a formula that explains it.
bool isFormula(const info::discover::Verdict& verdict) {
  return verdict.finding == info::discover::Finding::unknown && verdict.formula &&
         verdict.formula->wins;
}

/// The effects that were found, or the formula in their place.
std::vector<bio::discover::EffectToAdd> effectsToAdd(const bio::discover::ElbowDisagreement& data,
                                                     const info::discover::Verdict& verdict) {
  if (isFormula(verdict)) {
    const info::discover::RacedFormula& found = *verdict.formula;
    const auto n = static_cast<Eigen::Index>(found.values.size());
    return {{"formula", Eigen::VectorXd::Map(found.values.data(), n),
             Eigen::VectorXd::Map(found.deviations.data(), n), found.logBayesFactor, 0}};
  }
  std::vector<bio::discover::EffectToAdd> effects;
  for (const auto& found : verdict.effects) {
    const auto& candidate = data.candidates()[found.candidate];
    bio::discover::EffectToAdd effect;
    effect.id = candidate.id;
    const auto n = static_cast<Eigen::Index>(found.estimates.size());
    effect.values.resize(n);
    effect.deviations.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      effect.values[i] = found.estimates[static_cast<std::size_t>(i)].value;
      effect.deviations[i] = found.estimates[static_cast<std::size_t>(i)].deviation;
    }
    effect.logBayesFactor = found.logBayesFactor;
    effect.probability = verdict.vetoed ? 0 : found.probability;
    effects.push_back(std::move(effect));
  }
  return effects;
}

/// Writes the model with the effects, and the trials where EMG or sensor were at fault or a muscle
/// was switched on.
void addTo(const std::string& modelFile, const bio::Model& model, const bio::ArmOptions& arm,
           const std::string& coordinate, const std::vector<bio::Trial>& trials,
           const bio::discover::ElbowDisagreement& data, const info::discover::Verdict& verdict,
           const Summary& summary, OutputFolder& folder) {
  bio::discover::EffectProvenance provenance{"fisherhill " + std::string(info::version()), {}};
  for (const Summary::InputFile& input : summary.inputs()) {
    provenance.data.push_back(fmt::format("{} SHA-256 {}", input.path, input.sha256));
  }
  const bio::discover::Augmented added = bio::discover::addEffects(
      model, arm, coordinate, effectsToAdd(data, verdict), provenance,
      isFormula(verdict) ? verdict.formula->terms : std::vector<info::discover::FormulaTerm>{});
  folder.writeFile("with_effect.osim", [&](const std::filesystem::path& path) {
    bio::rewriteOsim(modelFile, added.model, path);
  });
  if (!concernsTrials(added)) return;
  const bio::Arm repaired(added.model, arm);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    folder.writeFile(drivenName(i), [&](const std::filesystem::path& path) {
      const bio::Trial driving = bio::discover::withProxies(trials[i], data.widest());
      bio::writeTable(drivenTable(bio::discover::asTrueSensor(driving, coordinate, added.sensor),
                                  repaired, added.mapping),
                      path);
    });
  }
}

}  // namespace

ArmDiscovery discoverInArm(const ArmDiscoveryRequest& request, const CommandContext& context) {
  std::vector<std::string> files = request.trials;
  files.insert(files.end(), request.heldOut.begin(), request.heldOut.end());
  std::vector<std::string> names = {"verdict.json", "with_effect.osim"};
  for (std::size_t i = 0; i < files.size(); ++i) names.push_back(drivenName(i));
  OutputFolder folder(context, names);
  Summary summary(context);
  const bio::Model model = readModel(request.model, summary);
  std::vector<bio::Trial> trials;
  for (const std::string& file : files) {
    summary.addInput(file);
    trials.push_back(readTrialFile(file, model, request.simulation, true));
    for (const std::string& warning : trials.back().warnings) summary.warn(warning);
  }
  inputsMustDiffer(summary, request.trials.size());
  resultsMustNotBeInputs(summary, folder, names);
  const bio::ArmOptions arm = armOptions(request.simulation);
  const std::string coordinate = observedIn(request.simulation);
  const bio::Arm asked(model, arm);
  for (const std::string& warning : asked.warnings()) summary.warn(warning);
  std::unique_ptr<bio::discover::ElbowDisagreement> elbow;
  bio::discover::ElbowOptions options;
  const auto attempt = [&](double step) {
    options.simulation = simulationOptions(request.simulation, 0, 1);
    options.simulation.step = step;
    options.without = request.without;
    elbow =
        std::make_unique<bio::discover::ElbowDisagreement>(model, arm, coordinate, trials, options);
    info::discover::Attempt one{
        *elbow, engineOptions(request.maxEffects, request.inputScatter, request.trials.size(),
                              request.heldOut.size())};
    const bool isAngle = elbow->widest().coordinate().isRotation;
    if (request.noise)
      one.options.outputDeviation = isAngle ? *request.noise / radian : *request.noise;
    return one;
  };
  const DiscoverSearch found = searchForEffects(
      attempt, request.simulation.stepOrDefault(),
      request.simulation.step ? HUGE_VAL : bio::discover::shortestSearchStep, context.quiet);
  const bio::discover::ElbowDisagreement& data = *elbow;
  const info::discover::Verdict& verdict = found.verdict;
  const DiscoverWording wording = wordingOf(data);
  warnOfOneTrial(summary, request.trials.size(), request.heldOut.size());
  const std::vector<bio::discover::ForeseenExperiment> foreseen =
      bio::discover::foresee(model, arm, trials.front(), options, data, verdict);
  std::string next = foreseenSentence(foreseen, data, verdict, found.options.evidence);
  if (next.empty()) next = followUp(data, verdict, followUpsOfArms());
  const DiscoverFindings findings{
      request.model, files, data,     wording,           found.options,
      verdict,       next,  foreseen, found.wallSeconds, found.processorSeconds};
  summary.setSimulation(request.simulation.integrator, found.step, longestDuration(trials),
                        found.wallSeconds);
  tellFindings(findings, summary);
  const nlohmann::ordered_json json = verdictJson(findings);
  folder.write("verdict.json", [&](std::ostream& out) { out << jsonText(json, 2) << '\n'; });
  if (mayBeAdded(verdict) || isFormula(verdict))
    addTo(request.model, model, arm, coordinate, trials, data, verdict, summary, folder);
  deliver(context, summary, discoverReport(findings), folder);
  if (found.interrupted) throw Interrupted{};
  return {verdict.finding == Finding::numerical ? ExitStatus::answerIsNo : ExitStatus::done, json};
}

}  // namespace app
