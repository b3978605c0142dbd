#include "design/separating_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/angle_unit.h"
#include "output/json_text.h"
#include "output/text.h"

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

  Figure angles() const {
    const bio::DesignLimits& limits = f_.design.inputs().limits();
    const auto& q = f_.design.question();
    Figure figure{.title = fmt::format("Predicted {}", f_.coordinate.name),
                  .xLabel = "Time [s]",
                  .yLabel = fmt::format("{} [deg]", f_.coordinate.name),
                  .caption = fmt::format(
                      "The designed experiment with {} and with {}, at the model's own parameters. "
                      "Limits: {} to {} deg.",
                      sized(f_.design.first().name, q.firstSize, f_.design.unitOfFirst()),
                      sized(f_.design.second().name, q.secondSize, f_.design.unitOfSecond()),
                      numberText(limits.lower * radian), numberText(limits.upper * radian))};
    const SeparatingExperiment& e = f_.result.after;
    figure.series.push_back({.name = "neither", .x = times_, .y = asList(e.base * radian)});
    figure.series.push_back(
        {.name = f_.design.first().name, .x = times_, .y = asList(e.first * radian)});
    figure.series.push_back(
        {.name = f_.design.second().name, .x = times_, .y = asList(e.second * radian)});
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
    const SeparatingExperiment& e = f_.result.after;
    const bio::DesignInputs& inputs = f_.design.inputs();
    const bio::DesignLimits& limits = inputs.limits();
    Table table{"Limits", {"quantity", "designed", "limit", "unit"}, {}};
    if (inputs.hasTorque()) {
      table.rows.push_back(
          {"largest torque", numberText(largestTorque()), numberText(limits.torque), "N·m"});
      table.rows.push_back({"largest torque rate", numberText(inputs.largestTorqueRate(e.trial)),
                            numberText(limits.torqueRate), "N·m/s"});
    }
    if (!inputs.groups().empty()) {
      table.rows.push_back({"largest excitation rate",
                            numberText(inputs.largestExcitationRate(e.trial)),
                            numberText(limits.excitationRate), "1/s"});
    }
    table.rows.push_back(
        {"lowest angle", numberText(e.lowest * radian), numberText(limits.lower * radian), "deg"});
    table.rows.push_back({"highest angle", numberText(e.highest * radian),
                          numberText(limits.upper * radian), "deg"});
    table.rows.push_back({"largest speed", numberText(e.fastest * radian),
                          numberText(limits.speed * radian), "deg/s"});
    return table;
  }

  Figure torque() const {
    Figure figure{.title = "External torque",
                  .xLabel = "Time [s]",
                  .yLabel = fmt::format("Torque on {} [N·m]", f_.coordinate.name),
                  .caption = ""};
    addBoth(figure, [&](const bio::Trial& trial) { return f_.design.inputs().torqueOf(trial); });
    return figure;
  }

  Figure excitation(const bio::MuscleGroup& group) const {
    Figure figure{
        .title = fmt::format("Excitation of {}", group.name),
        .xLabel = "Time [s]",
        .yLabel = "Excitation",
        .caption = fmt::format(
            "Muscles with this excitation: {}. The dashed line is the baseline excitation of {}.",
            fmt::join(group.muscles, ", "), group.muscles.front())};
    addBoth(figure, [&](const bio::Trial& trial) {
      const auto at = std::find(trial.muscles.begin(), trial.muscles.end(), group.muscles.front());
      return VectorXd(trial.excitations.col(at - trial.muscles.begin()));
    });
    return figure;
  }

  Figure search() const {
    Figure figure{.title = "Progress of the search",
                  .xLabel = "Experiments simulated",
                  .yLabel = "Smaller log Bayes factor [nats]",
                  .caption = "Best experiment so far that respects every limit."};
    Series series{.name = "best", .x = {0}, .y = {f_.result.before.tells.least()}};
    for (std::size_t i = 0; i < f_.result.nats.size(); ++i) {
      series.x.push_back(f_.result.foundAt[i]);
      series.y.push_back(f_.result.nats[i]);
    }
    figure.series.push_back(std::move(series));
    return figure;
  }

  double largestTorque() const {
    return f_.design.inputs().torqueOf(f_.result.after.trial).cwiseAbs().maxCoeff();
  }

 private:
  template <class Column>
  void addBoth(Figure& figure, const Column& column) const {
    for (const auto& [name, e, style] :
         {std::tuple{"designed", &f_.result.after, SeriesStyle::line},
          std::tuple{"before", &f_.result.before, SeriesStyle::dashed}}) {
      figure.series.push_back({.name = name,
                               .x = asList(e->trial.times),
                               .y = asList(column(e->trial)),
                               .style = style});
    }
  }

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
  summary.set("noise_deg", q.noise * radian);
  summary.set("rate_Hz", 1 / q.period);
  if (f.design.inputs().hasTorque()) {
    summary.set("largest_torque_Nm", Writing(f).largestTorque());
  }
  const SeparatingExperiment& e = f.result.after;
  summary.set("lowest_deg", e.lowest * radian);
  summary.set("highest_deg", e.highest * radian);
  summary.set("largest_speed_deg_per_s", e.fastest * radian);
  summary.set("simulations", f.result.runs);
  summary.set("impossible_simulations", f.result.impossible);
}

Report separatingReport(const SeparatingFindings& f) {
  const Writing writing(f);
  Report report;
  report.title = fmt::format("Experiment that discriminates {} from {} on {}",
                             f.design.first().name, f.design.second().name, f.modelFile);
  report.verdict = writing.verdict();
  report.mainFigure = writing.angles();
  report.details.push_back(writing.telling());
  report.details.push_back(Paragraph{fmt::format(
      "The nats are the expected natural logarithm of the Bayes factor of the effect that is "
      "present against the other one (5 nats are odds of about 150:1), with one measured angle "
      "every {} s and noise of {} deg, every parameter of the model being uncertain by its default "
      "prior and the size of the other effect being free. They are computed to first order about "
      "the model's own parameters and do not consider effects outside the catalogue.",
      numberText(f.design.question().period), numberText(f.design.question().noise * radian))});
  if (f.design.inputs().hasTorque()) report.details.push_back(writing.torque());
  for (const bio::MuscleGroup& group : f.design.inputs().groups()) {
    report.details.push_back(writing.excitation(group));
  }
  report.details.push_back(writing.limits());
  report.details.push_back(writing.search());
  report.details.push_back(
      Paragraph{fmt::format("{} experiments were simulated, {} of which did not reach the end. "
                            "design.sto holds the inputs and the motion of the unchanged model. "
                            "After recording the experiment, run `fisherhill discover` on it.",
                            f.result.runs, f.result.impossible)});
  return report;
}

}  // namespace app
