#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bio/analysis/replay.h"
#include "bio/calibration/trial_predictor.h"
#include "command/command.h"
#include "options/input_rules.h"
#include "options/parameter_list.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/progress_bar.h"
#include "output/result.h"
#include "sensitivity/nonlocal_analysis.h"
#include "sensitivity/observed_channels.h"
#include "sensitivity/sensitivity_report.h"

namespace app {
namespace {

/// A trial with the parameters' catalogue for its start, and when its coordinate was measured.
struct Study {
  TrialInput input;
  bio::ParameterCatalogue catalogue;
  std::vector<double> times;  ///< [s]
};

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
    const bio::Model model = readModel(model_, summary);
    chooseCoordinates(simulation_, model, trials_);
    const bio::MusculoskeletalSystem arm = movableSystem(model, model_, simulation_, summary);
    if (list_) return listParameters(context, model, arm);

    std::vector<Study> studies;
    for (const std::string& file : trials_) {
      TrialInput input =
          readTrialInput(file, model, arm, simulation_, summary, {.channels = !observe_.empty()});
      bio::ParameterCatalogue catalogue(model, arm, {input.start.q, input.start.qDot});
      std::vector<double> times = bio::observedTimes(
          input.trial, arm.skeleton().coordinates().front().name, simulation_.stepOrDefault());
      studies.push_back({std::move(input), std::move(catalogue), std::move(times)});
    }
    inputsMustDiffer(summary, trials_.size());
    const Study& first = studies.front();
    const bio::Coordinate& coordinate = arm.skeleton().coordinates().front();
    SensitivityFindings findings{
        model_, trials_, coordinate, first.input.trial, noise_ / shownFactor(coordinate), 0};
    findings.model = &model;
    observed_ = readObserved(observe_, model, arm);
    findings.observed = inWords(observed_, model);
    if (!observed_.empty()) {
      findings.noise = 1;
    } else if (simulation_.coordinates.empty()) {
      throw std::invalid_argument(
          "no coordinate is free to be observed: --observe must name what is measured");
    }
    for (const Study& study : studies) {
      findings.samples += static_cast<Eigen::Index>(study.times.size() *
                                                    std::max<std::size_t>(1, observed_.size()));
    }
    // every name is looked up before anything long begins
    const auto swept = swept_.empty() ? std::optional<std::size_t>() : first.catalogue.find(swept_);
    if (swept) checkValues(first.catalogue.parameters()[*swept]);
    const auto selection = selected(first.catalogue, swept);
    const auto held = profiledIndex(first.catalogue, selection);
    if (!global_.empty() && selection.size() > 32) {
      throw std::invalid_argument(fmt::format(
          "--global: {} parameters, at most 32; choose them with --parameters", selection.size()));
    }

    if (swept) findings.sweeps.push_back(sweep(first, *swept));
    if (!selection.empty()) analyse(studies, arm, selection, findings);
    if (held) {
      const double noise = noise_ / shownFactor(firstCoordinate(studies));
      findings.profile = likelihoodProfile(experiments(studies, selection), first.catalogue,
                                           selection, *held, noise);
    }
    if (!global_.empty()) {
      findings.global =
          globalSensitivity(experiments(studies, selection), first.catalogue, selection,
                            {global_, samples_, shownFactor(firstCoordinate(studies))}, context);
      tellUndefined(findings.global, summary);
    }

    if (const auto left = bio::leftRange(
            arm, findings.local ? findings.local->motion : findings.sweeps.front().nominal)) {
      summary.warn(left->what);
    }
    writeTables(findings, folder);
    summary.setSimulation(simulation_.integrator, simulation_.stepOrDefault(), first.input.duration,
                          findings.local ? findings.local->motion.wallSeconds
                                         : findings.sweeps.front().nominal.wallSeconds);
    tellSensitivity(findings, summary);
    deliver(context, summary, sensitivityReport(findings), folder);
    bool complete = true;
    for (const Sweep& one : findings.sweeps) {
      for (const SweepRun& sweepRun : one.runs) {
        complete = complete && sweepRun.motion.outcome == bio::Outcome::completed;
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
    const bool isVariational = simulation_.integrator.starts_with("vi");
    if ((all_ || !names_.empty()) && !isVariational) {
      throw std::invalid_argument(
          fmt::format("--integrator {}: must be vi or vi-left, which alone have sensitivities",
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

  void checkValues(const bio::ModelParameter& parameter) const {
    for (const double value : values_) {
      if (value >= parameter.lower && value <= parameter.upper) continue;
      throw std::invalid_argument(
          fmt::format("--values: {} = {} {}, must be {:.4g} to {:.4g} {}{}{}", parameter.name,
                      value, parameter.unit, parameter.lower, parameter.upper, parameter.unit,
                      value >= parameter.limit ? ": " : "",
                      value >= parameter.limit ? parameter.whyLimited : ""));
    }
  }

  std::vector<std::size_t> selected(const bio::ParameterCatalogue& catalogue,
                                    std::optional<std::size_t> swept) const {
    std::vector<std::string> names = names_;
    if (all_) names.insert(names.begin(), "all");
    if (names.empty() && swept && simulation_.integrator.starts_with("vi")) {
      return {*swept};
    }
    return catalogue.select(names);
  }

  std::optional<Eigen::Index> profiledIndex(const bio::ParameterCatalogue& catalogue,
                                            const std::vector<std::size_t>& selection) const {
    if (profile_.empty()) return {};
    const std::size_t index = catalogue.find(profile_);
    const auto at = std::find(selection.begin(), selection.end(), index);
    if (at == selection.end()) {
      throw std::invalid_argument(
          fmt::format("--profile: {} is not one of the --parameters", profile_));
    }
    return at - selection.begin();
  }

  bio::SimulationOptions options(const Study& study) const {
    bio::SimulationOptions chosen =
        simulationOptions(simulation_, study.input.startTime, study.input.duration);
    chosen.externalForce = study.input.externalForce;
    chosen.prescribed = study.input.prescribed;
    return chosen;
  }

  bio::TrialPredictor experiment(const Study& study,
                                 const std::vector<std::size_t>& selection) const {
    if (observed_.empty()) {
      return {study.catalogue,
              armOptions(simulation_),
              study.input.excitation,
              simulation_.coordinates.front(),
              study.times,
              selection,
              options(study)};
    }
    return {study.catalogue,
            armOptions(simulation_),
            study.input.excitation,
            seriesOf(observed_, study.times),
            selection,
            options(study)};
  }

  /// What other channels would add, unless that would take long.
  void addGains(const std::vector<Study>& studies, const bio::MusculoskeletalSystem& arm,
                const std::vector<std::size_t>& selection, SensitivityFindings& findings) const {
    const std::vector<bio::ChannelCandidate> candidates = furtherChannels(
        arm, observed_, simulation_.coordinates.empty() ? "" : simulation_.coordinates.front());
    if (gainsTakeLong(selection.size(), candidates.size())) return;
    std::vector<Eigen::MatrixXd> information;
    for (const Study& study : studies) {
      const auto motion =
          bio::simulateWithSensitivities(arm, study.catalogue, study.catalogue.nominal(), selection,
                                         study.input.excitation, {options(study), true, true});
      const auto more = bio::informationOf(arm, candidates, study.times, motion);
      for (std::size_t c = 0; c < more.size(); ++c) {
        if (information.size() == c) {
          information.push_back(more[c]);
        } else {
          information[c] += more[c];
        }
      }
    }
    findings.gains = bio::channelGains(*findings.information, candidates, information);
  }

  Sweep sweep(const Study& study, std::size_t index) const {
    ProgressBar bar("sweep");
    const auto simulated = [&](double value) {
      const auto setting = study.catalogue.at({index}, Eigen::VectorXd::Constant(1, value));
      const bio::MusculoskeletalSystem arm(setting.model, armOptions(simulation_));
      return bio::simulateSetting(arm, setting, study.input.excitation, options(study));
    };
    const bio::ModelParameter& parameter = study.catalogue.parameters()[index];
    Sweep result{parameter, simulated(parameter.value), {}};
    for (const double value : values_) {
      bar.update(static_cast<double>(result.runs.size()) / static_cast<double>(values_.size()));
      SweepRun one{value, simulated(value), 0, 0};
      const Eigen::Index rows = std::min(one.motion.q.cols(), result.nominal.q.cols());
      const Eigen::RowVectorXd change =
          one.motion.q.row(0).head(rows) - result.nominal.q.row(0).head(rows);
      one.rms = std::sqrt(change.squaredNorm() / static_cast<double>(rows));
      one.largest = change.cwiseAbs().maxCoeff();
      result.runs.push_back(std::move(one));
    }
    return result;
  }

  void analyse(const std::vector<Study>& studies, const bio::MusculoskeletalSystem& arm,
               const std::vector<std::size_t>& selection, SensitivityFindings& findings) const {
    ProgressBar bar("sensitivity");
    const bio::ParameterCatalogue& catalogue = studies.front().catalogue;
    for (const std::size_t index : selection) {
      findings.parameters.push_back(catalogue.parameters()[index].name);
    }
    std::vector<Eigen::MatrixXd> gammas;
    for (const Study& study : studies) {
      const auto linearised =
          experiment(study, selection).withSensitivities(study.catalogue.values(selection));
      if (!linearised.outputs.allFinite()) {
        throw std::invalid_argument(fmt::format(
            "{}: the simulation does not reach the end of the trial", study.input.trial.file));
      }
      gammas.push_back(linearised.gamma);
      scaleByNoise(observed_, gammas.back());
      bar.update(static_cast<double>(gammas.size()) / static_cast<double>(studies.size() + 1));
    }
    findings.information = bio::informationAbout(catalogue, selection, gammas, findings.noise);
    addGains(studies, arm, selection, findings);
    // what all sensitivities cost beside the motion: the best of five, since others use the machine
    const Study& first = studies.front();
    double alone = 0, with = 0;
    for (int repeat = 0; repeat < 5; ++repeat) {
      auto local = bio::simulateWithSensitivities(arm, catalogue, catalogue.nominal(), selection,
                                                  first.input.excitation, {options(first), false});
      const double motion = local.motion.wallSeconds;
      alone = repeat == 0 ? motion : std::min(alone, motion);
      const double sum = motion + local.wallSeconds;
      with = repeat == 0 ? sum : std::min(with, sum);
      findings.local = std::move(local);
    }
    findings.costRatio = with / alone;
  }

  const bio::Coordinate& firstCoordinate(const std::vector<Study>& studies) const {
    return bio::findCoordinate(studies.front().catalogue.model(), simulation_.coordinates.front());
  }

  std::vector<bio::TrialPredictor> experiments(const std::vector<Study>& studies,
                                               const std::vector<std::size_t>& selection) const {
    std::vector<bio::TrialPredictor> all;
    for (const Study& study : studies) all.push_back(experiment(study, selection));
    return all;
  }

  static void tellUndefined(const GlobalFinding& finding, Summary& summary) {
    const int undefined = (finding.morris ? finding.morris->undefined : 0) +
                          (finding.sobol ? finding.sobol->undefined : 0);
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
  std::vector<bio::ChannelCandidate> observed_;
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
