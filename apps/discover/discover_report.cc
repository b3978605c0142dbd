#include "discover/discover_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "discover/discover_fit_report.h"
#include "discover/discover_unknown_report.h"
#include "discover/discover_where_report.h"
#include "discover/excess_error_text.h"
#include "discover/written_discovery.h"
#include "info/discovery/judgement/separation.h"
#include "options/excitation_figure.h"
#include "output/text.h"
#include "report/interval_drawing.h"

namespace app {
namespace {

using info::discover::Estimate;
using info::discover::ExcessError;

/// Writes the parts of one report.
class Writer {
 public:
  explicit Writer(const DiscoverFindings& f) : f_(f) {}

  Report write() {
    report_.title = fmt::format("Missing effects of {}", f_.modelFile);
    report_.verdict = f_.verdict.sentence;
    for (const auto& effect : f_.verdict.effects) {
      const Estimate& amplitude = effect.estimates.front();
      const auto& quantity = f_.data.quantities()[amplitude.quantity];
      report_.verdict +=
          fmt::format(" {} = {} ± {}.", quantity.name, numberText(amplitude.value, 3),
                      withUnit(amplitude.sd, quantity.unit, 2));
    }
    const bool excessOfHeldOut = f_.verdict.heldOut.has_value();
    const ExcessError& excess = excessOfHeldOut ? *f_.verdict.heldOut : f_.verdict.excess;
    if (excess.closedFromCalibrated && !f_.verdict.effects.empty()) {
      report_.verdict += " " + excessErrorWords(excess, f_.wording.unit,
                                                symbolOf(f_.wording.errorUnit), excessOfHeldOut);
    }
    const int first = f_.options.heldOut.empty() ? 0 : f_.options.heldOut.front();
    bool hasMain = false;
    for (int t = 0; t < f_.data.numTrials(); ++t) {
      for (std::size_t output = 0; output < f_.wording.outputs.size(); ++output) {
        Figure figure = motionFigure(f_, t, output);
        if (figure.series.empty()) continue;
        if (t == first && !hasMain) {
          hasMain = true;
          report_.mainFigure = std::move(figure);
        } else if (t == first) {
          report_.details.emplace_back(std::move(figure));
        } else {
          (isHeldOut(t) ? heldOut_ : others_).push_back(std::move(figure));
        }
      }
    }
    if (f_.playback) report_.details.emplace_back(*f_.playback);
    heldOut();
    effects();
    if (!f_.verdict.finalists.empty()) evidence();
    for (ReportPart& part : whereTheyDisagree(f_)) report_.details.push_back(std::move(part));
    // stopped before there was a base model?
    if (f_.verdict.base.size() > 0) {
      section("How well it fits",
              "Errors of the model before and after, and tests of what is left.");
      if (!std::isnan(f_.verdict.excess.floor) && !isTold_)
        report_.details.emplace_back(excessErrorTable(f_));
      if (f_.wording.isInNoise()) report_.details.emplace_back(outputErrorTable(f_));
      report_.details.emplace_back(adequacyTable(f_));
      for (ReportPart& part : withoutName(f_)) report_.details.push_back(std::move(part));
      parameters();
    }
    detectability();
    section("Next experiment", "What would tell apart what these data leave open.");
    say(f_.nextExperiment);
    if (!f_.predictedExperiments.empty()) report_.details.emplace_back(predictedExperimentTable());
    reproduce();
    addExcitations(f_.excitations, report_);
    if (!others_.empty()) {
      section("Other trials", "Measured and simulated, as above.");
      for (Figure& figure : others_) report_.details.emplace_back(std::move(figure));
    }
    return std::move(report_);
  }

 private:
  const info::discover::Candidate& candidate(std::size_t c) const {
    return f_.data.candidates()[c];
  }
  bool isHeldOut(int trial) const {
    const std::vector<int>& list = f_.options.heldOut;
    return std::find(list.begin(), list.end(), trial) != list.end();
  }
  void section(const std::string& title, const std::string& context = "") {
    report_.details.emplace_back(Section{title, context});
  }
  void say(const std::string& text) { report_.details.emplace_back(Paragraph{text}); }

  /// Trials that were not fitted are the better judges, so they come first.
  void heldOut() {
    if (f_.options.heldOut.empty() || f_.verdict.base.size() == 0) return;
    isTold_ = !std::isnan(f_.verdict.excess.floor);
    if (!isTold_ && heldOut_.empty()) return;
    section("Held-out trials",
            "Trials that were not fitted: how well the model predicts them before and after.");
    if (isTold_) report_.details.emplace_back(excessErrorTable(f_));
    for (Figure& figure : heldOut_) report_.details.emplace_back(std::move(figure));
  }

  void effects() {
    const auto& verdict = f_.verdict;
    if (verdict.effects.empty()) return;
    section(verdict.surrogate ? "Closest match in the catalogue" : "Missing effects",
            "The forces or errors that the model lacks, with their sizes and how sure they are.");
    Table table{"",
                {"effect", "parameter", "unit", "estimate", "± sd", "log Bayes factor [nats]",
                 "probability"},
                {}};
    for (const auto& effect : verdict.effects) {
      bool first = true;
      for (const Estimate& estimate : effect.estimates) {
        const auto& quantity = f_.data.quantities()[estimate.quantity];
        table.rows.push_back({first ? candidate(effect.candidate).name : "", quantity.name,
                              quantity.unit, numberText(estimate.value), numberText(estimate.sd, 2),
                              first ? numberText(effect.logBayesFactor) : "",
                              first && !verdict.vetoed ? numberText(effect.probability, 3) : "–"});
        first = false;
      }
    }
    report_.details.emplace_back(std::move(table));
    for (std::size_t i = 0; i < verdict.effects.size(); ++i) {
      const auto& effect = verdict.effects[i];
      say(candidate(effect.candidate).sentence);
      if (const std::string size = sizeOf(i); !size.empty()) say(size);
      if (effect.equals.size() < 2) continue;
      std::string list;
      for (const std::size_t c : effect.equals) {
        list += (list.empty() ? "" : ", ") + candidate(c).name;
      }
      say(fmt::format("These data cannot distinguish: {}{}.", list,
                      effect.exact
                          ? " (some of them have the same effect on everything that was measured)"
                          : ""));
    }
    if (verdict.vetoed) {
      if (verdict.remainder)
        say("The residual of the fitted trials is not noise alone, so no probability is given: the "
            "effects are named because they carry over to the held-out trials.");
      else if (verdict.finding == info::discover::Finding::numerical)
        say("The time steps are too long for a conclusion, so no probability is given.");
      else if (!verdict.after.sized)
        say("The size of the residual does not match the noise, so no probability is given.");
      else if (verdict.heldOut && verdict.heldOut->isVague(f_.options.vague))
        say("The held-out trials are hardly predicted, so no probability is given.");
      else
        say("The held-out errors are larger than the uncertainty of the parameters explains, so no "
            "probability is given.");
    }
  }

  /// The moments of an effect on several coordinates.
  std::string momentsOf(const bio::discover::EffectSize& size, const std::string& motion) const {
    std::string list, moved;
    for (const ShownAxis& axis : f_.wording.axes) {
      const bio::discover::EffectMoment& moment = size.moments.at(axis.place);
      if (moment.motionRms > 0)  // else it is prescribed
        moved += fmt::format("{}{} by {}", moved.empty() ? "" : ", ", axis.name,
                             withUnit(axis.scale * moment.motionRms, axis.unit, 2));
      if (!(moment.rms > 0)) continue;
      list += fmt::format("{}{} on {} ({} % of the muscles')", list.empty() ? "" : ", ",
                          withUnit(moment.rms, axis.forceUnit, 2), axis.name,
                          numberText(100 * moment.share, 2));
    }
    std::string text =
        fmt::format("On {} its moment (RMS) is {}.", motion, list.empty() ? "0" : list);
    if (!moved.empty())
      text += fmt::format(" Leaving it out changes the simulated motion (RMS): {}.", moved);
    return text;
  }

  /// Size of an effect in the motion shown; "" where that is not known.
  std::string sizeOf(std::size_t effect) const {
    if (!f_.written || effect >= f_.written->sizes.size()) return "";
    const bio::discover::EffectSize& size = f_.written->sizes[effect];
    const std::string motion = f_.data.trialName(f_.written->shown);
    const ShownAxis& axis = f_.wording.axes.front();
    const std::string moved = withUnit(axis.scale * size.motionRms, axis.unit, 2);
    if (std::isnan(size.motionRms)) return "";
    if (f_.wording.axes.size() > 1 && !size.moments.empty()) return momentsOf(size, motion);
    if (std::isnan(size.moment.rms)) {
      return candidate(f_.verdict.effects[effect].candidate).kind ==
                     info::discover::EffectKind::sensor
                 ? fmt::format("On {} it shifts the sensor's reading by {} (RMS).", motion, moved)
                 : "";
    }
    std::string text = fmt::format(
        "On {0} its {1} is {2} (RMS; largest {3}), which is {4} % of the muscles' net {1}.", motion,
        axis.isTorque ? "moment" : "force", withUnit(size.moment.rms, axis.forceUnit, 2),
        withUnit(size.moment.peak, axis.forceUnit, 2), numberText(100 * size.moment.share, 2));
    if (size.motionRms > 0)  // else it is prescribed
      text += fmt::format(" Leaving it out changes the simulated motion by {} (RMS).", moved);
    return text;
  }

  /// Each trial's figures, and the commands that make them.
  void reproduce() {
    if (!f_.written || f_.written->trials.empty()) return;
    section("Reproduce",
            "The written model simulated by other commands, and the errors that they report.");
    const std::string& unit = f_.wording.errorUnit;
    const auto figure = [&](double value) { return numberText(f_.wording.unit * value); };
    Table errors{"RMS error (measured − simulated), as replay reports it",
                 {"trial", "role", "original model [" + unit + "]",
                  "with all fitted parameters [" + unit + "]", "noise [" + unit + "]", "replayed"},
                 {}};
    for (const bio::discover::RepairedTrial& trial : f_.written->trials) {
      const std::size_t i = trial.index;
      errors.rows.push_back({f_.trialFiles[i], trial.isHeldOut ? "held out" : "fitted",
                             figure(trial.nominal), figure(trial.after), figure(trial.floor),
                             f_.written->model.empty() ? "–" : f_.written->replayFiles[i]});
    }
    report_.details.emplace_back(std::move(errors));
    Table commands{"", {"figure", "command"}, {}};
    for (const auto& [what, command] : f_.written->commands)
      commands.rows.push_back({what, command});
    report_.details.emplace_back(std::move(commands));
    if (f_.written->model.empty()) return;
    say(
        fmt::format("{} holds every value of parameters.csv, the initial state of each of these "
                    "trials, and the time step. The other RMS errors of this report belong to fits "
                    "that only this command makes.",
                    f_.written->model));
    if (f_.written->trials.front().driven) {
      say(f_.written->trialsAreCut
              ? "The trials were cut where they first pass the position at which the model fails: "
                "the driven trials (driven_*.sto) end there. They hold the excitations that the "
                "muscles received and the recording without errors of the sensor."
          : !f_.data.inputNames().empty()
              ? "The excitations or the recording were corrected: the driven trials (driven_*.sto) "
                "hold the excitations that the muscles received and the corrected recording, which "
                "shows the motion itself."
              : "The commands or the recording were corrected: the driven trials (driven_*.sto) "
                "hold the torques and forces that acted and the corrected recording, which shows "
                "the motion itself.");
    }
  }

  /// All that were raced, as bars.
  void evidence() {
    section("Evidence",
            "How much better each hypothesis explains the data than the base model does.");
    std::vector<IntervalRow> rows;
    std::vector<std::vector<std::string>> cells;
    for (const auto& finalist : f_.verdict.finalists) {
      if (rows.size() >= 20) break;
      std::string kind = finalist.effects.empty()
                             ? "–"
                             : info::discover::name(candidate(finalist.effects.front()).kind);
      const std::string name = info::discover::describe(f_.data, finalist.effects);
      rows.push_back({.name = fmt::format("{} ({})", name, kind),
                      .estimate = finalist.logEvidence,
                      .interval = std::pair(0.0, finalist.logEvidence)});
    }
    report_.details.emplace_back(VectorDrawing{
        "All hypotheses compared",
        intervalDrawing(rows, "Log Bayes factor against the base model [nats]"),
        fmt::format(
            "Natural logarithm of the Bayes factor; 5 nats are odds of about 150:1. Every "
            "parameter of the model is refitted for each hypothesis. An effect is named if it adds "
            "{} nats or more; effects within {} nats of it cannot be distinguished from it.",
            f_.options.evidence, f_.options.classWidth)});
    if (const std::string behind = namesAgainstForces(f_); !behind.empty()) say(behind);
  }

  Table predictedExperimentTable() const {
    Table table{"Expected log Bayes factors of further experiments", {"experiment"}, {}};
    for (std::size_t i = 1; i < f_.verdict.rivals.size(); ++i)
      table.columns.push_back(fmt::format("{} against {} [nats]", rivalName(f_.data, f_.verdict, 0),
                                          rivalName(f_.data, f_.verdict, i)));
    for (const bio::discover::PredictedExperiment& experiment : f_.predictedExperiments) {
      std::vector<std::string> row{experiment.sentence};
      for (const double nats : experiment.nats) row.push_back(numberText(nats, 2));
      table.rows.push_back(std::move(row));
    }
    return table;
  }

  void parameters() {
    const auto& list = f_.verdict.nuisancesAfter;
    if (list.empty()) return;
    section("Parameters", "Values of the model that were fitted together with the effects.");
    std::vector<IntervalRow> rows;
    for (const Estimate& estimate : list) {
      const auto& quantity = f_.data.quantities()[estimate.quantity];
      const double scale =
          quantity.logarithmic ? quantity.sd * std::max(estimate.value, 1e-300) : quantity.sd;
      const double half = 1.96 * estimate.sd / scale;
      rows.push_back({.name = quantity.name,
                      .estimate = estimate.priorZ,
                      .interval = std::pair(estimate.priorZ - half, estimate.priorZ + half),
                      .before = std::pair(-1.96, 1.96)});
    }
    report_.details.emplace_back(
        VectorDrawing{"Fitted parameters of the model",
                      intervalDrawing(rows, "Difference from the model's value [prior sd]"),
                      fmt::format("95 % intervals. A parameter beyond ±{} prior standard "
                                  "deviations counts as a parameter error.",
                                  f_.options.largestPriorZ)});
  }

  void detectability() {
    if (f_.verdict.detectability.empty()) return;
    section("Smallest detectable effects",
            "What these trials could have shown, had it been there.");
    Table table{"", {"effect", "kind", "detectable from", "unit"}, {}};
    for (const auto& one : f_.verdict.detectability) {
      const auto& c = candidate(one.candidate);
      table.rows.push_back({c.name, info::discover::name(c.kind), numberText(one.amplitude, 2),
                            f_.data.quantities()[c.quantities.front()].unit});
    }
    report_.details.emplace_back(std::move(table));
    say("The size at which each effect would exceed five standard deviations, in addition to the "
        "effects found and with all parameters free.");
    for (const auto& [id, present] : f_.wording.present) {
      say(fmt::format("The model already has {} ({}), so it was not a candidate.", id, present));
    }
  }

  const DiscoverFindings& f_;
  Report report_;
  std::vector<Figure> heldOut_, others_;  ///< motions of all trials but the first
  bool isTold_ = false;                   ///< the table of excess errors
};

}  // namespace

Report discoverReport(const DiscoverFindings& findings) {
  return Writer(findings).write();
}

}  // namespace app