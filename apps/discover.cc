#include "discover.h"

#include <fmt/format.h>

#include <cmath>

#include "angle_unit.h"
#include "arm_input.h"
#include "arm_options.h"
#include "bio/discover/add_effects.h"
#include "bio/discover/elbow_disagreement.h"
#include "bio/osim_file.h"
#include "discover_report.h"
#include "discover_robot.h"
#include "discover_search.h"
#include "driven_trial.h"
#include "follow_up.h"
#include "foresee.h"
#include "info/version.h"
#include "input_rules.h"
#include "interruption.h"
#include "json_text.h"
#include "result.h"

namespace app {
namespace {

using info::discover::Finding;

class Discover : public Command {
 public:
  About about() const override {
    return {"discover", "Find, name and add the effect that a model lacks",
            "fisherhill discover models/elbow8.osim emg_data/hidden_a/train_1.sto "
            "emg_data/hidden_a/train_2.sto --hold-out emg_data/hidden_a/held_out.sto --out "
            "out/discover"};
  }

  void addOptions(CLI::App& options) override {
    addModelArgument(options, model_);
    options
        .add_option("TRIAL", trials_,
                    "trials with a measured angle; with --system there is no MODEL")
        ->check(CLI::ExistingFile)
        ->type_name("");
    addRobotOptions(options, robot_);
    options.add_option("--hold-out", heldOut_, "trial to judge by only; may be repeated")
        ->check(CLI::ExistingFile)
        ->allow_extra_args(false)
        ->delimiter(',')
        ->type_name("TRIAL");
    options
        .add_option("--noise-deg", noise_,
                    "standard deviation of the measured angle; default: from the data themselves")
        ->check(CLI::PositiveNumber)
        ->type_name("DEG");
    options.add_option("--without", without_, "effects to leave out of the catalogue, by id")
        ->allow_extra_args(false)
        ->delimiter(',')
        ->type_name("IDS");
    options.add_option("--max-effects", maxEffects_, "effects that may act together")
        ->check(CLI::Range(1, 3))
        ->capture_default_str()
        ->type_name("N");
    const std::size_t common = options.get_options().size();
    addSimulationOptions(options, simulation_);
    const auto all = options.get_options();
    for (std::size_t i = common; i < all.size(); ++i) {
      const std::string name = all[i]->get_name();
      if (name != "--step" && name != "--ignore-extra") armOptions_.push_back(all[i]);
    }
  }

  ExitStatus run(const CommandContext& context) override {
    if (!robot_.system.empty()) {
      robot_.trials = trials_;
      robot_.trials.insert(robot_.trials.begin(), model_);
      robot_.heldOut = heldOut_;
      robot_.without = without_;
      robot_.maxEffects = maxEffects_;
      robot_.ignoreExtra = simulation_.ignoreExtra;
      robot_.step = simulation_.step;
      mustSuitRobots();
      return discoverInRobot(robot_, context);
    }
    if (trials_.empty()) throw std::invalid_argument("TRIAL is required (see --help)");
    if (!robot_.with.empty()) throw std::invalid_argument("--with goes with --system");
    if (!robot_.noise.empty()) throw std::invalid_argument("--noise goes with --system");
    std::vector<std::string> files = trials_;
    files.insert(files.end(), heldOut_.begin(), heldOut_.end());
    std::vector<std::string> names = {"verdict.json", "with_effect.osim"};
    for (std::size_t i = 0; i < files.size(); ++i) names.push_back(drivenName(i));
    OutputFolder folder(context, names);
    Summary summary(context);
    const bio::Model model = readModel(model_, summary);
    std::vector<bio::Trial> trials;
    for (const std::string& file : files) {
      summary.addInput(file);
      trials.push_back(bio::readTrial(file, model, {simulation_.ignoreExtra}));
      for (const std::string& warning : trials.back().warnings) summary.warn(warning);
    }
    inputsMustDiffer(summary, trials_.size());
    resultsMustNotBeInputs(summary, folder, names);
    const bio::ArmOptions arm = armOptions(simulation_);
    const std::string coordinate = observed();
    std::unique_ptr<bio::discover::ElbowDisagreement> elbow;
    bio::discover::ElbowOptions options;
    const auto attempt = [&](double step) {
      options.simulation = simulationOptions(simulation_, 0, 1);
      options.simulation.step = step;
      options.without = without_;
      elbow = std::make_unique<bio::discover::ElbowDisagreement>(model, arm, coordinate, trials,
                                                                 options);
      info::discover::Attempt one{*elbow,
                                  engineOptions(maxEffects_, trials_.size(), heldOut_.size())};
      const bool isAngle = elbow->widest().coordinate().isRotation;
      if (noise_) one.options.outputDeviation = isAngle ? *noise_ / radian : *noise_;
      return one;
    };
    const DiscoverSearch found =
        searchForEffects(attempt, simulation_.stepOrDefault(),
                         simulation_.step ? HUGE_VAL : bio::discover::shortestSearchStep);
    const bio::discover::ElbowDisagreement& data = *elbow;
    const info::discover::Verdict& verdict = found.verdict;
    const DiscoverWording wording = wordingOf(data);
    warnOfOneTrial(summary, trials_.size(), heldOut_.size());
    const std::vector<ForeseenExperiment> foreseen =
        foresee(model, arm, trials.front(), options, data, verdict);
    std::string next = foreseenSentence(foreseen, data, verdict);
    if (next.empty()) next = followUp(data, verdict, followUpsOfArms());
    const DiscoverFindings findings{
        model_,  files, data,     wording,           found.options,
        verdict, next,  foreseen, found.wallSeconds, found.processorSeconds};
    summary.set("integrator", simulation_.integrator);
    summary.set("step_s", found.step);
    tellFindings(findings, summary);
    folder.write("verdict.json",
                 [&](std::ostream& out) { out << jsonText(verdictJson(findings), 2) << '\n'; });
    if (mayBeAdded(verdict)) addTo(model, arm, coordinate, trials, data, verdict, summary, folder);
    deliver(context, summary, discoverReport(findings), folder);
    if (found.interrupted) throw Interrupted{};
    return verdict.finding == Finding::numerical ? ExitStatus::answerIsNo : ExitStatus::done;
  }

 private:
  /// Options of the elbow that say nothing of a robot.
  void mustSuitRobots() const {
    if (noise_) throw std::invalid_argument("--noise-deg: with --system it is --noise");
    for (const CLI::Option* option : armOptions_) {
      if (option->count() > 0) {
        throw std::invalid_argument(
            fmt::format("{} does not go with --system", option->get_name()));
      }
    }
  }

  std::string observed() const {
    if (simulation_.coordinates.size() != 1) {
      throw std::invalid_argument(fmt::format("--coordinate: {} are free; discover observes one",
                                              simulation_.coordinates.size()));
    }
    return simulation_.coordinates.front();
  }

  static DiscoverWording wordingOf(const bio::discover::ElbowDisagreement& data) {
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

  /// Writes the model with the effects, and the trials where EMG or sensor were at fault.
  void addTo(const bio::Model& model, const bio::ArmOptions& arm, const std::string& coordinate,
             const std::vector<bio::Trial>& trials, const bio::discover::ElbowDisagreement& data,
             const info::discover::Verdict& verdict, const Summary& summary,
             OutputFolder& folder) const {
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
    bio::discover::EffectProvenance provenance{"fisherhill " + std::string(info::version()), {}};
    for (const Summary::InputFile& input : summary.inputs()) {
      provenance.data.push_back(fmt::format("{} SHA-256 {}", input.path, input.sha256));
    }
    const bio::discover::Augmented added =
        bio::discover::addEffects(model, arm, coordinate, effects, provenance);
    folder.writeFile("with_effect.osim", [&](const std::filesystem::path& path) {
      bio::rewriteOsim(model_, added.model, path);
    });
    if (!concernsTrials(added)) return;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      folder.writeFile(drivenName(i), [&](const std::filesystem::path& path) {
        bio::writeTable(
            drivenTable(bio::discover::asTrueSensor(trials[i], coordinate, added.sensor),
                        data.widest().arm(), added.mapping),
            path);
      });
    }
  }

  static bool concernsTrials(const bio::discover::Augmented& added) {
    const bio::EmgMapping& m = added.mapping;
    const bio::discover::SensorLaw& s = added.sensor;
    return !m.gain.empty() || m.delay != 0 || m.nonlinearity != 0 || !m.offset.empty() ||
           !m.crosstalk.empty() || m.fatigue != 0 || s.bias != 0 || s.gain != 0 || s.clock != 0;
  }

  std::string model_;
  std::vector<std::string> trials_, heldOut_, without_;
  std::optional<double> noise_;
  int maxEffects_ = 3;
  SimulationOptions simulation_;
  RobotRequest robot_;
  std::vector<const CLI::Option*> armOptions_;
};

}  // namespace

std::unique_ptr<Command> discoverCommand() {
  return std::make_unique<Discover>();
}

}  // namespace app
