#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bio/analysis/replay.h"
#include "bio/analysis/sensitivity_study.h"
#include "command/command.h"
#include "options/input_rules.h"
#include "options/observed_channels.h"
#include "options/parameter_list.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/progress_bar.h"
#include "report/result.h"
#include "sensitivity/sensitivity_report.h"

namespace app {
namespace {

using bio::StudiedTrial;

class Sensitivity : public Command {
 public:
  About about() const override {
    return {"sensitivity",
            "Rank parameters by influence and report which are identifiable from the data",
            "fisherhill sensitivity models/elbow8.osim emg_data/curl_slow.sto --parameter "
            "TRI.radius --values 0.012,0.014,0.018,0.02 --all --out out/sensitivity"};
  }

  void addOptions(CLI::App& options) override {
    addModelArgument(options, model_);
    options
        .add_option("TRIAL", trials_,
                    "trial: excitations and the sample times of the measured coordinate; required "
                    "unless --list-parameters is given")
        ->check(CLI::ExistingFile)
        ->type_name("");
    addListParameters(options, list_);
    options.add_option("--parameter", swept_, "parameter to vary over --values")
        ->type_name("NAME")
        ->allow_extra_args(false);
    options.add_option("--values", values_, "values of --parameter, in its unit")
        ->delimiter(',')
        ->type_name("NUMBERS")
        ->allow_extra_args(false);
    options.add_flag("--all", all_,
                     "sensitivities to every parameter and Fisher information about them");
    options
        .add_option("--parameters", names_,
                    "as --all, for these parameters only; a name may contain *, as in "
                    "*.max_isometric_force")
        ->delimiter(',')
        ->type_name("NAMES")
        ->allow_extra_args(false);
    options
        .add_option("--noise", noise_,
                    "standard deviation of the measured angle [deg] or translation [mm]")
        ->type_name("DEGREES")
        ->capture_default_str();
    options
        .add_option("--observe", observe_,
                    "what is measured, with the standard deviation of its noise, instead of the "
                    "first coordinate: elbow_flexion=0.5deg, elbow_flexion.moment=0.5, "
                    "BRA.fiber_length=0.001, …; may be repeated")
        ->delimiter(',')
        ->type_name("NAME=SD")
        ->allow_extra_args(false);
    options
        .add_option("--profile", profile_,
                    "one of the --parameters, whose profile likelihood is computed")
        ->type_name("NAME");
    options
        .add_option(
            "--global", global_,
            "global sensitivity over the prior range of the --parameters: morris, sobol or both")
        ->check(CLI::IsMember({"morris", "sobol", "both"}));
    options
        .add_option("--samples", samples_,
                    "number of Morris trajectories, or of base points of Sobol's method")
        ->check(CLI::Range(2, 1000000))
        ->capture_default_str();
    addSimulationOptions(options, simulation_);
    addPrescribing(options, simulation_);
  }

  ExitStatus run(const CommandContext& context) override {
    checkChoice();
    OutputFolder folder(context, fileNames());
    Summary summary(context);
    bio::Model model = readModel(model_, summary);
    chooseCoordinates(simulation_, model, trials_, false, observe_);
    model = withSetParameters(std::move(model), simulation_, summary);
    const bio::MusculoskeletalSystem system = movableSystem(model, model_, simulation_, summary);
    if (list_) return listParameters(context, model, system);

    std::vector<StudiedTrial> trials;
    std::vector<bio::Trial> recorded;
    for (const std::string& file : trials_) {
      TrialInput input = readTrialInput(file, model, system, simulation_, summary,
                                        {.channels = !observe_.empty()});
      trials.push_back(bio::studiedTrial(input.trial, model, system,
                                         {input.start.q, input.start.qDot},
                                         input.recorded.simulation));
      recorded.push_back(std::move(input.trial));
    }
    inputsMustDiffer(summary, trials_.size());
    const StudiedTrial& first = trials.front();
    const bio::Coordinate& coordinate = system.skeleton().coordinates().front();
    bio::SensitivityQuestion question{systemOptions(simulation_), "",
                                      noise_ / shownFactor(coordinate)};
    if (!simulation_.coordinates.empty()) question.coordinate = simulation_.coordinates.front();
    SensitivityFindings findings{model_, trials_, coordinate, recorded.front(), question.noise, 0};
    findings.model = &model;
    question.observed = readObserved(observe_, model, system);
    findings.observed = inWords(question.observed, model);
    if (!question.observed.empty()) {
      findings.noise = 1;
    } else if (simulation_.coordinates.empty()) {
      throw std::invalid_argument(
          "no coordinate is free to be observed: --observe must name what is measured");
    }
    for (const StudiedTrial& trial : trials) {
      findings.samples += static_cast<Eigen::Index>(
          trial.times.size() * std::max<std::size_t>(1, question.observed.size()));
    }
    // every name is looked up before anything long begins
    const auto swept = swept_.empty() ? std::optional<std::size_t>() : first.catalogue.find(swept_);
    if (swept) bio::requireWithinBounds(first.catalogue.parameters()[*swept], values_);
    question.selection = selected(first.catalogue, swept);
    const auto held = profiledIndex(first.catalogue, question.selection);
    if (!global_.empty() && question.selection.size() > bio::mostGlobalParameters) {
      throw std::invalid_argument(
          fmt::format("--global: {} parameters, at most {}; choose them with --parameters",
                      question.selection.size(), bio::mostGlobalParameters));
    }

    if (swept) findings.sweeps.push_back(sweep(first, question, *swept));
    if (!question.selection.empty()) analyse(trials, system, question, findings);
    if (held) {
      ProgressBar bar("profile");
      findings.profile = bio::likelihoodProfile(trials, question, *held);
    }
    if (!global_.empty()) {
      findings.global = globalSensitivity(trials, question, shownFactor(coordinate), context);
      tellUndefined(findings.global, summary);
    }

    if (const auto left = bio::leftRange(
            system, findings.local ? findings.local->motion : findings.sweeps.front().nominal)) {
      summary.warn(left->what);
    }
    writeTables(findings, folder);
    summary.setSimulation(simulation_.integrator, simulation_.stepOrDefault(),
                          first.recorded.simulation.duration,
                          findings.local ? findings.local->motion.wallSeconds
                                         : findings.sweeps.front().nominal.wallSeconds);
    tellSensitivity(findings, summary);
    sayMethods(findings, summary.methods());
    deliver(context, summary, sensitivityReport(findings), folder);
    bool complete = true;
    for (const bio::Sweep& sweep : findings.sweeps) {
      for (const bio::SweepRun& run : sweep.runs) {
        complete = complete && run.motion.outcome == bio::Outcome::completed;
      }
    }
    return complete ? ExitStatus::done : ExitStatus::answerIsNo;
  }

 private:
  void checkChoice() const {
    if (list_) return;
    if (trials_.empty()) throw std::invalid_argument("TRIAL is required (see --help)");
    if (swept_.empty() && !all_ && names_.empty()) {
      throw std::invalid_argument(
          "nothing to do: give --all, --parameters NAMES, --parameter NAME with --values, or "
          "--list-parameters");
    }
    if (swept_.empty() != values_.empty()) {
      throw std::invalid_argument("--parameter and --values require each other");
    }
    if (!(noise_ > 0 && std::isfinite(noise_))) {
      throw std::invalid_argument(fmt::format("--noise: {} deg, must be > 0", noise_));
    }
    if (!observe_.empty() && (!profile_.empty() || !global_.empty())) {
      throw std::invalid_argument(
          "--observe goes with --all and --parameters, not with --profile or --global");
    }
    if ((!profile_.empty() || !global_.empty()) && names_.empty()) {
      throw std::invalid_argument("--profile and --global require --parameters NAMES");
    }
    if ((all_ || !names_.empty()) && !simulation_.isVariational()) {
      throw std::invalid_argument(fmt::format(
          "--integrator {}: must be vi-adaptive, vi or vi-left, which alone have sensitivities",
          simulation_.integrator));
    }
  }

  std::vector<std::string> fileNames() const {
    std::vector<std::string> names = {"sensitivity.csv", "fisher.csv"};
    if (!swept_.empty()) names.push_back("sweep.csv");
    if (!profile_.empty()) names.push_back("profile.csv");
    if (!global_.empty()) names.push_back("global.csv");
    return names;
  }

  std::vector<std::size_t> selected(const bio::ParameterCatalogue& catalogue,
                                    std::optional<std::size_t> swept) const {
    std::vector<std::string> names = names_;
    if (all_) names.insert(names.begin(), "all");
    if (names.empty() && swept && simulation_.isVariational()) {
      return {*swept};
    }
    return catalogue.select(names);
  }

  std::optional<Eigen::Index> profiledIndex(const bio::ParameterCatalogue& catalogue,
                                            const std::vector<std::size_t>& selection) const {
    if (profile_.empty()) return {};
    return bio::indexInSelection(selection, catalogue, profile_);
  }

  bio::Sweep sweep(const StudiedTrial& trial, const bio::SensitivityQuestion& question,
                   std::size_t index) const {
    ProgressBar bar("sweep");
    return bio::parameterSweep(trial, question.system, index, values_,
                               [&](double done) { bar.update(done); });
  }

  void analyse(const std::vector<StudiedTrial>& trials, const bio::MusculoskeletalSystem& system,
               const bio::SensitivityQuestion& question, SensitivityFindings& findings) const {
    ProgressBar bar("sensitivity");
    const StudiedTrial& first = trials.front();
    for (const std::size_t index : question.selection) {
      findings.parameters.push_back(first.catalogue.parameters()[index].name);
    }
    const auto most = static_cast<double>(trials.size());
    findings.information = bio::localSensitivity(trials, question, [&](double done) {
                             bar.update(done * most / (most + 1));
                           }).information;
    const std::size_t further = bio::furtherChannels(system, question).size();
    if (!bio::gainsTakeLong(question.selection.size(), further)) {
      findings.gains = bio::furtherGains(trials, system, question, *findings.information);
    }
    // what all sensitivities cost beside the motion: the best of five, since others use the machine
    double alone = 0, with = 0;
    for (int repeat = 0; repeat < 5; ++repeat) {
      auto local = bio::simulateWithSensitivities(
          system, first.catalogue, first.catalogue.nominal(), question.selection,
          first.recorded.excitation, {first.recorded.simulation, false});
      const double motion = local.motion.wallSeconds;
      alone = repeat == 0 ? motion : std::min(alone, motion);
      const double sum = motion + local.wallSeconds;
      with = repeat == 0 ? sum : std::min(with, sum);
      findings.local = std::move(local);
    }
    findings.costRatio = with / alone;
  }

  bio::GlobalFinding globalSensitivity(const std::vector<StudiedTrial>& trials,
                                       const bio::SensitivityQuestion& question, double shown,
                                       const CommandContext& context) const {
    ProgressBar bar("global");
    bio::GlobalQuestion global{global_ != "sobol", global_ != "morris", shown};
    global.ensemble.samples = samples_;
    global.ensemble.seed = context.seed;
    global.ensemble.threads = context.threads;
    global.ensemble.progress = [&](int done, int runs) {
      bar.update(static_cast<double>(done) / runs);
      return true;
    };
    return bio::globalSensitivity(trials, question, global);
  }

  static void tellUndefined(const bio::GlobalFinding& finding, Summary& summary) {
    const int undefined = finding.undefined();
    if (undefined == 0) return;
    summary.warn(fmt::format(
        "{} runs of the global sensitivity analysis did not reach the end and were left out",
        undefined));
  }

  std::string model_;
  std::vector<std::string> trials_;
  bool list_ = false;
  std::string swept_;
  std::vector<double> values_;
  bool all_ = false;
  std::vector<std::string> names_;
  double noise_ = 1;
  std::vector<std::string> observe_;
  std::string profile_;
  std::string global_;
  int samples_ = 64;
  SimulationOptions simulation_;
};

}  // namespace

/// `sensitivity`: parameter sweeps, exact sensitivities, information, bounds, identifiability;
/// profile likelihood; Morris's and Sobol's global sensitivity.
std::unique_ptr<Command> sensitivityCommand() {
  return std::make_unique<Sensitivity>();
}

}  // namespace app
