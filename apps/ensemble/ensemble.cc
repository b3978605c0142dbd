#include "ensemble/ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "bio/analysis/ensemble_statistics.h"
#include "bio/analysis/trial_ensemble.h"
#include "discover/discover_search.h"
#include "ensemble/ensemble_discovery.h"
#include "ensemble/ensemble_draws.h"
#include "ensemble/ensemble_methods.h"
#include "ensemble/ensemble_report.h"
#include "ensemble/missing_rows.h"
#include "ensemble/parameter_laws.h"
#include "info/version.h"
#include "options/input_rules.h"
#include "options/number_rules.h"
#include "options/observed_channels.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "report/result.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;

/// Inputs of the rows beside their numbers, and how they are written.
struct EnsembleStudy {
  EnsembleStudy(const bio::Model& model, const bio::MusculoskeletalSystem& system,
                const bio::SystemOptions& built, const TrialInput& input,
                const bio::TrialEnsembleOptions& options)
      : duration(input.trial.duration()),
        ensemble(model, system, built, input.trial, {input.start.q, input.start.qDot}, options),
        table(ensemble) {}

  double duration;  ///< of the trial [s]
  bio::TrialEnsemble ensemble;
  DrawTable table;
};

class Ensemble : public Command {
 public:
  explicit Ensemble(std::function<std::unique_ptr<WorkerPool>()> gather)
      : gather_(std::move(gather)) {}

  About about() const override {
    return {"ensemble", "Simulate a trial with many random draws of the parameters",
            "fisherhill ensemble models/elbow8.osim emg_data/curl_slow.sto --draws 1000 "
            "--parameters TRI.radius,hand.mass --out out/ensemble"};
  }

  void addOptions(CLI::App& options) override {
    app_ = &options;
    addModelArgument(options, model_);
    options
        .add_option("TRIAL", trial_,
                    "trial: excitations, and what was measured; required unless --discover is "
                    "given")
        ->check(CLI::ExistingFile)
        ->type_name("");
    const std::string group = "Ensemble";
    const auto list = [&](const char* name, std::vector<std::string>& target, const char* text) {
      return options.add_option(name, target, text)
          ->allow_extra_args(false)
          ->delimiter(',')
          ->group(group);
    };
    options
        .add_option("--draws", draws_, "number of simulations; with --sobol: number of base points")
        ->check(CLI::Range(1, 10000000))
        ->capture_default_str()
        ->type_name("N")
        ->group(group);
    list("--parameters", laws_.names,
         "parameters to draw, by name; a name may contain *; default: all")
        ->type_name("NAMES");
    options
        .add_option("--distribution", laws_.distribution,
                    "normal, or uniform over ±√3 standard deviations; both within the bounds")
        ->check(CLI::IsMember({"normal", "uniform"}))
        ->capture_default_str()
        ->group(group);
    options
        .add_option("--spread", laws_.spread,
                    "factor by which every standard deviation is multiplied")
        ->check(positive())
        ->capture_default_str()
        ->type_name("FACTOR")
        ->group(group);
    list("--prior", laws_.priors,
         "mean and standard deviation of a parameter instead of the default, in its unit; may be "
         "repeated")
        ->type_name("NAME=MEAN:SD");
    list("--bounds", laws_.bounds, "bounds of a parameter instead of the default; may be repeated")
        ->type_name("NAME=LOW:HIGH");
    options
        .add_option("--covariance", laws_.covarianceFile,
                    "covariance of normally distributed parameters, as calibrate writes it: a line "
                    "of names, then one row each; without --parameters these are drawn")
        ->check(CLI::ExistingFile)
        ->type_name("FILE.csv")
        ->group(group);
    list("--observe", observe_,
         "channels instead of all free coordinates: elbow_flexion, elbow_flexion.moment, "
         "BRA.fiber_length, …; =SD behind a name, as for sensitivity, has no effect; may be "
         "repeated")
        ->type_name("NAME");
    options
        .add_option("--band-points", bandPoints_, "number of time points in the percentile band")
        ->check(CLI::Range(2, 1000))
        ->capture_default_str()
        ->type_name("N")
        ->group(group);
    options
        .add_flag("--sobol", sobol_,
                  "variance-based sensitivity: Sobol's indices of the output of every channel")
        ->group(group);
    options.add_option("--output", output_, "output whose variance --sobol decomposes")
        ->check(CLI::IsMember(DrawTable::outputNames()))
        ->capture_default_str()
        ->group(group);
    const std::string sets = "Discovery over many data sets";
    options
        .add_option("--discover", discover_,
                    "instead of TRIAL: run discover, on all that is measured, on every subfolder "
                    "that has train_*.sto and held_out*.sto; requires --out")
        ->check(CLI::ExistingDirectory)
        ->type_name("DIR")
        ->group(sets);
    options
        .add_option("--noise-deg", noise_,
                    "with --discover: standard deviation of the measured angles [deg], where "
                    "nothing else is measured; default: estimated from the data")
        ->check(positive())
        ->type_name("DEG")
        ->group(sets);
    options
        .add_option("--max-effects", maxEffects_,
                    "with --discover: largest number of effects in one hypothesis")
        ->check(CLI::Range(1, 3))
        ->capture_default_str()
        ->type_name("N")
        ->group(sets);
    addInputScatter(options, inputScatter_, "with --discover: ", sets);
    addSimulationOptions(options, simulation_);
    addPrescribing(options, simulation_);
  }

  ExitStatus run(const CommandContext& given) override {
    const std::unique_ptr<WorkerPool> pool = gather_();
    CommandContext context = given;
    context.quiet = !pool->leads();
    const int threads = app_->get_option("--threads")->count() > 0 ? context.threads
                                                                   : pool->defaultThreads(context);
    if (pool->leads()) checkChoice(context);
    if (!pool->leads() && !pool->start()) return ExitStatus::done;
    if (!discover_.empty()) {
      return discoverInSets(
          {model_, {}, {}, {}, {}, noise_, {}, maxEffects_, inputScatter_, {}, simulation_},
          discover_, context, *pool, threads);
    }
    if (!pool->leads()) {
      Summary summary(context);
      const auto study = prepare(summary);
      pool->work(rowsOf(*study, context.seed), threads);
      return ExitStatus::done;
    }
    std::vector<std::string> files = {"draws.csv", "band.csv"};
    if (sobol_) files.push_back("sobol.csv");
    OutputFolder folder(mayGoOn(context), files);
    Summary summary(context);
    const auto made = prepare(summary);
    const EnsembleStudy& study = *made;
    resultsMustNotBeInputs(summary, folder, files);
    RowFile file(folder.path(unfinishedRows), settings(study, summary, context.seed),
                 study.table.columns(), context.force);
    if (const std::string damage = damageIn(file); !damage.empty()) summary.warn(damage);
    const auto begin = std::chrono::steady_clock::now();
    const std::size_t computed =
        computeMissing(*pool, threads, file, study.ensemble.count(), rowsOf(study, context.seed),
                       context, "simulations");
    const double wall =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

    const EnsembleFindings findings = findingsOf(study, file, context.seed);
    warnOfRange(study, findings, summary);
    folder.write("draws.csv", [&](std::ostream& out) { writeDraws(findings, out); });
    folder.write("band.csv", [&](std::ostream& out) { writeBand(findings, out); });
    if (sobol_) {
      folder.write("sobol.csv", [&](std::ostream& out) { writeSobol(findings, out); });
    }
    summary.setSimulation(simulation_.integrator, simulation_.stepOrDefault(), study.duration,
                          wall);
    summary.set("computed", computed);
    summary.set("ranks", pool->ranks());
    tellEnsemble(findings, summary);
    sayEnsemble(findings, laws_, context.seed, summary.methods());
    deliver(context, summary, ensembleReport(findings), folder);
    file.remove();
    return ExitStatus::done;
  }

 private:
  void checkChoice(const CommandContext& context) const {
    if (discover_.empty()) {
      if (trial_.empty()) throw std::invalid_argument("TRIAL is required (see --help)");
      for (const char* option : {"--noise-deg", "--max-effects", "--input-scatter"}) {
        if (app_->get_option(option)->count() == 0) continue;
        throw std::invalid_argument(fmt::format("{} requires --discover", option));
      }
      return;
    }
    if (!trial_.empty()) throw std::invalid_argument("TRIAL cannot be combined with --discover");
    for (const CLI::Option* option : app_->get_options()) {
      if (option->get_group() != "Ensemble" || option->count() == 0) continue;
      throw std::invalid_argument(
          fmt::format("{} cannot be combined with --discover", option->get_name()));
    }
    if (!context.out) throw std::invalid_argument("--discover requires --out");
  }

  /// By pointer, since the rows' work refers to it.
  std::unique_ptr<const EnsembleStudy> prepare(Summary& summary) {
    bio::Model model = readModel(model_, summary);
    chooseCoordinates(simulation_, model, {trial_}, false, observe_);
    model = withSetParameters(std::move(model), simulation_, summary);
    const bio::MusculoskeletalSystem system = movableSystem(model, model_, simulation_, summary);
    const TrialInput input = readTrialInput(trial_, model, system, simulation_, summary,
                                            {.channels = !observe_.empty()});
    bio::TrialEnsembleOptions options{.laws = lawRequest(laws_),
                                      .draws = draws_,
                                      .sobol = sobol_,
                                      .output = output_,
                                      .observe = namesOf(observe_),
                                      .bandPoints = bandPoints_};
    options.simulation = input.recorded.simulation;
    if (options.laws.covariance) summary.addInput(laws_.covarianceFile);
    auto made = std::make_unique<const EnsembleStudy>(model, system, systemOptions(simulation_),
                                                      input, options);
    if (const std::string& remark = made->ensemble.nominalRemark(); !remark.empty()) {
      summary.warn(remark);
    }
    return made;
  }

  /// Tells how many draws leave the range of an observed coordinate by more than a tenth of it.
  static void warnOfRange(const EnsembleStudy& study, const EnsembleFindings& f, Summary& summary) {
    for (std::size_t channel = 0; channel < f.channels.size(); ++channel) {
      const bio::Observable& what = study.ensemble.channels()[channel].what;
      if (!what.isCoordinate()) continue;
      const std::uint64_t left = f.channels[channel].leftRange;
      if (left == 0) continue;
      const bio::Coordinate& c = bio::findCoordinate(study.ensemble.model(), what.object);
      const auto& [factor, unit] = study.table.channels()[channel].unit;
      summary.warn(fmt::format(
          "in {} of {} simulations {} leaves its range, {:.4g} to {:.4g} {}, by more than a tenth "
          "of it",
          left, study.ensemble.count(), c.name, c.rangeMin * factor, c.rangeMax * factor, unit));
    }
  }

  /// A row is a function of seed and number alone.
  static RowWork rowsOf(const EnsembleStudy& study, std::uint64_t seed) {
    RowWork work;
    work.together = 64;  // lanes want several possible draws
    work.rows = [&study, seed](std::span<const std::uint64_t> numbers) {
      std::vector<Eigen::VectorXd> thetas;
      for (const std::uint64_t number : numbers) {
        thetas.push_back(study.ensemble.draw(number, seed));
      }
      const std::vector<bio::EnsembleRun> runs = study.ensemble.run(thetas);
      std::vector<std::string> rows;
      for (std::size_t i = 0; i < runs.size(); ++i) {
        rows.push_back(study.table.row(runs[i], thetas[i]));
      }
      return rows;
    };
    return work;
  }

  /// All that the rows depend on; how many there are is not among it.
  Json settings(const EnsembleStudy& study, const Summary& summary, std::uint64_t seed) const {
    Json json;
    json["program"] = "fisherhill ensemble";
    json["version"] = info::version();
    json["model_sha256"] = summary.inputs()[0].sha256;
    json["trial_sha256"] = summary.inputs()[1].sha256;
    json["seed"] = seed;
    json["scheme"] = sobol_ ? "sobol" : "draws";
    json["distribution"] = laws_.distribution;
    json["band_points"] = bandPoints_;
    json["observe"] = namesOf(observe_);
    json["simulation"] = settingsOf(simulation_);
    if (study.ensemble.laws().together) json["covariance_sha256"] = summary.inputs()[2].sha256;
    json["parameters"] = Json::array();
    for (const bio::DrawnParameter& parameter : study.ensemble.laws().parameters) {
      json["parameters"].push_back({parameter.name, parameter.law.mean, parameter.law.sd,
                                    parameter.law.lower, parameter.law.upper});
    }
    return json;
  }

  EnsembleFindings findingsOf(const EnsembleStudy& study, const RowFile& file,
                              std::uint64_t seed) const {
    EnsembleFindings findings{
        model_,
        trial_,
        study.ensemble,
        study.table,
        [&](std::uint64_t number) { return study.table.parse(number, file.row(number)); },
        output_,
        draws_};
    collect(findings, sobol_);
    const auto p = static_cast<int>(study.ensemble.laws().parameters.size());
    for (ChannelFindings& channel : findings.channels) {
      if (!sobol_) break;
      channel.sobol = bio::sobolOf(channel.decomposed, p, seed);
    }
    return findings;
  }

  std::function<std::unique_ptr<WorkerPool>()> gather_;
  CLI::App* app_ = nullptr;
  std::string model_, trial_;
  int draws_ = 1000;
  TypedLaws laws_;
  std::vector<std::string> observe_;
  int bandPoints_ = 46;
  bool sobol_ = false;
  std::string output_ = "final";
  std::string discover_;
  std::optional<double> noise_;
  int maxEffects_ = 3;
  std::optional<double> inputScatter_;
  SimulationOptions simulation_;
};

}  // namespace

std::unique_ptr<Command> ensembleCommand(std::function<std::unique_ptr<WorkerPool>()> gather) {
  return std::make_unique<Ensemble>(std::move(gather));
}

}  // namespace app
