#include "design/planned_figures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "output/text.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::VectorXd;

template <class Column>
void addBoth(const PlannedInputs& planned, Figure& figure, const Column& column) {
  for (const auto& [name, trial, style] :
       {std::tuple{"designed", &planned.after, SeriesStyle::line},
        std::tuple{"before", &planned.before, SeriesStyle::dashed}}) {
    figure.series.push_back(
        {.name = name, .x = asList(trial->times), .y = asList(column(*trial)), .style = style});
  }
}

Figure torqueFigure(const PlannedInputs& planned, const bio::CoordinateLimits& limits) {
  const std::string unit = planned.torqueUnit(limits.coordinate);
  const char* word = planned.coordinate(limits.coordinate).isRotation ? "Torque" : "Force";
  Figure figure{
      .title = fmt::format("{} on {}", word, limits.coordinate),
      .xLabel = "Time [s]",
      .yLabel = fmt::format("{} on {} [{}]", word, limits.coordinate, unit),
      .caption = fmt::format("Limited to ±{0} {2} and {1} {2}/s.", numberText(limits.torque),
                             numberText(planned.inputs.limits().torqueRate), unit)};
  addBoth(planned, figure, [&](const bio::Trial& trial) {
    return planned.inputs.torqueOf(trial, limits.coordinate);
  });
  return figure;
}

Figure excitationFigure(const PlannedInputs& planned, const bio::MuscleGroup& group) {
  Figure figure{
      .title = fmt::format("Excitation of {}", group.name),
      .xLabel = "Time [s]",
      .yLabel = "Excitation [0 to 1]",
      .caption = fmt::format(
          "Muscles with this excitation: {}. The dashed line is the baseline excitation of {}.",
          fmt::join(group.muscles, ", "), group.muscles.front())};
  addBoth(planned, figure, [&](const bio::Trial& trial) {
    const auto at = std::find(trial.muscles.begin(), trial.muscles.end(), group.muscles.front());
    return VectorXd(trial.excitations.col(at - trial.muscles.begin()));
  });
  return figure;
}

}  // namespace

const bio::Coordinate& PlannedInputs::coordinate(const std::string& name) const {
  return bio::findCoordinate(model, name);
}

bio::ShownUnit PlannedInputs::unitOf(const std::string& name) const {
  return shownUnit(coordinate(name).isRotation ? "rad" : "m");
}

std::string PlannedInputs::torqueUnit(const std::string& name) const {
  return coordinate(name).isRotation ? "N m" : "N";
}

Figure predictionFigure(const PlannedInputs& planned, const bio::Observable& what,
                        const std::string& caption) {
  const std::string name = nameOf(what);
  const bio::ShownUnit unit = shownUnit(bio::unitOf(what, planned.model));
  Figure figure{.title = fmt::format("Predicted {}", name),
                .xLabel = "Time [s]",
                .yLabel = fmt::format("{} [{}]", name, unit.name),
                .caption = caption};
  for (const bio::CoordinateLimits& limits : planned.inputs.limits().coordinates) {
    if (what != bio::ofCoordinate(limits.coordinate)) continue;
    figure.caption += fmt::format("{}Limits: {} to {} {}.", caption.empty() ? "" : " ",
                                  numberText(limits.lower * unit.factor),
                                  numberText(limits.upper * unit.factor), unit.name);
  }
  return figure;
}

void addInputFigures(const PlannedInputs& planned, Report& report) {
  report.details.push_back(
      Section{"Designed inputs",
              "What is to be done to the limb, and how its muscles are to be driven; dashed lines "
              "are the trial given."});
  for (const bio::CoordinateLimits& limits : planned.inputs.torques()) {
    report.details.push_back(torqueFigure(planned, limits));
  }
  for (const bio::MuscleGroup& group : planned.inputs.groups()) {
    report.details.push_back(excitationFigure(planned, group));
  }
}

void addFurther(std::size_t count, const std::function<Figure(std::size_t)>& predicted,
                Report& report) {
  if (count < 2) return;
  report.details.push_back(
      Section{"Other predictions", "What else moves or is measured, as the first figure has it."});
  for (std::size_t i = 1; i < count; ++i) report.details.push_back(predicted(i));
}

void addLimits(Table table, Report& report) {
  report.details.push_back(
      Section{table.title,
              "The extremes of inputs and motion in the designed experiment, beside the limits "
              "that they had to respect."});
  table.title.clear();
  report.details.push_back(std::move(table));
}

void addLimit(Table& table, const std::string& quantity, double designed, double limit,
              const bio::ShownUnit& unit) {
  table.rows.push_back(
      {quantity, numberText(designed * unit.factor), numberText(limit * unit.factor), unit.name});
}

Table limitTable(const PlannedInputs& planned) {
  Table table{"Limits", {"quantity", "designed", "limit", "unit"}, {}};
  const bio::DesignInputs& inputs = planned.inputs;
  for (const bio::CoordinateLimits& limits : inputs.torques()) {
    const std::string& name = limits.coordinate;
    const std::string unit = planned.torqueUnit(name);
    addLimit(table, "largest torque on " + name, inputs.largestTorque(planned.after, name),
             limits.torque, {1, unit});
    addLimit(table, "its largest rate", inputs.largestTorqueRate(planned.after, name),
             inputs.limits().torqueRate, {1, unit + "/s"});
  }
  if (!inputs.groups().empty()) {
    addLimit(table, "largest excitation rate", inputs.largestExcitationRate(planned.after),
             inputs.limits().excitationRate, {1, "1/s"});
  }
  return table;
}

void addSearch(const bio::DesignSearchRecord& record, double before, double sign,
               const std::string& yLabel, Report& report) {
  report.details.push_back(
      Section{"Search",
              "How the best experiment improved as more were simulated; a curve that is flat at "
              "its end suggests that a longer search would find little more."});
  if (record.costs.empty()) {
    report.details.push_back(
        Paragraph{"No simulated experiment was better than the trial given and respected every "
                  "limit."});
    return;
  }
  Figure figure{.title = "Progress of the search",
                .xLabel = "Simulations",
                .yLabel = yLabel,
                .caption = "Best experiment so far that respects every limit."};
  Series series{.name = "best", .x = {0}, .y = {before}};
  for (std::size_t i = 0; i < record.costs.size(); ++i) {
    series.x.push_back(record.foundAt[i]);
    series.y.push_back(sign * record.costs[i]);
  }
  figure.series.push_back(std::move(series));
  report.details.push_back(std::move(figure));
}

void tellPlan(const PlannedInputs& planned, const std::vector<bio::ChannelCandidate>& observed,
              double period, const std::vector<bio::MotionExtremes>& motions,
              const bio::DesignSearchRecord& record, Summary& summary) {
  const bio::DesignInputs& inputs = planned.inputs;
  Json outputs = Json::array(), coordinates = Json::array();
  for (const bio::ChannelCandidate& candidate : observed) {
    const bio::ShownUnit unit = shownUnit(bio::unitOf(candidate.what, planned.model));
    outputs.push_back({{"name", nameOf(candidate.what)},
                       {"unit", unit.name},
                       {"sd", candidate.sd * unit.factor}});
  }
  summary.set("outputs", outputs);
  const auto& all = inputs.limits().coordinates;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const std::string& name = all[i].coordinate;
    const bio::ShownUnit unit = planned.unitOf(name);
    coordinates.push_back({{"name", name},
                           {"unit", unit.name},
                           {"lowest", motions[i].lowest * unit.factor},
                           {"highest", motions[i].highest * unit.factor},
                           {"largest_speed", motions[i].fastest * unit.factor},
                           {"torque_unit", planned.torqueUnit(name)},
                           {"largest_torque", inputs.largestTorque(planned.after, name)},
                           {"largest_torque_rate", inputs.largestTorqueRate(planned.after, name)}});
  }
  summary.set("coordinates", coordinates);
  // what there was before there were lists
  const bool isOneAngle = all.size() == 1 && planned.coordinate(all[0].coordinate).isRotation;
  if (isOneAngle && observed.front().what == bio::ofCoordinate(all[0].coordinate)) {
    summary.set("noise_deg", observed.front().sd * bio::degreesPerRadian);
  }
  summary.set("rate_Hz", 1 / period);
  if (isOneAngle) {
    if (!inputs.torques().empty()) {
      summary.set("largest_torque_Nm", coordinates[0]["largest_torque"]);
      summary.set("largest_torque_rate_Nm_per_s", coordinates[0]["largest_torque_rate"]);
    }
    summary.set("lowest_deg", coordinates[0]["lowest"]);
    summary.set("highest_deg", coordinates[0]["highest"]);
    summary.set("largest_speed_deg_per_s", coordinates[0]["largest_speed"]);
  }
  if (!inputs.groups().empty()) {
    summary.set("largest_excitation_rate_per_s", inputs.largestExcitationRate(planned.after));
  }
  summary.set("simulations", record.runs);
  summary.set("impossible_simulations", record.impossible);
}

std::string measurementText(const std::vector<bio::ChannelCandidate>& observed, double period,
                            const bio::Model& model) {
  std::vector<std::string> texts;
  for (const bio::ChannelCandidate& candidate : observed) {
    const bio::ShownUnit unit = shownUnit(bio::unitOf(candidate.what, model));
    texts.push_back(fmt::format("{} (noise {} {})", nameOf(candidate.what),
                                numberText(candidate.sd * unit.factor), unit.name));
  }
  return fmt::format("a sample every {} s of {}", numberText(period), fmt::join(texts, ", "));
}

}  // namespace app
