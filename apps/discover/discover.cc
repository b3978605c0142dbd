#include <fmt/format.h>

#include "command/command.h"
#include "discover/discover_search.h"
#include "discover/effect_list.h"
#include "discover/model_discovery.h"
#include "options/number_rules.h"
#include "options/quantity.h"
#include "options/trial_input.h"
#include "robot_options/discover_robot.h"

namespace app {
namespace {

class Discover : public Command {
 public:
  explicit Discover(RobotDiscovery inRobot) : inRobot_(std::move(inRobot)) {}

  About about() const override {
    return {"discover", "Find, name and add the effect that a model lacks",
            "fisherhill discover models/elbow8.osim emg_data/hidden_a/train_1.sto "
            "emg_data/hidden_a/train_2.sto --hold-out emg_data/hidden_a/held_out.sto --out "
            "out/discover"};
  }

  void addOptions(CLI::App& options) override {
    addModelArgument(options, model_);
    options
        .add_option(
            "TRIAL", trials_,
            "trials with a measured motion or moment, at least one; with --system every argument "
            "is a trial")
        ->check(CLI::ExistingFile)
        ->type_name("");
    addRobotOptions(options, robot_);
    options
        .add_option("--hold-out", heldOut_,
                    "held-out trial, used to test the result; may be repeated")
        ->check(CLI::ExistingFile)
        ->allow_extra_args(false)
        ->delimiter(',')
        ->type_name("TRIAL");
    options
        .add_option(
            "--noise-deg", noise_,
            "standard deviation of every measured angle [deg]; default: estimated from the data")
        ->check(positive())
        ->type_name("DEG");
    options
        .add_option("--noise", outputNoise_,
                    "standard deviation of one measured column, e.g. elbow_flexion.moment=0.5, in "
                    "its unit [deg for an angle]; may be repeated; with --system the standard "
                    "deviation alone, of each column in turn [deg or N]")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("NAME=VALUE");
    options.add_option("--without", without_, "effects to exclude from the catalogue, by id")
        ->allow_extra_args(false)
        ->delimiter(',')
        ->type_name("IDS");
    options
        .add_option(
            "--effect", effects_,
            "TOML file of effects of your own, forces by a formula, to be looked for beside "
            "the catalogue; may be repeated")
        ->check(CLI::ExistingFile)
        ->allow_extra_args(false)
        ->type_name("FILE.toml");
    options.add_flag("--list-effects", listEffects_,
                     "list every effect of the catalogue for MODEL and exit: id, name, kind, "
                     "parameters with units");
    options.add_option("--max-effects", maxEffects_, "largest number of effects in one hypothesis")
        ->check(CLI::Range(1, 3))
        ->capture_default_str()
        ->type_name("N");
    addInputScatter(options, inputScatter_);
    addTimeLimit(options, timeLimit_);
    const std::size_t common = options.get_options().size();
    addSimulationOptions(options, simulation_);
    addPrescribing(options, simulation_);
    const auto all = options.get_options();
    for (std::size_t i = common; i < all.size(); ++i) {
      const std::string name = all[i]->get_name();
      if (name != "--step" && name != "--ignore-extra") systemOptions_.push_back(all[i]);
    }
  }

  ExitStatus run(const CommandContext& context) override {
    if (listEffects_) {
      if (!robot_.system.empty())
        throw std::invalid_argument("--list-effects cannot be combined with --system");
      return listEffects(context, model_, effects_, simulation_);
    }
    if (!robot_.system.empty()) {
      robot_.trials = trials_;
      robot_.trials.insert(robot_.trials.begin(), model_);
      robot_.heldOut = heldOut_;
      robot_.without = without_;
      robot_.maxEffects = maxEffects_;
      robot_.inputScatter = inputScatter_;
      robot_.timeLimit = timeLimit_;
      robot_.ignoreExtra = simulation_.ignoreExtra;
      robot_.step = simulation_.step;
      mustSuitRobots();
      robot_.noise = noiseOfRobots();
      return inRobot_(robot_, context);
    }
    if (trials_.empty()) throw std::invalid_argument("TRIAL is required (see --help)");
    if (!robot_.with.empty()) throw std::invalid_argument("--with requires --system");
    ModelDiscoveryRequest request{model_,        trials_,    heldOut_,     without_,
                                  effects_,      noise_,     outputNoise_, maxEffects_,
                                  inputScatter_, timeLimit_, simulation_};
    return discoverInModel(request, context).status;
  }

 private:
  /// Options of the elbow that say nothing of a robot.
  void mustSuitRobots() const {
    if (!effects_.empty()) throw std::invalid_argument("--effect cannot be combined with --system");
    if (noise_) throw std::invalid_argument("--noise-deg: with --system use --noise");
    for (const CLI::Option* option : systemOptions_) {
      if (option->count() > 0) {
        throw std::invalid_argument(
            fmt::format("{} cannot be combined with --system", option->get_name()));
      }
    }
  }

  std::vector<double> noiseOfRobots() const {
    std::vector<double> noise;
    for (const std::string& text : outputNoise_) {
      try {
        noise.push_back(parseNumber(text));
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(fmt::format("--noise: {}", error.what()));
      }
      if (!(noise.back() > 0))
        throw std::invalid_argument(fmt::format("--noise: {} must be > 0", text));
    }
    return noise;
  }

  RobotDiscovery inRobot_;
  std::string model_;
  std::vector<std::string> trials_, heldOut_, without_, effects_, outputNoise_;
  std::optional<double> noise_;
  int maxEffects_ = 3;
  bool listEffects_ = false;
  std::optional<double> inputScatter_, timeLimit_;
  SimulationOptions simulation_;
  RobotRequest robot_;
  std::vector<const CLI::Option*> systemOptions_;
};

}  // namespace

/// `fisherhill discover MODEL TRIAL…`: finds where simulation and data disagree, names the missing
/// effect and adds it; writes verdict.json and with_effect.osim.
/// @param inRobot  what --system does
std::unique_ptr<Command> discoverCommand(RobotDiscovery inRobot) {
  return std::make_unique<Discover>(std::move(inRobot));
}

}  // namespace app
