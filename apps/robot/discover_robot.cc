#include "robot_options/discover_robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "bio/model/units.h"
#include "discover/discover_results.h"
#include "discover/discover_search.h"
#include "discover/suggested_experiments.h"
#include "info/version.h"
#include "options/input_rules.h"
#include "options/number_rules.h"
#include "output/json_text.h"
#include "output/text.h"
#include "report/result.h"
#include "robot/robot_trial.h"
#include "robots/robot_discovery.h"

namespace app {
namespace {

using info::robot::RobotProblem;
using nlohmann::ordered_json;

/// Builds the effects of a with_effect.json into the model; returns those that are no candidates
/// any more.
std::vector<std::string> buildInFile(const std::string& file, info::robot::Model& model) {
  std::ifstream stream(file);
  try {
    const ordered_json json = ordered_json::parse(stream);
    if (json.at("system") != model.name)
      throw std::invalid_argument(fmt::format("system is {}, must be {}",
                                              json.at("system").get<std::string>(), model.name));
    std::vector<info::robot::KnownEffect> effects;
    for (const auto& effect : json.at("effects")) {
      info::robot::KnownEffect& known = effects.emplace_back();
      known.id = effect.at("id");
      for (const auto& [name, parameter] : effect.at("parameters").items())
        known.values[name] = parameter.at("value");
    }
    return info::robot::buildIn(effects, model);
  } catch (const std::exception& error) {
    throw std::invalid_argument(fmt::format("{}: {}", file, error.what()));
  }
}

DiscoverWording wordingOf(const RobotProblem& data) {
  DiscoverWording wording;
  bool angles = true;
  for (std::size_t c = 0; c < data.model().channels.size(); ++c) {
    const auto& channel = data.model().channels[c];
    const bool isAngle = channel.unit == "rad";
    angles = angles && isAngle;
    wording.outputs.push_back(
        {channel.name, isAngle ? "deg" : channel.unit, isAngle ? bio::degreesPerRadian : 1});
  }
  const ShownOutput first = wording.outputs.front();
  wording.axes = {
      {first.name, first.unit, first.scale, "angle", "Acceleration of the cart [m/s²]", "m/s²"}};
  wording.unit = angles ? bio::degreesPerRadian : 1;
  wording.errorUnit = first.unit;
  wording.errorEnd = angles ? "_deg" : "_N";
  wording.ofForce = "an acceleration of the cart [m/s²]";
  wording.push = "an extra acceleration of the cart";
  wording.inputs = "inputs";
  wording.input = "input";
  wording.commands = "commands";
  wording.hasMap = angles;
  return wording;
}

const FollowUps& followUpsOfRobots() {
  static const FollowUps known{
      {
          {{"gain", "mass", "bias"},
           "Let the robot hang at rest, once unchanged and once with a known mass or angle added: "
           "this shows the sensor's gain and bias without any motion."},
          {{"visc", "coulomb", "stribeck", "drag", "damping"},
           "Let it swing freely from a large angle until it rests: under dry friction the "
           "amplitude falls linearly, under viscous friction exponentially, under drag fastest at "
           "the start."},
          {{"lag", "clock"},
           "Hold the cart and push the links by hand: a clock offset shifts the sensors' readings, "
           "a lag of the cart does not."},
          {{"tilt", "bias"},
           "Turn the robot by 180° about the vertical: the effect of a tilt changes its sign, a "
           "bias stays."},
      },
      "Repeat a trial with a faster and wider motion of the cart; `fisherhill robot` finds one "
      "that distinguishes the parameters.",
      "Hold the cart still and let the robot swing: this shows the missing effect without the "
      "drive.",
      "Record one more trial and test it with --with with_effect.json."};
  return known;
}

class RobotSearch {
 public:
  RobotSearch(const RobotRequest& request, const CommandContext& context)
      : request_(request), context_(context) {}

  ExitStatus run() {
    std::vector<std::string> files = request_.trials;
    files.insert(files.end(), request_.heldOut.begin(), request_.heldOut.end());
    const std::vector<std::string> names = {"verdict.json", "parameters.csv", "with_effect.json"};
    OutputFolder folder(context_, names);
    Summary summary(context_);
    std::vector<info::robot::Trial> trials;
    const std::vector<info::robot::Channel> channels = info::robot::channelsOf(request_.system);
    for (const std::string& file : files) {
      summary.addInput(file);
      std::vector<std::string> warnings;
      trials.push_back(readRobotTrial(file, channels, request_.ignoreExtra, warnings));
      for (const std::string& warning : warnings) summary.warn(warning);
      const double duration = trials.back().times.back() - trials.back().times.front();
      if (request_.step && *request_.step > duration) {
        throw std::invalid_argument(fmt::format("{}: lasts {} s, --step {} s must not be longer",
                                                file, numberText(duration),
                                                numberText(*request_.step)));
      }
    }
    inputsMustDiffer(summary, request_.trials.size(), 0);
    info::robot::DiscoveryRequest asked;
    asked.model = info::robot::modelFor(request_.system, trials);
    std::map<std::string, std::string> present;
    if (!request_.with.empty()) {
      for (const std::string& id : buildInFile(request_.with, asked.model))
        present[id] = request_.with;
      summary.addInput(request_.with);
    }
    resultsMustNotBeInputs(summary, folder, names);
    asked.trials = trials;
    asked.numHeldOut = request_.heldOut.size();
    asked.step = request_.step;
    asked.problem = problemOptions(channels);
    asked.search = engineOptions(request_.maxEffects, request_.inputScatter);
    WatchedSearch watch(context_.quiet, request_.timeLimit);
    watch.watch(asked.search);
    const info::robot::DiscoveryResult result = info::robot::discover(asked);
    const info::discover::SteppedVerdict& found = result.found;
    const RobotProblem& data = *result.data;
    watch.end();
    const info::discover::Verdict& verdict = found.verdict;
    warnOfOneTrial(summary, request_.trials.size(), request_.heldOut.size());
    DiscoverWording wording = wordingOf(data);
    wording.present = present;
    const std::string next = followUp(data, verdict, followUpsOfRobots());
    const std::vector<bio::discover::PredictedExperiment> predictedExperiments;  // of arms only
    const std::string name = "the " + request_.system;
    const DiscoverFindings findings{name,
                                    files,
                                    data,
                                    wording,
                                    found.options,
                                    verdict,
                                    next,
                                    predictedExperiments,
                                    found.wallSeconds,
                                    found.processorSeconds,
                                    result.fitted,
                                    nullptr,
                                    found.step};
    summary.set("system", request_.system);
    double longest = 0;
    for (const info::robot::Trial& trial : trials) {
      longest = std::max(longest, trial.times.back() - trial.times.front());
    }
    summary.set("step_s", found.step);
    summary.set("duration_s", longest);
    summary.set("wall_s", found.wallSeconds);
    for (std::size_t c = 0; c < channels.size(); ++c)
      summary.set(fmt::format("noise_{}_{}", channels[c].name, wording.outputs[c].unit),
                  wording.unit * data.sds()[c]);
    writeFindings(findings, summary, folder);
    if (info::discover::mayBeAdded(verdict))
      folder.write("with_effect.json", [&](std::ostream& out) {
        out << jsonText(repaired(findings, summary), 2) << '\n';
      });
    return deliverFindings(findings, watch, context_, summary, folder);
  }

 private:
  /// Options of the robot's problem, at its first time step.
  info::robot::DisagreementOptions problemOptions(
      const std::vector<info::robot::Channel>& channels) const {
    info::robot::DisagreementOptions asked;
    asked.without = request_.without;
    for (std::size_t c = 0; c < request_.noise.size(); ++c) {
      const bool isAngle = c < channels.size() && channels[c].unit == "rad";
      asked.sds.push_back(isAngle ? request_.noise[c] * bio::radiansPerDegree : request_.noise[c]);
    }
    return asked;
  }

  /// The effects, and where they come from.
  static ordered_json repaired(const DiscoverFindings& f, const Summary& summary) {
    const auto& data = dynamic_cast<const RobotProblem&>(f.data);
    ordered_json json;
    json["system"] = data.model().name;
    json["effects"] = verdictJson(f)["effects"];
    json["tool"] = "fisherhill " + std::string(info::version());
    json["data"] = ordered_json::array();
    for (const Summary::InputFile& input : summary.inputs())
      json["data"].push_back({{"file", input.path}, {"sha256", input.sha256}});
    return json;
  }

  const RobotRequest& request_;
  const CommandContext& context_;
};

}  // namespace

ExitStatus discoverInRobot(const RobotRequest& request, const CommandContext& context) {
  return RobotSearch(request, context).run();
}

}  // namespace app
