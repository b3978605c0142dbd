#include "discover/model_discovery.h"

#include <fmt/format.h>

#include "bio/discovery/workflow.h"
#include "discover/discover_results.h"
#include "discover/discover_search.h"
#include "discover/proposed_experiments_text.h"
#include "discover/suggested_experiments.h"
#include "discover/written_discovery.h"
#include "info/version.h"
#include "options/input_rules.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/angle_unit.h"
#include "output/result.h"

namespace app {
namespace {

DiscoverWording wordingOf(const bio::discover::MusculoskeletalProblem& data) {
  const bio::Coordinate& coordinate = data.encompassing().coordinate();
  const bool isAngle = coordinate.isRotation;
  DiscoverWording wording;
  wording.outputs = {{coordinate.name, isAngle ? "deg" : "m"}};
  wording.unit = isAngle ? radian : 1;
  wording.gapEnd = isAngle ? "_deg" : "_m";
  wording.force = isAngle ? "Torque [N·m]" : "Force [N]";
  wording.forceUnit = "N·m";
  wording.ofForce = "fraction of the muscles' moments";
  wording.push = "a push";
  wording.inputs = "muscles";
  wording.input = "muscle";
  wording.commands = "excitations";
  wording.present = data.encompassing().present();
  return wording;
}

bio::discover::EffectProvenance provenanceOf(const Summary& summary) {
  bio::discover::EffectProvenance provenance;
  provenance.tool = "fisherhill " + std::string(info::version());
  for (const Summary::InputFile& input : summary.inputs())
    provenance.data.push_back(fmt::format("{} SHA-256 {}", input.path, input.sha256));
  return provenance;
}

}  // namespace

std::string observedCoordinate(const SimulationOptions& simulation) {
  if (simulation.coordinates.size() != 1) {
    throw std::invalid_argument(
        fmt::format("--coordinate: {} coordinates are free, must be one for discover",
                    simulation.coordinates.size()));
  }
  return simulation.coordinates.front();
}

ModelDiscovery discoverInModel(ModelDiscoveryRequest request, const CommandContext& context) {
  std::vector<std::string> files = request.trials;
  files.insert(files.end(), request.heldOut.begin(), request.heldOut.end());
  const std::vector<std::string> names =
      namesOfDiscovery(request.trials.size(), request.heldOut.size());
  OutputFolder folder(context, names);
  Summary summary(context);
  const bio::Model model = readModel(request.model, summary);
  chooseCoordinates(request.simulation, model, request.trials);
  std::vector<bio::Trial> trials;
  for (const std::string& file : files) {
    summary.addInput(file);
    trials.push_back(
        readTrialFile(file, model, request.simulation, {.experimentalConditions = true}));
    for (const std::string& warning : trials.back().warnings) summary.warn(warning);
  }
  inputsMustDiffer(summary, request.trials.size());
  resultsMustNotBeInputs(summary, folder, names);
  const std::string coordinate = observedCoordinate(request.simulation);
  const bio::SystemOptions arm = armOptions(request.simulation);
  const bio::MusculoskeletalSystem compiled(model, arm);
  for (const std::string& warning : compiled.warnings()) summary.warn(warning);
  const bool isAngle = bio::findCoordinate(model, coordinate).isRotation;
  bio::discover::DiscoveryRequest asked{
      model, arm, coordinate, trials, request.heldOut.size(), request.simulation.step, {}, {}, {}};
  asked.problem.simulation = simulationOptions(request.simulation, 0, 1);
  asked.problem.without = request.without;
  asked.search = engineOptions(request.maxEffects, request.inputScatter);
  if (request.noise) asked.search.outputSd = isAngle ? *request.noise / radian : *request.noise;
  asked.provenance = provenanceOf(summary);
  WatchedSearch watch(context.quiet);
  asked.search.progress = watch.progress();
  bio::discover::DiscoveryResult result = bio::discover::discover(asked);
  watch.end();
  const WrittenDiscovery written = writeDiscovery({request, files, result}, summary, folder);
  const bio::discover::MusculoskeletalProblem& data = *result.data;
  const info::discover::SteppedVerdict& found = result.found;
  const info::discover::Verdict& verdict = found.verdict;
  const DiscoverWording wording = wordingOf(data);
  warnOfOneTrial(summary, request.trials.size(), request.heldOut.size());
  std::string next =
      predictedExperimentSentence(result.experiments, data, verdict, found.options.evidence);
  if (next.empty()) {
    next = followUp(data, verdict, followUpsOfModels(data.encompassing()));
  }
  const DiscoverFindings findings{request.model,
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
                                  found.step};
  summary.setSimulation(request.simulation.integrator, found.step, longestDuration(trials),
                        found.wallSeconds);
  const nlohmann::ordered_json json = writeFindings(findings, summary, folder);
  return {deliverFindings(findings, watch, context, summary, folder), json};
}

}  // namespace app
