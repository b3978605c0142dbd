#include "design/separating_report.h"

#include <fmt/format.h>

#include "design/planned_figures.h"
#include "output/json_text.h"
#include "output/text.h"
#include "playback/replayed_trials.h"

namespace app {
namespace {

using bio::discover::SeparatingExperiment;
using Eigen::Index;
using Eigen::VectorXd;
using Json = nlohmann::ordered_json;

constexpr double enoughNats = 5;  ///< discovery's own rule for a name

std::string sized(const std::string& name, double size, const std::string& unit) {
  return fmt::format("{} of {}{}{}", name, numberText(size, 3), unit.empty() ? "" : " ", unit);
}

class Writing {
 public:
  explicit Writing(const SeparatingFindings& f)
      : f_(f), times_(f.design.inputs().measuredTimes()) {}

  std::string verdict() const {
    const std::string& one = f_.design.first().name;
    const std::string& other = f_.design.second().name;
    const char* stopped =
        f_.result.stopped ? "Stopped early; this is the best experiment so far. " : "";
    if (!f_.result.improved) {
      return fmt::format(
          "{}No experiment was found that discriminates {} from {} better than {} and respects the "
          "limits.",
          stopped, one, other, f_.trialFile);
    }
    const double before = f_.result.before.tells.least(), after = f_.result.after.tells.least();
    return fmt::format(
        "{}The designed experiment is expected to discriminate {} from {} with a log Bayes factor "
        "of at least {} nats; {} gives {}{}.",
        stopped, one, other, numberText(after, 4), f_.trialFile, numberText(before, 4),
        after < enoughNats ? fmt::format("; discover requires {} nats to name an effect, so the "
                                         "experiment has to be repeated",
                                         numberText(enoughNats))
                           : "");
  }

  PlannedInputs planned() const {
    return {f_.model, f_.design.inputs(), f_.result.before.trial, f_.result.after.trial};
  }

  Figure predicted(std::size_t observed) const {
    const bio::Observable& what = f_.design.question().observed[observed].what;
    const auto& q = f_.design.question();
    Figure figure = predictionFigure(
        planned(), what,
        fmt::format("The designed experiment with {} and with {}, at the model's own parameters.",
                    sized(f_.design.first().name, q.firstSize, f_.design.unitOfFirst()),
                    sized(f_.design.second().name, q.secondSize, f_.design.unitOfSecond())));
    const SeparatingExperiment& e = f_.result.after;
    const double factor = shownUnit(bio::unitOf(what, f_.model)).factor;
    const auto add = [&](const std::string& name, const Eigen::MatrixXd& values) {
      figure.series.push_back(
          {.name = name,
           .x = times_,
           .y = asList(VectorXd(values.col(static_cast<Index>(observed)) * factor))});
    };
    add("neither", e.base);
    add(f_.design.first().name, e.first);
    add(f_.design.second().name, e.second);
    return figure;
  }

  Table telling() const {
    Table table{"Expected log Bayes factors",
                {"if the effect is", "with size", "unit", "nats before", "nats after",
                 "sd of size before", "sd of size after"},
                {}};
    const auto& before = f_.result.before.tells;
    const auto& after = f_.result.after.tells;
    const auto& q = f_.design.question();
    table.rows.push_back(
        {f_.design.first().name, numberText(q.firstSize, 3), f_.design.unitOfFirst(),
         numberText(before.firstOverSecond, 3), numberText(after.firstOverSecond, 3),
         numberText(before.firstDeviation, 3), numberText(after.firstDeviation, 3)});
    table.rows.push_back(
        {f_.design.second().name, numberText(q.secondSize, 3), f_.design.unitOfSecond(),
         numberText(before.secondOverFirst, 3), numberText(after.secondOverFirst, 3),
         numberText(before.secondDeviation, 3), numberText(after.secondDeviation, 3)});
    return table;
  }

  Table limits() const {
    Table table = limitTable(planned());
    const auto& all = f_.design.inputs().limits().coordinates;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::string& name = all[i].coordinate;
      const bio::MotionExtremes& range = f_.result.after.ranges[i];
      const bio::ShownUnit unit = planned().unitOf(name);
      addLimit(table, "lowest " + name, range.lowest, all[i].lower, unit);
      addLimit(table, "highest " + name, range.highest, all[i].upper, unit);
      addLimit(table, "largest speed of " + name, range.fastest, all[i].speed,
               {unit.factor, unit.name + "/s"});
    }
    return table;
  }

 private:
  const SeparatingFindings& f_;
  const std::vector<double>& times_;
};

}  // namespace

void tellSeparation(const SeparatingFindings& f, Summary& summary) {
  const auto& q = f.design.question();
  const auto& before = f.result.before.tells;
  const auto& after = f.result.after.tells;
  const auto both = [&](double first, double second) {
    return Json{{q.first, orNull(first)}, {q.second, orNull(second)}};
  };
  summary.set("separates", Json{q.first, q.second});
  summary.set("size", both(q.firstSize, q.secondSize));
  summary.set("unit", Json{{q.first, f.design.unitOfFirst()}, {q.second, f.design.unitOfSecond()}});
  summary.set("improved", f.result.improved);
  summary.set("stopped", f.result.stopped);
  summary.set("nats_before", both(before.firstOverSecond, before.secondOverFirst));
  summary.set("nats_after", both(after.firstOverSecond, after.secondOverFirst));
  summary.set("bound_before", both(before.firstDeviation, before.secondDeviation));
  summary.set("bound_after", both(after.firstDeviation, after.secondDeviation));
  tellPlan(Writing(f).planned(), q.observed, q.period, f.result.after.ranges, f.result, summary);
}

std::optional<Playback> separatingPlayback(const SeparatingFindings& f,
                                           const bio::SystemOptions& system,
                                           const bio::SimulationOptions& simulation) {
  ReplayedTrials replayed(system, simulation);
  bio::Trial designed = f.result.after.trial;
  designed.measured.clear();  // they are predictions
  replayed.beginTrial("design.sto", designed);
  const ReplayedTrials::Setting setting{.step = simulation.step,
                                        .given = f.design.question().start};
  replayed.add("designed", f.model, designed, setting);
  replayed.add("of the trial given", f.model, f.result.before.trial, setting);
  return replayed.playback("The motion in three dimensions, without either effect");
}

Report separatingReport(const SeparatingFindings& f) {
  const Writing writing(f);
  Report report;
  report.title = fmt::format("Experiment that discriminates {} from {} on {}",
                             f.design.first().name, f.design.second().name, f.modelFile);
  report.verdict = writing.verdict();
  report.mainFigure = writing.predicted(0);
  if (f.playback) report.details.push_back(*f.playback);
  report.details.push_back(
      Section{"What the experiment tells",
              "How clearly the trial given and the designed experiment discriminate between the "
              "effects; more nats are better."});
  report.details.push_back(writing.telling());
  report.details.push_back(Paragraph{fmt::format(
      "The nats are the expected natural logarithm of the Bayes factor of the effect that is "
      "present against the other one (5 nats are odds of about 150:1), with {}, every parameter "
      "of the model being uncertain by its default prior and the size of the other effect being "
      "free. They are computed to first order about "
      "the model's own parameters and do not consider effects outside the catalogue.",
      measurementText(f.design.question().observed, f.design.question().period, f.model))});
  addFurther(
      f.design.question().observed.size(), [&](std::size_t o) { return writing.predicted(o); },
      report);
  addInputFigures(writing.planned(), report);
  addLimits(writing.limits(), report);
  addSearch(f.result, f.result.before.tells.least(), -1, "Smaller log Bayes factor [nats]", report);
  report.details.push_back(
      Paragraph{fmt::format("{} experiments were simulated, {} of which did not reach the end. "
                            "design.sto holds the inputs and the motion of the unchanged model. "
                            "After recording the experiment, run `fisherhill discover` on it.",
                            f.result.runs, f.result.impossible)});
  return report;
}

}  // namespace app
