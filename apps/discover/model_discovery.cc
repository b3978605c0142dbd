#include "discover/model_discovery.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>

#include "bio/discovery/workflow.h"
#include "bio/model/units.h"
#include "discover/discover_results.h"
#include "discover/discover_search.h"
#include "discover/proposed_experiments_text.h"
#include "discover/suggested_experiments.h"
#include "discover/written_discovery.h"
#include "info/version.h"
#include "options/excitation_figure.h"
#include "options/input_rules.h"
#include "options/model_methods.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "report/result.h"

namespace app {
namespace {

ShownOutput shownOf(const bio::Observable& what, const bio::Model& model) {
  const std::string unit = bio::unitOf(what, model);
  if (unit == "rad") return {bio::nameOf(what), "deg", bio::degreesPerRadian};
  return {bio::nameOf(what), unit, 1};
}

/// "_Nm" of "N·m", "_rad_per_s" of "rad/s", "" of a pure number.
std::string endOf(const std::string& unit) {
  std::string end = unit.empty() ? "" : "_" + unit;
  if (const auto at = end.find("·"); at != std::string::npos) end.erase(at, std::strlen("·"));
  if (const auto at = end.find('/'); at != std::string::npos) end.replace(at, 1, "_per_");
  return end;
}

DiscoverWording wordingOf(const bio::discover::MusculoskeletalProblem& data,
                          const info::discover::Verdict& verdict) {
  const bio::discover::EncompassingModel& model = data.encompassing();
  DiscoverWording wording;
  for (const bio::Observable& what : model.sensors())
    wording.outputs.push_back(shownOf(what, model.base()));
  for (const bio::discover::MovingCoordinate& at : model.coordinates()) {
    wording.axes.push_back(
        at.coordinate.isRotation
            ? ShownAxis{at.coordinate.name, "deg", bio::degreesPerRadian, "angle", "Torque [N·m]",
                        "N·m"}
            : ShownAxis{at.coordinate.name, "m", 1, "position", "Force [N]", "N"});
    wording.axes.back().isTorque = at.coordinate.isRotation;
    wording.axes.back().place = static_cast<std::size_t>(at.index);
  }
  const ShownOutput& first = wording.outputs.front();
  const bool isOne = wording.outputs.size() == 1;
  wording.unit = isOne ? first.scale : 1 / verdict.sds.sd(0);
  wording.errorUnit = isOne ? first.unit : "sd";
  wording.errorEnd = isOne ? endOf(first.unit) : "_sd";
  wording.ofForce = "fraction of the muscles' moments";
  wording.push = "a push";
  wording.inputs = "muscles";
  wording.input = "muscle";
  wording.commands = "excitations";
  wording.present = model.present();
  for (const bio::discover::TimedForce& force : model.timedForces())
    wording.times[force.time] = force.ends ? "ends_at_s" : "starts_at_s";
  return wording;
}

/// NAME=VALUE of --noise, in the unit in which the output is shown.
std::map<std::string, double> noiseByName(const std::vector<std::string>& texts) {
  std::map<std::string, double> noise;
  for (const std::string& text : texts) {
    const auto at = text.rfind('=');
    if (at == std::string::npos || at == 0)
      throw std::invalid_argument(
          fmt::format("--noise: '{}' must be NAME=VALUE, NAME a measured column", text));
    const std::string name = text.substr(0, at);
    double value = 0;
    try {
      value = parseNumber(text.substr(at + 1));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("--noise: {}: {}", name, error.what()));
    }
    if (!(value > 0))
      throw std::invalid_argument(fmt::format("--noise: {} = {}, must be > 0", name, value));
    if (!noise.emplace(name, value).second)
      throw std::invalid_argument(fmt::format("--noise: '{}' is given twice", name));
  }
  return noise;
}

/// The noise of every output, if the command line gives it.
std::optional<info::discover::Whitening> noiseOf(const ModelDiscoveryRequest& request,
                                                 const std::vector<ShownOutput>& outputs) {
  std::map<std::string, double> byName = noiseByName(request.outputNoise);
  if (!request.noise && byName.empty()) return {};
  const bool isPosition = outputs.size() == 1 && outputs.front().unit == "m";
  Eigen::VectorXd sds = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(outputs.size()));
  std::vector<std::string> names, open;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const ShownOutput& output = outputs[o];
    names.push_back(output.name);
    double& sd = sds[static_cast<Eigen::Index>(o)];
    if (const auto own = byName.find(output.name); own != byName.end()) {
      sd = own->second / output.scale;
      byName.erase(own);
    } else if (request.noise && (output.unit == "deg" || isPosition)) {
      sd = *request.noise / output.scale;
    } else {
      open.push_back(output.name);
    }
  }
  if (!byName.empty())
    throw std::invalid_argument(
        fmt::format("--noise: '{}' is not measured and in question; what is: {}",
                    byName.begin()->first, fmt::join(names, ", ")));
  if (!open.empty())
    throw std::invalid_argument(fmt::format(
        "the noise of {} is not given (--noise {}=SD): must be given for all that is measured, or "
        "for nothing",
        fmt::join(open, ", "), open.front()));
  return info::discover::Whitening(std::move(sds));
}

bio::discover::EffectProvenance provenanceOf(const Summary& summary) {
  bio::discover::EffectProvenance provenance;
  provenance.tool = "fisherhill " + std::string(info::version());
  for (const Summary::InputFile& input : summary.inputs())
    provenance.data.push_back(fmt::format("{} SHA-256 {}", input.path, input.sha256));
  return provenance;
}

}  // namespace

std::vector<std::string> coordinatesInQuestion(const SimulationOptions& simulation,
                                               const std::vector<bio::Trial>& trials) {
  std::vector<std::string> held = simulation.prescribed;
  held.insert(held.end(), simulation.prescribedByModel.begin(), simulation.prescribedByModel.end());
  for (const auto& [name, value] : simulation.held) held.push_back(name);
  std::vector<std::string> names =
      bio::discover::coordinatesInQuestion(simulation.coordinates, held, trials);
  if (names.empty())
    throw std::invalid_argument(fmt::format(
        "no coordinate is free, and no trial measures the moment of one that is prescribed or "
        "locked{}: discover needs either",
        held.empty() ? "" : fmt::format(" (a column {}.moment)", held.front())));
  return names;
}

ModelDiscovery discoverInModel(ModelDiscoveryRequest request, const CommandContext& context) {
  std::vector<std::string> files = request.trials;
  files.insert(files.end(), request.heldOut.begin(), request.heldOut.end());
  const std::vector<std::string> names =
      namesOfDiscovery(request.trials.size(), request.heldOut.size());
  OutputFolder folder(context, names);
  Summary summary(context);
  bio::Model model = readModel(request.model, summary);
  chooseCoordinates(request.simulation, model, request.trials);
  model = withSetParameters(std::move(model), request.simulation, summary);
  std::vector<bio::Trial> trials;
  for (const std::string& file : files) {
    summary.addInput(file);
    trials.push_back(readTrialFile(file, model, request.simulation,
                                   {.experimentalConditions = true, .channels = true}));
    for (const std::string& warning : trials.back().warnings) summary.warn(warning);
  }
  inputsMustDiffer(summary, request.trials.size());
  resultsMustNotBeInputs(summary, folder, names);
  const std::vector<std::string> coordinates = coordinatesInQuestion(request.simulation, trials);
  const bio::SystemOptions system = systemOptions(request.simulation);
  const bio::MusculoskeletalSystem compiled(model, system);
  for (const std::string& warning : compiled.warnings()) summary.warn(warning);
  for (const std::string& file : request.effects) summary.addInput(file);
  bio::discover::DiscoveryRequest asked{
      model, system, coordinates, trials, request.heldOut.size(), request.simulation.step,
      {},    {},     {}};
  asked.problem.simulation = simulationOptions(request.simulation, 0, 1);
  asked.problem.initial = byName(request.simulation.initial);
  asked.problem.without = request.without;
  asked.problem.own = bio::discover::readUserEffects(request.effects);
  asked.search = engineOptions(request.maxEffects, request.inputScatter);
  asked.problem.sensors = bio::discover::measuredOutputs(trials, system, coordinates);
  std::vector<ShownOutput> outputs;
  for (const bio::Observable& what : asked.problem.sensors) outputs.push_back(shownOf(what, model));
  asked.search.sds = noiseOf(request, outputs);
  asked.provenance = provenanceOf(summary);
  WatchedSearch watch(context.quiet, request.timeLimit);
  watch.watch(asked.search);
  bio::discover::DiscoveryResult result = bio::discover::discover(asked);
  watch.end();
  const bio::discover::MusculoskeletalProblem& data = *result.data;
  const DiscoverWording wording = wordingOf(data, result.found.verdict);
  const DiscoveryToWrite toWrite{request, files, wording, result};
  const WrittenDiscovery written = writeDiscovery(toWrite, summary, folder);
  const info::discover::SteppedVerdict& found = result.found;
  const info::discover::Verdict& verdict = found.verdict;
  warnOfOneTrial(summary, request.trials.size(), request.heldOut.size());
  std::string next =
      predictedExperimentSentence(result.experiments, data, verdict, found.options.evidence);
  if (next.empty()) {
    next = followUp(data, verdict, followUpsOfModels(data.encompassing()));
  }
  const DiscoverFindings findings{
      request.model,
      files,
      data,
      wording,
      found.options,
      verdict,
      next,
      result.experiments,
      found.wallSeconds,
      found.processorSeconds,
      result.fitted,
      &written,
      found.step,
      excitationFigures(trials.front(),
                        request.heldOut.empty() ? nullptr : &trials[request.trials.size()],
                        compiled),
      request.plays && folder.active() ? discoverPlayback(toWrite, written, model) : std::nullopt};
  summary.setSimulation(request.simulation.integrator, found.step, longestDuration(trials),
                        found.wallSeconds);
  sayModel(model, compiled, summary.methods());
  sayExcitations(compiled, summary.methods());
  sayDiscovery(findings, summary.methods());
  const nlohmann::ordered_json json = writeFindings(findings, summary, folder);
  return {deliverFindings(findings, watch, context, summary, folder), json};
}

}  // namespace app
