#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "bio/model/units.h"
#include "design/dynamometer_design.h"
#include "output/text.h"

namespace app {
namespace {

using Eigen::Index;
namespace course = bio::dynamometer;

bool measuresAngles(const bio::DynamometerPlan& plan) {
  return std::any_of(
      plan.chosen.begin(), plan.chosen.end(),
      [](const bio::DynamometerExperiment& experiment) { return experiment.measuresAngle(); });
}

/// ", of 0.5 deg of the angle", if it is measured.
std::string angleNoiseOf(const bio::DynamometerPlan& plan, const bio::DynamometerQuestion& question,
                         bool turns) {
  if (!measuresAngles(plan)) return "";
  return turns ? fmt::format(", of {:g} deg of the angle",
                             question.angleNoise * bio::degreesPerRadian)
               : fmt::format(", of {:g} mm of the shift", question.angleNoise * 1000);
}

}  // namespace

void tellDynamometer(const bio::DynamometerPlan& plan, bool turns, Summary& summary) {
  const double unit = turns ? bio::degreesPerRadian : 1;
  nlohmann::ordered_json before = nlohmann::ordered_json::object(), now = before;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < plan.parameters.size(); ++i) {
    before[plan.parameters[i].name] = plan.parameters[i].sd;
    now[plan.parameters[i].name] = plan.bounds.back()[static_cast<Index>(i)];
  }
  for (std::size_t n = 0; n < plan.chosen.size(); ++n) {
    const bio::DynamometerExperiment& experiment = plan.chosen[n];
    nlohmann::ordered_json bounds = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < plan.parameters.size(); ++i) {
      bounds[plan.parameters[i].name] = plan.bounds[n][static_cast<Index>(i)];
    }
    const char* suffix = turns ? "_deg" : "_m";
    list.push_back({{"kind", bio::name(experiment.kind)},
                    {fmt::format("from{}", suffix), experiment.from * unit},
                    {fmt::format("to{}", suffix), experiment.to * unit},
                    {fmt::format("speed{}_per_s", suffix), experiment.speed * unit},
                    {"muscles", experiment.group},
                    {"effort_percent", 100 * experiment.effort},
                    {"load_percent", 100 * experiment.load},
                    {turns ? "torque_Nm" : "force_N", experiment.torque},
                    {"instruction", bio::instructionOf(experiment, turns)},
                    {"information_nats", plan.information[n]},
                    {"bounds", bounds}});
  }
  summary.set("bound_before", before);
  summary.set("bound_after", now);
  summary.set("experiments", list);
  summary.set("candidates", plan.candidates);
  summary.set("candidates_not_simulated", plan.failed);
  summary.set("candidates_unsuitable", plan.unsuitable);
}

Report dynamometerReport(const bio::DynamometerPlan& plan, const bio::DynamometerQuestion& question,
                         bool turns) {
  Report report;
  report.title = fmt::format("Experiments on a dynamometer: {}", question.coordinate);
  std::vector<std::string> changes;
  for (std::size_t i = 0; i < plan.parameters.size(); ++i) {
    const bio::ModelParameter& parameter = plan.parameters[i];
    changes.push_back(
        fmt::format("{} from ± {} to ± {}", parameter.name, numberText(parameter.sd, 3),
                    withUnit(plan.bounds.back()[static_cast<Index>(i)], parameter.unit, 3)));
  }
  report.verdict = fmt::format("{} experiments of {} are expected to bring {}.", plan.chosen.size(),
                               plan.candidates, fmt::join(changes, ", "));
  report.details.emplace_back(
      Section{"Experiments",
              "In the order in which to do them: each adds most to what those before it tell. "
              "Bounds are standard deviations after it and all before it."});
  Table table{"", {"", "instruction", "adds [nats]"}, {}};
  for (const bio::ModelParameter& parameter : plan.parameters) {
    table.columns.push_back(fmt::format("± {} [{}]", parameter.name, unitText(parameter.unit)));
  }
  for (std::size_t n = 0; n < plan.chosen.size(); ++n) {
    std::vector<std::string> row = {fmt::format("{}", n + 1),
                                    bio::instructionOf(plan.chosen[n], turns),
                                    numberText(plan.information[n], 3)};
    for (const double bound : plan.bounds[n]) row.push_back(numberText(bound, 3));
    table.rows.push_back(std::move(row));
  }
  report.details.emplace_back(std::move(table));
  report.details.emplace_back(Paragraph{fmt::format(
      "Bounds are the Cramér–Rao bounds of all that was done up to there, with the parameters' "
      "default priors (as of --nuisance), if nothing else is unknown, and a noise (independent "
      "samples) of {:g} {} of the moment{}. % MVC is the "
      "excitation: EMG over that of a maximum contraction. The antagonists are taken to rest; "
      "record them, too. experiment_N.csv are the experiments as trials: to be filled with what "
      "was recorded, {}.moment above all.",
      question.noise, turns ? "N m" : "N", angleNoiseOf(plan, question, turns),
      question.coordinate)});
  if (measuresAngles(plan)) {
    report.details.emplace_back(Paragraph{fmt::format(
        "The trial of an isotonic contraction begins when the joint is let go, with the torque in "
        "{0}.{1}. Its column {0}{2} holds the predicted motion: replace it by the recorded one. "
        "The device's own inertia, if it is not compensated, has to be part of the model.",
        question.coordinate, turns ? "torque" : "force", turns ? "_deg" : "")});
  }
  if (plan.unsuitable > 0) {
    report.details.emplace_back(Paragraph{fmt::format(
        "{} of the experiments were left out: quick releases that would leave the coordinate's "
        "range, isotonic contractions that do not carry the limb, or that would be at the end of "
        "the range or faster than --speed within {:g} s.",
        plan.unsuitable, course::shortestIsotonic)});
  }
  return report;
}

}  // namespace app
