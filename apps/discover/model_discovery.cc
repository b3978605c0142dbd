#include "discover/model_discovery.h"

#include <fmt/format.h>

#include <cmath>

#include "bio/discovery/musculoskeletal_problem.h"
#include "calibrate/fitted_table.h"
#include "discover/discover_report.h"
#include "discover/discover_search.h"
#include "discover/proposed_experiments_text.h"
#include "discover/suggested_experiments.h"
#include "discover/written_discovery.h"
#include "options/input_rules.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/angle_unit.h"
#include "output/interruption.h"
#include "output/json_text.h"
#include "output/result.h"

namespace app {
namespace {

using info::discover::Finding;

DiscoverWording wordingOf(const bio::discover::MusculoskeletalProblem& data) {
  const bio::Coordinate& coordinate = data.encompassing().coordinate();
  const bool isAngle = coordinate.isRotation;
  DiscoverWording wording;
  wording.outputs = {{coordinate.name, isAngle ? "deg" : "m", 1}};
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

}  // namespace

std::string observedCoordinate(const SimulationOptions& simulation) {
  if (simulation.coordinates.size() != 1) {
    throw std::invalid_argument(
        fmt::format("--coordinate: {} coordinates are free, must be one for discover",
                    simulation.coordinates.size()));
  }
  return simulation.coordinates.front();
}

ModelDiscovery discoverInModel(const ModelDiscoveryRequest& request,
                               const CommandContext& context) {
  std::vector<std::string> files = request.trials;
  files.insert(files.end(), request.heldOut.begin(), request.heldOut.end());
  const std::vector<std::string> names =
      namesOfDiscovery(request.trials.size(), request.heldOut.size());
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
  const bio::SystemOptions arm = armOptions(request.simulation);
  const std::string coordinate = observedCoordinate(request.simulation);
  const bio::MusculoskeletalSystem asked(model, arm);
  for (const std::string& warning : asked.warnings()) summary.warn(warning);
  std::unique_ptr<bio::discover::MusculoskeletalProblem> elbow;
  bio::discover::MusculoskeletalProblemOptions options;
  const auto attempt = [&](double step) {
    options.simulation = simulationOptions(request.simulation, 0, 1);
    options.simulation.step = step;
    options.without = request.without;
    elbow = std::make_unique<bio::discover::MusculoskeletalProblem>(model, arm, coordinate, trials,
                                                                    options);
    info::discover::Attempt one{
        *elbow, engineOptions(request.maxEffects, request.inputScatter, request.trials.size(),
                              request.heldOut.size())};
    const bool isAngle = elbow->encompassing().coordinate().isRotation;
    if (request.noise) one.options.outputSd = isAngle ? *request.noise / radian : *request.noise;
    return one;
  };
  DiscoverSearch found = searchForEffects(
      attempt, request.simulation.stepOrDefault(),
      request.simulation.step ? HUGE_VAL : bio::discover::shortestSearchStep, context.quiet);
  const bio::discover::MusculoskeletalProblem& data = *elbow;
  const WrittenDiscovery written =
      writeDiscovery({request, files, data, found.verdict, found.options.heldOut}, summary, folder);
  if (written.repaired) bio::discover::takeReplays(found.verdict, *written.repaired);
  const info::discover::Verdict& verdict = found.verdict;
  const std::vector<info::discover::FittedNumber> fitted =
      bio::discover::fittedNumbers(data, verdict);
  const DiscoverWording wording = wordingOf(data);
  warnOfOneTrial(summary, request.trials.size(), request.heldOut.size());
  const std::vector<bio::discover::PredictedExperiment> predictedExperiments =
      bio::discover::predictExperiments(model, arm, trials.front(), options, data, verdict);
  std::string next =
      predictedExperimentSentence(predictedExperiments, data, verdict, found.options.evidence);
  if (next.empty()) {
    const bool isAngle = data.encompassing().coordinate().isRotation;
    next =
        followUp(data, verdict, followUpsOfModels(coordinate + (isAngle ? ".torque" : ".force")));
  }
  const DiscoverFindings findings{request.model,
                                  files,
                                  data,
                                  wording,
                                  found.options,
                                  verdict,
                                  next,
                                  predictedExperiments,
                                  found.wallSeconds,
                                  found.processorSeconds,
                                  fitted,
                                  &written,
                                  found.step};
  summary.setSimulation(request.simulation.integrator, found.step, longestDuration(trials),
                        found.wallSeconds);
  tellFindings(findings, summary);
  const nlohmann::ordered_json json = verdictJson(findings);
  folder.write("verdict.json", [&](std::ostream& out) { out << jsonText(json, 2) << '\n'; });
  if (!fitted.empty())
    folder.write("parameters.csv", [&](std::ostream& out) { writeFitted(fitted, out); });
  deliver(context, summary, discoverReport(findings), folder);
  if (found.interrupted) throw Interrupted{};
  return {verdict.finding == Finding::numerical ? ExitStatus::answerIsNo : ExitStatus::done, json};
}

}  // namespace app
