#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bio/analysis/driven_trial.h"
#include "bio/analysis/sensitivity_study.h"
#include "bio/model/units.h"
#include "bio/opensim/osim_file.h"
#include "bio/simulation/integrator_names.h"
#include "bio/tables/table_text.h"
#include "command/command.h"
#include "explore/explore_page.h"
#include "explore/explored_models.h"
#include "explore/page_parameters.h"
#include "options/input_rules.h"
#include "options/set_parameters.h"
#include "options/system_options.h"
#include "options/trial_input.h"
#include "output/json_text.h"
#include "output/sha256.h"
#include "output/text.h"
#include "report/result.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;

/// The model as fitted but without the effect, for the page's command line.
const std::string withoutName = "without_effect.osim";

/// What is measured, in the units in which people see it.
Json channelsOf(const bio::Trial& trial, const bio::Model& model) {
  Json channels = Json::array();
  for (const bio::MeasuredChannel& channel : trial.measured) {
    const bio::ShownUnit unit = shownUnit(unitOf(channel.what, model));
    channels.push_back(
        {{"name", nameOf(channel.what)},
         {"coordinate", channel.what.isCoordinate() ? channel.what.object : ""},
         {"unit", unit.name},
         {"factor", unit.factor},
         {"times", std::vector<double>(channel.times.begin(), channel.times.end())},
         {"values", std::vector<double>(channel.values.begin(), channel.values.end())}});
  }
  return channels;
}

class Explore : public Command {
 public:
  About about() const override {
    return {"explore",
            "Write a page that simulates: parameters as sliders, curves, the limb in 3-D",
            "fisherhill explore models/elbow8.osim emg_data/curl_slow.sto --out out/explore"};
  }

  void addOptions(CLI::App& options) override {
    addModelArgument(options, model_);
    options
        .add_option("TRIAL", trials_,
                    "trial: excitations, and what was measured if it was recorded")
        ->required()
        ->check(CLI::ExistingFile)
        ->type_name("");
    options
        .add_option("--verdict", verdict_,
                    "folder of a result of discover: the page shows its model with and without the "
                    "effect")
        ->check(CLI::ExistingDirectory)
        ->type_name("DIR");
    options
        .add_option("--parameters", names_,
                    "parameters with a slider; a name may contain *, as in "
                    "*.max_isometric_force; default: the twelve that move the motion most")
        ->delimiter(',')
        ->type_name("NAMES")
        ->allow_extra_args(false);
    options
        .add_option("--noise", noise_,
                    "standard deviation of measured angles [deg] and translations [mm], for what "
                    "the trials say of the parameters")
        ->type_name("DEGREES")
        ->capture_default_str();
    addSimulationOptions(options, simulation_);
    addPrescribing(options, simulation_);
  }

  ExitStatus run(const CommandContext& context) override {
    check(context);
    std::vector<std::string> written;
    if (!verdict_.empty()) written.push_back(withoutName);
    OutputFolder folder(context, std::move(written));
    Summary summary(context);
    models_.reserve(3);  // addresses stay
    models_.push_back(asGiven(summary));
    const bio::Model& model = models_.front().model;
    chooseCoordinates(simulation_, model, trials_);
    setParameters(models_.front(), summary);
    const bio::MusculoskeletalSystem system = movableSystem(model, model_, simulation_, summary);
    std::vector<TrialInput> inputs;
    for (const std::string& file : trials_) {
      inputs.push_back(
          readTrialInput(file, model, system, simulation_, summary, {.channels = true}));
    }
    inputsMustDiffer(summary, trials_.size());
    std::optional<EarlierVerdict> verdict;
    if (!verdict_.empty()) verdict = addVerdict(system, summary, folder);

    const PageParameters parameters = pageParameters(
        {models_, system, inputs, systemOptions(simulation_), names_, noise_, verdict});
    const Json data = pageData(model, system, inputs, parameters);
    const std::string title =
        fmt::format("{} and {}{}", model_, trials_.front(), trials_.size() > 1 ? " …" : "");
    const std::string sentence =
        verdict ? verdict->sentence
                : fmt::format("{} simulated anew for every change of {} parameters.",
                              trials_.size() > 1 ? "The trials are" : "The trial is",
                              parameters.list.size());
    summary.set("integrator", simulation_.integrator);
    summary.set("step_s", data["step"]);
    summary.set("duration_s", inputs.front().trial.duration());
    summary.set("parameters", parameters.names());
    const std::string page = explorePage(title, sentence, data, summary);
    summary.set("page_bytes", page.size());
    deliverPage(context, summary, sentence, page, folder);
    return ExitStatus::done;
  }

 private:
  void check(const CommandContext& context) const {
    if (!context.out) {
      throw std::invalid_argument("--out is required: the page is written into this folder");
    }
    if (context.figures) {
      throw std::invalid_argument("--figures: the page saves its curves and the view itself");
    }
    if (!(noise_ > 0 && std::isfinite(noise_))) {
      throw std::invalid_argument(fmt::format("--noise: {} deg, must be > 0", noise_));
    }
    if (simulation_.integrator == "cvode" || simulation_.integrator == "vi-adaptive") {
      throw std::invalid_argument(
          fmt::format("--integrator {}: a page has vi, vi-left and rk4, must be one of them",
                      simulation_.integrator));
    }
  }

  ExploredModel asGiven(Summary& summary) const {
    ExploredModel given;
    given.file = model_;
    given.label = "as given";
    given.model = readModel(model_, summary);
    given.text = documentOf(model_, given.model);
    given.trials = trials_;
    return given;
  }

  /// The model with the values of --set, and its file as if it had them.
  void setParameters(ExploredModel& given, Summary& summary) {
    bio::ModelWithParameters changed = withSetParameters(
        std::move(given.model), systemOptions(simulation_), simulation_.set, summary);
    refuseValuesOfTrial(changed);
    given.model = std::move(changed.model);
    if (changed.numbers.empty()) return;
    set_ = std::move(changed.numbers);
    given.text = bio::rewrittenOsim(given.file, given.model, given.file);
  }

  /// The fitted model with and without the effect; the one as given is for comparison.
  EarlierVerdict addVerdict(const bio::MusculoskeletalSystem& system, Summary& summary,
                            OutputFolder& folder) {
    EarlierVerdict verdict = readVerdict(verdict_);
    models_.front().isShown = false;
    ExploredModel with;
    with.file = verdict.model.string();
    with.model = readModel(with.file, summary);
    with.text = documentOf(with.file, with.model);
    with.label = verdict.effects.empty() ? "refitted" : "with " + verdict.effects;
    for (const std::string& trial : trials_) {
      with.trials.push_back(verdict.replayedFor(trial));
      if (with.trials.back() != trial) summary.addInput(with.trials.back());
    }
    if (!verdict.effects.empty()) {
      ExploredModel without;
      without.model = refitted(models_.front().model, system, verdict);
      without.model.fitted = with.model.fitted;
      without.file = folder.path(withoutName).string();
      without.label = "without it, all else as fitted";
      without.text = bio::rewrittenOsim(model_, without.model, without.file);
      without.trials = trials_;
      folder.write(withoutName, [&](std::ostream& out) { out << without.text; });
      models_.push_back(std::move(without));
    }
    models_.push_back(std::move(with));
    return verdict;
  }

  /// The model as given with the fitted numbers that it has.
  static bio::Model refitted(const bio::Model& given, const bio::MusculoskeletalSystem& system,
                             const EarlierVerdict& verdict) {
    const bio::ParameterCatalogue catalogue(given, system, {system.skeleton().defaultValues(), {}});
    std::vector<std::size_t> selection;
    std::vector<double> values;
    for (const EarlierVerdict::Fitted& fitted : verdict.fitted) {
      if (!catalogue.has(fitted.name) || fitted.name.starts_with("initial.")) continue;
      selection.push_back(catalogue.find(fitted.name));
      values.push_back(fitted.estimate);
    }
    return catalogue
        .at(selection,
            Eigen::VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size())))
        .model;
  }

  /// What the worker loads of a model.
  Json setupOf(const ExploredModel& model, const std::vector<std::string>& parameters) const {
    const bio::SystemOptions system = systemOptions(simulation_);
    Json choice = Json::array();
    for (const std::string& name : system.skeleton.freeCoordinates)
      choice.push_back({"free", name, 0});
    for (const auto& [name, value] : system.skeleton.lockedValues)
      choice.push_back({"locked", name, value});
    for (const std::string& name : simulation_.prescribed)
      choice.push_back({"prescribed", name, 0});
    for (const auto& [name, value] : simulation_.held) choice.push_back({"held", name, value});
    for (const std::string& name : system.wrapAsCylinder) choice.push_back({"cylinder", name, 0});
    for (const Assignment& start : simulation_.initial)
      choice.push_back({"starts", start.name, start.value});
    if (simulation_.ignoreExtra) choice.push_back({"ignoreExtra", "", 0});
    Json trials = Json::array();
    for (const std::string& trial : model.trials)
      trials.push_back({{"file", trial}, {"sha256", sha256OfFile(trial)}});
    return {{"model", model.file},
            {"trials", trials},
            {"choice", choice},
            {"prescribedBySystem", system.prescribed},
            {"parameters", parameters}};
  }

  /// A trial as the page reads it: its file, or with prescribed motions that are smooth already.
  std::string trialText(const std::string& file, const bio::MusculoskeletalSystem& system,
                        const std::vector<TrialInput>& inputs) const {
    const auto recorded = std::find(trials_.begin(), trials_.end(), file);
    if (!simulation_.prescribeCutoff || recorded == trials_.end()) return fileText(file);
    const bio::Trial& trial = inputs[static_cast<std::size_t>(recorded - trials_.begin())].trial;
    return bio::tableText(bio::drivenTable(trial, system, {}), file);
  }

  /// Options of `replay` that the page's command line needs, beside those that the page changes.
  std::string optionText() const {
    SimulationOptions options = simulation_;
    options.integrator = SimulationOptions().integrator;
    std::string text = typedOptions(options, false);
    for (const Assignment& start : simulation_.initial)
      text += " --initial " + shellWord(fmt::format("{}={}", start.name, start.value));
    return text;
  }

  /// By name.
  Json setNumbers() const {
    Json numbers = Json::object();
    for (const bio::SetNumber& one : set_) numbers[one.name] = one.value;
    return numbers;
  }

  Json pageData(const bio::Model& model, const bio::MusculoskeletalSystem& system,
                const std::vector<TrialInput>& inputs, const PageParameters& parameters) const {
    Json files = Json::object(), models = Json::array(), trials = Json::array(),
         coordinates = Json::array();
    for (std::size_t m = 0; m < models_.size(); ++m) {
      const ExploredModel& one = models_[m];
      files[one.file] = one.text;
      for (const std::string& trial : one.trials)
        if (!files.contains(trial)) files[trial] = trialText(trial, system, inputs);
      Json indices = Json::array(), values = Json::array();
      std::vector<std::string> names;
      for (std::size_t i = 0; i < parameters.list.size(); ++i) {
        const std::optional<double>& value = parameters.list[i].inModel[m];
        if (!value) continue;
        indices.push_back(i);
        values.push_back(*value);
        names.push_back(parameters.list[i].name);
      }
      models.push_back({{"file", one.file},
                        {"label", one.label},
                        {"isShown", one.isShown},
                        {"parameters", indices},
                        {"values", values},
                        {"setup", setupOf(one, names)}});
    }
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const bio::Trial& trial = inputs[i].trial;
      Json names = Json::array();
      for (const ExploredModel& one : models_) names.push_back(one.trials[i]);
      trials.push_back({{"name", trials_[i]},
                        {"files", names},
                        {"start", trial.times[0]},
                        {"end", trial.times[trial.times.size() - 1]},
                        {"channels", channelsOf(trial, model)}});
    }
    for (const bio::Coordinate& one : system.skeleton().coordinates()) {
      const bio::ShownUnit unit = bio::positionUnit(one.isRotation);
      coordinates.push_back({{"name", one.name}, {"unit", unit.name}, {"factor", unit.factor}});
    }
    const bio::Integrator integrator = bio::integratorNamed(simulation_.integrator).value();
    return {{"models", models},
            {"files", files},
            {"trials", trials},
            {"coordinates", coordinates},
            {"parameters", parameters.json()},
            {"covariance", parameters.covarianceJson()},
            {"covarianceNote", parameters.note},
            {"alike", {parameters.alike.first, parameters.alike.second}},
            {"integrators",
             {{{"name", "vi"}, {"label", "variational (vi)"}},
              {{"name", "vi-left"}, {"label", "variational, left (vi-left)"}},
              {{"name", "rk4"}, {"label", "Runge–Kutta 4 (rk4)"}}}},
            {"integrator", simulation_.integrator},
            {"step", bio::stepOf(models_.back().model, integrator, simulation_.step)},
            {"set", setNumbers()},
            {"options", optionText()}};
  }

  std::string model_;
  std::vector<std::string> trials_;
  std::string verdict_;  ///< folder; empty: none
  std::vector<std::string> names_;
  double noise_ = 1;
  SimulationOptions simulation_;
  std::vector<ExploredModel> models_;  ///< as given first
  std::vector<bio::SetNumber> set_;    ///< in the first
};

}  // namespace

/// `explore`: a page that simulates.
std::unique_ptr<Command> exploreCommand() {
  return std::make_unique<Explore>();
}

}  // namespace app
