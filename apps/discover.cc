#include "discover.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "angle_unit.h"
#include "arm_input.h"
#include "arm_options.h"
#include "bio/discover/add_effects.h"
#include "bio/discover/effects.h"
#include "bio/osim_file.h"
#include "discover_report.h"
#include "driven_trial.h"
#include "follow_up.h"
#include "info/version.h"
#include "interruption.h"
#include "progress_bar.h"
#include "result.h"

namespace app {
namespace {

using info::discover::Finding;
using info::discover::Stage;

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
    options.add_option("TRIAL", trials_, "trials with a measured angle")
        ->required()
        ->check(CLI::ExistingFile)
        ->type_name("");
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
    addSimulationOptions(options, simulation_);
  }

  ExitStatus run(const CommandContext& context) override {
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
    mustDiffer(summary);
    if (trials_.size() == 1 && heldOut_.empty()) {
      summary.warn(
          "one trial and none held out: whether a name holds for other motions remains untested; "
          "add trials, or one with --hold-out");
    }
    const bio::ArmOptions arm = armOptions(simulation_);
    const std::string coordinate = observed();
    mustBeKnown(bio::discover::widestModel(model, arm, coordinate));
    bool interrupted = false;
    std::unique_ptr<bio::discover::ElbowDisagreement> made;
    info::discover::Options options;
    info::discover::Verdict verdict;
    // steps that are too long look like an effect: shorter ones, unless they were asked for
    for (double step = simulation_.stepOrDefault();; step /= 2) {
      bio::discover::ElbowOptions elbow;
      elbow.simulation = simulationOptions(simulation_, 0, 1);
      elbow.simulation.step = step;
      elbow.without = without_;
      made =
          std::make_unique<bio::discover::ElbowDisagreement>(model, arm, coordinate, trials, elbow);
      options = engineOptions(made->widest().coordinate().isRotation);
      ProgressBar bar("discover");
      options.progress = [&](const info::discover::Progress& at) {
        if (!interruptionRequested()) bar.update(at.fraction);
        interrupted = interruptionRequested();
        return !interrupted;
      };
      verdict = info::discover::run(*made, options);
      summary.set("step_s", step);
      if (verdict.finding != Finding::numerical || simulation_.step || step < 0.003) break;
    }
    const bio::discover::ElbowDisagreement& data = *made;
    const bool isAngle = data.widest().coordinate().isRotation;
    const std::string next = followUp(data, verdict);
    const DiscoverFindings findings{model_, files, data, options, verdict, next, isAngle};
    tell(findings, summary);
    folder.write("verdict.json",
                 [&](std::ostream& out) { out << verdictJson(findings).dump(2) << '\n'; });
    if (mayBeAdded(verdict)) addTo(model, arm, coordinate, trials, findings, summary, folder);
    deliver(context, summary, discoverReport(findings), folder);
    if (interrupted) throw Interrupted{};
    return verdict.finding == Finding::numerical ? ExitStatus::answerIsNo : ExitStatus::done;
  }

 private:
  static std::string drivenName(std::size_t i) { return fmt::format("driven_{}.sto", i + 1); }

  std::string observed() const {
    if (simulation_.coordinates.size() != 1) {
      throw std::invalid_argument(fmt::format("--coordinate: {} are free; discover observes one",
                                              simulation_.coordinates.size()));
    }
    return simulation_.coordinates.front();
  }

  /// --without names effects of the catalogue, or such as the model has already.
  void mustBeKnown(const bio::discover::WidestModel& widest) const {
    const auto& entries = bio::discover::effectEntries();
    for (const std::string& id : without_) {
      if (widest.knows(id) || widest.present().count(id) > 0 ||
          std::any_of(entries.begin(), entries.end(),
                      [&](const bio::discover::EffectEntry& entry) { return id == entry.id; })) {
        continue;
      }
      std::vector<std::string> ids;
      for (const auto& candidate : widest.candidates()) ids.push_back(candidate.id);
      throw std::invalid_argument(fmt::format("--without: no effect is called '{}'; there are {}",
                                              id, fmt::join(ids, ", ")));
    }
  }

  static void mustDiffer(const Summary& summary) {
    const auto& inputs = summary.inputs();
    for (std::size_t i = 1; i < inputs.size(); ++i) {
      for (std::size_t j = i + 1; j < inputs.size(); ++j) {
        if (inputs[i].sha256 == inputs[j].sha256) {
          throw std::invalid_argument(
              fmt::format("{}: is the same trial as {}", inputs[j].path, inputs[i].path));
        }
      }
    }
  }

  info::discover::Options engineOptions(bool isAngle) const {
    info::discover::Options options;
    if (noise_) options.outputDeviation = isAngle ? *noise_ / radian : *noise_;
    options.maxEffects = maxEffects_;
    for (std::size_t i = 0; i < heldOut_.size(); ++i) {
      options.heldOut.push_back(static_cast<int>(trials_.size() + i));
    }
    return options;
  }

  /// Surrogates are not added: they would hide what is unknown.
  static bool mayBeAdded(const info::discover::Verdict& verdict) {
    return verdict.reached == Stage::finished && !verdict.surrogate && !verdict.effects.empty() &&
           verdict.finding != Finding::numerical;
  }

  static void tell(const DiscoverFindings& f, Summary& summary) {
    const auto& verdict = f.verdict;
    const double unit = f.isAngle ? radian : 1;
    summary.set("verdict", verdictWord(verdict));
    summary.set("noise", unit * verdict.outputDeviation);
    summary.set("noise_is", verdict.deviationEstimated ? "from the data" : "given");
    for (const auto& effect : verdict.effects) {
      const std::string id = f.data.candidates()[effect.candidate].id;
      nlohmann::ordered_json values;
      for (const auto& one : effect.estimates) {
        const auto& quantity = f.data.quantities()[one.quantity];
        values[quantity.name] = {
            {"value", one.value}, {"sd", one.deviation}, {"unit", quantity.unit}};
      }
      summary.set("effect." + id, values);
    }
    if (verdict.gap.closedFromCalibrated) {
      summary.set("gap_closed_train", *verdict.gap.closedFromCalibrated);
    }
    if (verdict.heldOut && verdict.heldOut->closedFromCalibrated) {
      summary.set("gap_closed_held_out", *verdict.heldOut->closedFromCalibrated);
    }
    summary.set("fits", verdict.fits);
    summary.set("next_experiment", f.nextExperiment);
  }

  /// Writes the model with the effects, and the trials where EMG or sensor were at fault.
  void addTo(const bio::Model& model, const bio::ArmOptions& arm, const std::string& coordinate,
             const std::vector<bio::Trial>& trials, const DiscoverFindings& f,
             const Summary& summary, OutputFolder& folder) const {
    std::vector<bio::discover::EffectToAdd> effects;
    for (const auto& found : f.verdict.effects) {
      const auto& candidate = f.data.candidates()[found.candidate];
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
      effect.probability = f.verdict.vetoed ? 0 : found.probability;
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
        bio::writeTable(drivenTable(corrected(trials[i], coordinate, added.sensor),
                                    f.data.widest().arm(), added.mapping),
                        path);
      });
    }
  }

  static bool concernsTrials(const bio::discover::Augmented& added) {
    const bio::EmgMapping& m = added.mapping;
    const bio::discover::SensorLaw& s = added.sensor;
    return !m.gain.empty() || m.delay != 0 || m.nonlinearity != 0 || !m.offset.empty() ||
           !m.crosstalk.empty() || s.bias != 0 || s.gain != 0 || s.clock != 0;
  }

  /// The trial as a true sensor would have measured it: q(t) = (y(t + clock) − bias)/(1 + gain).
  static bio::Trial corrected(bio::Trial trial, const std::string& coordinate,
                              const bio::discover::SensorLaw& sensor) {
    for (bio::MeasuredMotion& motion : trial.measured) {
      if (motion.coordinate != coordinate) continue;
      motion.values = (motion.values.array() - sensor.bias) / (1 + sensor.gain);
      if (sensor.clock == 0) continue;
      // samples move to their own time; what falls out of the trial is not measured
      std::vector<double> times, values;
      for (Eigen::Index i = 0; i < motion.times.size(); ++i) {
        const double t = motion.times[i] - sensor.clock;
        if (t < trial.times[0] || t > trial.times[trial.times.size() - 1]) continue;
        times.push_back(t);
        values.push_back(motion.values[i]);
      }
      const auto n = static_cast<Eigen::Index>(times.size());
      motion.times = Eigen::VectorXd::Map(times.data(), n);
      motion.values = Eigen::VectorXd::Map(values.data(), n);
    }
    return trial;
  }

  std::string model_;
  std::vector<std::string> trials_, heldOut_, without_;
  std::optional<double> noise_;
  int maxEffects_ = 3;
  SimulationOptions simulation_;
};

}  // namespace

std::unique_ptr<Command> discoverCommand() {
  return std::make_unique<Discover>();
}

}  // namespace app
