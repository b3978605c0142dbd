#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "bio/analysis/replay.h"
#include "bio/model/units.h"
#include "bio/opensim/osim_file.h"
#include "bio/parameters/sign_of_parameter.h"
#include "bio/review/trial_review.h"
#include "calibrate/calibrate_methods.h"
#include "calibrate/calibrate_playback.h"
#include "calibrate/calibrate_remarks.h"
#include "calibrate/calibrate_report.h"
#include "calibrate/fitted_table.h"
#include "command/command.h"
#include "info/version.h"
#include "options/input_rules.h"
#include "options/model_methods.h"
#include "options/named_pairs.h"
#include "options/number_rules.h"
#include "options/parameter_list.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/driven_trials.h"
#include "output/json_text.h"
#include "output/progress_bar.h"
#include "output/text.h"
#include "report/result.h"
#include "sensitivity/named_covariance.h"

namespace app {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

class Calibrate : public Command {
 public:
  About about() const override {
    return {"calibrate", "Estimate model parameters from measured motions",
            "fisherhill calibrate models/elbow8.osim emg_data/curl_slow.sto --hold-out "
            "emg_data/curl_fast.sto --parameters TRI.radius,hand.mass --out out/calibrate"};
  }

  void addOptions(CLI::App& options) override {
    options.add_option("MODEL", model_, "model (.osim, URDF or MJCF)")
        ->required()
        ->check(CLI::ExistingFile)
        ->type_name("");
    options
        .add_option(
            "TRIAL", trials_,
            "calibration trials with a measured angle; required unless --list-parameters is given")
        ->check(CLI::ExistingFile)
        ->type_name("");
    const std::string group = "Calibration";
    const auto list = [&](const char* name, std::vector<std::string>& target, const char* text) {
      return options.add_option(name, target, text)
          ->allow_extra_args(false)
          ->delimiter(',')
          ->group(group);
    };
    list("--parameters", parameters_, "parameters to estimate, by name, e.g. TRI.radius,hand.mass")
        ->type_name("NAMES");
    addListParameters(options, list_);
    list("--hold-out", heldOut_, "held-out trial, used only to test the estimates; may be repeated")
        ->check(CLI::ExistingFile)
        ->type_name("TRIAL");
    options
        .add_flag("--own-start", ownStart_,
                  "estimate the initial angle and speed of each trial as well, of a held-out trial "
                  "with the parameters fixed")
        ->group(group);
    list("--latent", latent_,
         "muscle without an electrode, whose excitation is estimated about the trial's column: "
         "standard deviation of its log-odds, and largest distance of knots [s]; instead of what "
         "the trials say; may be repeated")
        ->type_name("MUSCLE=SD:SECONDS");
    options.add_flag("--no-priors", noPriors_, "estimate without priors; bounds still apply")
        ->group(group);
    list("--prior", priors_,
         "prior of a parameter instead of the default, in its unit; may be repeated")
        ->type_name("NAME=MEAN:SD");
    list("--bounds", bounds_, "bounds of a parameter instead of the default; may be repeated")
        ->type_name("NAME=LOW:HIGH");
    options
        .add_option("--noise-deg", noise_,
                    "standard deviation of the measured angle [deg]; default: estimated from the "
                    "residuals and their autocorrelation")
        ->check(positive())
        ->type_name("DEG")
        ->group(group);
    list("--noise", channelNoise_,
         "standard deviation of another measured channel, e.g. elbow_flexion.moment=0.5, in its "
         "unit; default: estimated in the same way; may be repeated")
        ->type_name("NAME=VALUE");
    options
        .add_option("--loss", loss_,
                    "loss function: gaussian, or the outlier-robust huber or student")
        ->check(CLI::IsMember({"gaussian", "huber", "student"}))
        ->capture_default_str()
        ->group(group);
    options
        .add_option("--starts", starts_,
                    "number of optimiser starts (the first is the model's own values)")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str()
        ->type_name("N")
        ->group(group);
    list("--profile", profile_, "parameters whose profile likelihood is computed")
        ->type_name("NAMES");
    options.add_option("--bootstrap", bootstrap_, "number of residual-bootstrap replicates")
        ->check(CLI::Range(20, 100000))
        ->type_name("N")
        ->group(group);
    addConvertMusclesOption(options, muscleClass_);
    addSimulationOptions(options, simulation_);
    addPrescribing(options, simulation_);
  }

  ExitStatus run(const CommandContext& context) override {
    if (list_) return listAll(context);
    const bio::CalibrationOptions typed = calibrationOptions(context);
    std::vector<std::string> names = {"calibrated.osim", "covariance.csv", "parameters.csv"};
    for (std::size_t i = 0; i < trials_.size(); ++i) names.push_back(drivenName(i + 1, false));
    for (std::size_t i = 0; i < heldOut_.size(); ++i) names.push_back(drivenName(i + 1, true));
    OutputFolder folder(context, names);
    Summary summary(context);
    summary.addInput(model_);
    for (const auto* files : {&trials_, &heldOut_}) {
      for (const std::string& file : *files) summary.addInput(file);
    }
    inputsMustDiffer(summary, trials_.size());
    resultsMustNotBeInputs(summary, folder, names);

    bio::Model model = bio::readOsim(model_);
    for (const std::string& warning : model.warnings) summary.warn(warning);
    convertMuscles(muscleClass_, model, summary);
    chooseCoordinates(simulation_, model, trials_);
    model = withSetParameters(std::move(model), simulation_, summary);
    const bio::TrialSet training(model, systemOptions(simulation_), read(trials_, model, summary),
                                 typed.trials);
    for (const std::string& warning : training.system().warnings()) summary.warn(warning);
    boundsMustBePossible(training, typed);
    const std::vector<bio::Trial> heldOut = read(heldOut_, model, summary);
    tellNotFitted(training, heldOut, summary);

    bio::CalibrationOptions options = typed;
    bio::SteppedCalibration found;
    const auto begin = std::chrono::steady_clock::now();
    {
      ProgressBar bar("calibrate", context.quiet);
      options.progress = [&](double share) {
        bar.update(share);
        return true;
      };
      found = bio::calibrateAtShorterSteps(
          model, systemOptions(simulation_), training.trials(), heldOut, options,
          simulation_.step ? infinity : bio::shortestCalibrationStep);
    }
    summary.setSimulation(
        simulation_.integrator, found.options.trials.simulation.step,
        longestDuration(training.trials()),
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    std::optional<bio::CalibratedModel> calibrated;
    const bio::Calibration& calibration = found.calibration;
    if (calibration.calibrated) {
      calibrated =
          bio::calibratedModel(*found.training, found.heldOut.get(), systemOptions(simulation_),
                               found.options.trials.simulation, calibration);
    }
    CalibrateFindings findings{model_,
                               model,
                               *found.training,
                               found.heldOut.get(),
                               found.options,
                               calibration,
                               calibrated ? &*calibrated : nullptr};
    if (folder.active()) findings.playback = calibratePlayback(findings);
    tellCalibrate(findings, summary);
    tellSteps(typed.trials.simulation.step, found, summary);
    sayModel(model, found.training->system(), summary.methods());
    sayExcitations(found.training->system(), summary.methods());
    sayCalibration(findings, summary.methods());
    if (calibrated) {
      writeTrials(*calibrated, summary, folder);
      writeModel(findings, calibrated->model, summary, folder);
      folder.write("parameters.csv",
                   [&](std::ostream& out) { writeFitted(fittedNumbers(calibration), out); });
      const NamedCovariance covariance = covarianceOf(calibration);
      if (!covariance.names.empty()) {
        folder.write("covariance.csv",
                     [&](std::ostream& out) { writeCovariance(covariance, out); });
      }
    }
    deliver(context, summary, calibrateReport(findings), folder);
    return calibration.failure.empty() && calibration.converged ? ExitStatus::done
                                                                : ExitStatus::answerIsNo;
  }

 private:
  ExitStatus listAll(const CommandContext& context) {
    Summary summary(context);
    bio::Model model = readModel(model_, summary);
    convertMuscles(muscleClass_, model, summary);
    chooseCoordinates(simulation_, model, trials_);
    model = withSetParameters(std::move(model), simulation_, summary);
    return listParameters(context, model, movableSystem(model, model_, simulation_, summary));
  }

  bio::CalibrationOptions calibrationOptions(const CommandContext& context) const {
    if (trials_.empty()) throw std::invalid_argument("TRIAL is required (see --help)");
    if (parameters_.empty()) {
      throw std::invalid_argument("--parameters is required; --list-parameters lists the choices");
    }
    bio::CalibrationOptions options;
    for (const std::string& name : parameters_) {
      if (name.empty()) throw std::invalid_argument("--parameters: a name is empty");
    }
    options.trials.parameters = parameters_;
    options.trials.ownStart = ownStart_;
    options.trials.latent = true;
    options.trials.initial = byName(simulation_.initial);
    options.trials.simulation = simulationOptions(simulation_, 0, 1);
    options.trials.threads = context.threads;
    options.priors = !noPriors_;
    for (const NamedPair& prior : parsePairs(priors_, "--prior")) {
      options.prior[prior.name] = {prior.first, prior.second};
    }
    for (const NamedPair& bounds : parsePairs(bounds_, "--bounds")) {
      options.bounds[bounds.name] = {bounds.first, bounds.second};
    }
    if (noise_) options.noise = *noise_ / bio::degreesPerRadian;
    for (const std::string& text : channelNoise_) {
      const Assignment assignment = parseAssignment(text);
      if (!options.channelNoise.emplace(assignment.name, assignment.value).second) {
        throw std::invalid_argument(fmt::format("--noise: '{}' is given twice", assignment.name));
      }
    }
    options.loss.kind = loss_ == "huber"     ? info::RobustLoss::Kind::huber
                        : loss_ == "student" ? info::RobustLoss::Kind::student
                                             : info::RobustLoss::Kind::gaussian;
    options.starts = starts_;
    options.seed = context.seed;
    options.profile = profile_;
    options.bootstrap = bootstrap_.value_or(0);
    return options;
  }

  static void boundsMustBePossible(const bio::TrialSet& training,
                                   const bio::CalibrationOptions& options) {
    for (const auto& [name, bounds] : options.bounds) {
      if (bio::namesKnot(name)) continue;  // refused with the reason
      const bio::ModelParameter& parameter =
          training.catalogue().parameters()[training.catalogue().find(name)];
      if (bounds.first >= 0 || !bio::cannotBeNegative(parameter)) continue;
      throw std::invalid_argument(fmt::format("--bounds: lower bound of {} = {} {}, must be ≥ 0",
                                              parameter.name, bounds.first, parameter.unit));
    }
  }

  std::vector<bio::Trial> read(const std::vector<std::string>& files, const bio::Model& model,
                               Summary& summary) const {
    std::vector<bio::Trial> trials;
    for (const std::string& file : files) {
      trials.push_back(readTrialFile(file, model, simulation_, {.channels = true}));
      for (const std::string& warning : trials.back().warnings) summary.warn(warning);
      if (!latent_.empty()) {
        trials.back().latent.clear();
        for (const NamedPair& pair : parsePairs(latent_, "--latent")) {
          trials.back().latent.push_back({pair.name, pair.first, pair.second});
        }
      }
      for (const bio::MeasuredChannel& motion : trials.back().measured) {
        if (!motion.what.isCoordinate()) continue;
        const std::string why = bio::whyNotUsable(motion);
        if (!why.empty())
          summary.warn(fmt::format("{}: measured {} for a reliable estimate", file, why));
      }
    }
    return trials;
  }

  void writeModel(const CalibrateFindings& f, bio::Model model, const Summary& summary,
                  OutputFolder& folder) const {
    std::string text =
        fmt::format("Calibrated by FisherHill {} ({})", info::version(), summary.commandLine());
    for (std::size_t i = 0; i < summary.inputs().size(); ++i) {
      const char* what = i == 0 ? "from" : i <= trials_.size() ? "to" : "tested on";
      text += fmt::format("; {} {} SHA-256 {}", what, summary.inputs()[i].path,
                          summary.inputs()[i].sha256);
    }
    for (const bio::CalibratedParameter& parameter : f.calibration.parameters) {
      if (!parameter.ofTrial) text += "; " + estimateWords(parameter);
    }
    model.credits += model.credits.empty() ? text : ". " + text;
    folder.writeFile("calibrated.osim", [&](const std::filesystem::path& path) {
      if (muscleClass_.empty()) {
        bio::rewriteOsim(model_, model, path);
      } else {  // the original's document holds other classes
        bio::writeOsim(model, path);
      }
    });
  }

  /// Covariance of the model's parameters that have an interval, for `ensemble`.
  static NamedCovariance covarianceOf(const bio::Calibration& calibration) {
    NamedCovariance covariance;
    std::vector<Eigen::Index> kept;
    std::vector<double> sds;
    for (std::size_t i = 0; i < calibration.parameters.size(); ++i) {
      const bio::CalibratedParameter& parameter = calibration.parameters[i];
      const bool isOfModel =
          !parameter.ofTrial && !std::holds_alternative<bio::EmgTarget>(parameter.target);
      if (!isOfModel || !(parameter.sd > 0)) continue;
      covariance.names.push_back(parameter.asked.name);
      kept.push_back(static_cast<Eigen::Index>(i));
      sds.push_back(parameter.sd);
    }
    const Eigen::Map<const Eigen::VectorXd> d(sds.data(), static_cast<Eigen::Index>(sds.size()));
    const Eigen::MatrixXd correlation = calibration.correlation(kept, kept);
    covariance.values = d.asDiagonal() * correlation * d.asDiagonal();
    return covariance;
  }

  /// Writes driven trials, and lists the files to replay.
  void writeTrials(bio::CalibratedModel& calibrated, Summary& summary, OutputFolder& folder) const {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const bio::CalibratedTrial& trial : calibrated.trials) {
      std::string file = (trial.isHeldOut ? heldOut_ : trials_)[trial.index];
      nlohmann::ordered_json json{{"file", file}, {"role", trial.isHeldOut ? "held_out" : "train"}};
      if (trial.driven) file = writeDriven(trial, trial.index + 1, calibrated.model, folder);
      json["replay_file"] = file;
      json["rmse_after_deg"] = orNull(trial.after * bio::degreesPerRadian);
      for (const bio::ChannelError& channel : trial.channels) {
        json["rms_error"][nameOf(channel.what)] = {
            {"value", channel.error.rms}, {"unit", bio::unitOf(channel.what, calibrated.model)}};
      }
      json["start"] = nlohmann::ordered_json::array();
      for (const bio::TrialStart& start : trial.starts) {
        json["start"].push_back(
            {{"coordinate", start.coordinate}, {"value", start.value}, {"speed", start.speed}});
      }
      list.push_back(std::move(json));
    }
    summary.set("trials", list);
  }

  std::string model_;
  std::string muscleClass_;  ///< empty: as in the model
  std::vector<std::string> trials_, heldOut_, parameters_, priors_, bounds_, profile_, latent_,
      channelNoise_;
  bool ownStart_ = false, noPriors_ = false, list_ = false;
  std::optional<double> noise_;
  std::string loss_ = "gaussian";
  int starts_ = 1;
  std::optional<int> bootstrap_;
  SimulationOptions simulation_;
};

}  // namespace

/// `fisherhill calibrate MODEL TRIAL… --parameters …`: estimates parameters from measured motions;
/// writes calibrated.osim and, if the relation between EMG and excitation was calibrated, the
/// trials with the corrected excitations.
std::unique_ptr<Command> calibrateCommand() {
  return std::make_unique<Calibrate>();
}

}  // namespace app
