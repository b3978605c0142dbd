#include "replay/replay_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "bio/analysis/replay.h"
#include "bio/model/units.h"
#include "bio/observation/observed_motion.h"
#include "bio/simulation/integrator_names.h"
#include "options/excitation_figure.h"
#include "output/text.h"

namespace app {
namespace {

/// Angles are shown in degrees, positions in mm.
bio::ShownUnit unitOf(const bio::Coordinate& coordinate) {
  return bio::positionUnit(coordinate.isRotation);
}

std::vector<double> inUnit(const Eigen::VectorXd& values, double factor) {
  const Eigen::VectorXd result = values * factor;
  return {result.begin(), result.end()};
}

const bio::MeasuredChannel* measuredOf(const ReplayFindings& f, const std::string& coordinate) {
  return f.trial.measurementOf(bio::ofCoordinate(coordinate));
}

Figure motionFigure(const ReplayFindings& f, std::size_t index) {
  const bio::Coordinate& coordinate = f.system.skeleton().coordinates()[index];
  const bio::ShownUnit unit = unitOf(coordinate);
  Figure figure{.title = fmt::format("Simulated {}", coordinate.name),
                .xLabel = "Time [s]",
                .yLabel = fmt::format("{} [{}]", coordinate.name, unit.name)};
  figure.series.push_back(
      {.name = "simulated",
       .x = f.replay.motion.time,
       .y = inUnit(f.replay.motion.q.row(static_cast<Eigen::Index>(index)), unit.factor)});
  if (const auto* measured = measuredOf(f, coordinate.name)) {
    figure.title += " and measured motion";
    figure.series.push_back({.name = "measured",
                             .x = {measured->times.begin(), measured->times.end()},
                             .y = inUnit(measured->values, unit.factor),
                             .style = SeriesStyle::points});
  }
  return figure;
}

/// Another measured channel than a coordinate, over all rows of the motion.
Figure channelFigure(const ReplayFindings& f, const bio::MeasuredChannel& channel,
                     const bio::MeasuredError& error) {
  const std::string name = bio::nameOf(channel.what);
  const std::string unit = unitText(bio::unitOf(channel.what, f.model));
  const std::vector<double>& time = f.replay.motion.time;
  const bio::ObservedMotion all(
      f.system, {{channel.what, Eigen::Map<const Eigen::VectorXd>(
                                    time.data(), static_cast<Eigen::Index>(time.size()))}});
  Figure figure{
      .title = fmt::format("Simulated and measured {}", name),
      .xLabel = "Time [s]",
      .yLabel = fmt::format("{} [{}]", name, unit),
      .caption = fmt::format("RMS error {:.3g} {} over {} samples.", error.rms, unit, error.count)};
  figure.series.push_back(
      {.name = "simulated", .x = time, .y = inUnit(all.values(f.replay.motion), 1)});
  figure.series.push_back({.name = "measured",
                           .x = {channel.times.begin(), channel.times.end()},
                           .y = inUnit(channel.values, 1),
                           .style = SeriesStyle::points});
  return figure;
}

std::vector<Figure> channelFigures(const ReplayFindings& f) {
  std::vector<Figure> figures;
  for (const bio::ChannelError& error : f.replay.channelErrors) {
    if (const auto* channel = f.trial.measurementOf(error.what))
      figures.push_back(channelFigure(f, *channel, error.error));
  }
  return figures;
}

/// Reactions that hold or drive the prescribed coordinates; of one unit.
Figure reactionFigure(const ReplayFindings& f, bool ofRotations) {
  Figure figure{.title = ofRotations ? "Reaction moments" : "Reaction forces",
                .xLabel = "Time [s]",
                .yLabel = ofRotations ? "Reaction [N m]" : "Reaction [N]",
                .caption =
                    "What keeps the coordinates on their prescribed course; positive: "
                    "pushes the coordinate up."};
  for (const int k : f.system.prescribed()) {
    const bio::Coordinate& c = f.system.skeleton().coordinates()[static_cast<std::size_t>(k)];
    if (c.isRotation != ofRotations) continue;
    figure.series.push_back({.name = c.name,
                             .x = f.replay.motion.time,
                             .y = inUnit(f.replay.motion.reaction.row(k), 1)});
  }
  return figure;
}

Figure perMuscle(const ReplayFindings& f, const std::string& title, const std::string& yLabel,
                 const Eigen::MatrixXd& rows, double factor, const std::string& caption = {}) {
  Figure figure{.title = title, .xLabel = "Time [s]", .yLabel = yLabel, .caption = caption};
  for (std::size_t i = 0; i < f.system.numMuscles(); ++i) {
    figure.series.push_back({.name = f.system.muscles()[i].name,
                             .x = f.replay.motion.time,
                             .y = inUnit(rows.row(static_cast<Eigen::Index>(i)), factor)});
  }
  return figure;
}

Figure energyFigure(const ReplayFindings& f) {
  const auto K = static_cast<Eigen::Index>(f.replay.motion.time.size());
  Eigen::VectorXd kinetic(K), potential(K), balance(K);
  for (Eigen::Index k = 0; k < K; ++k) {
    const bio::Energy energy =
        bio::energyOf(f.system, f.replay.motion.q.col(k), f.replay.motion.qDot.col(k));
    kinetic[k] = energy.kinetic;
    potential[k] = energy.potential;
  }
  potential.array() -= potential[0];
  balance = kinetic + potential - f.replay.motion.muscleWork - f.replay.motion.passiveWork -
            f.replay.motion.externalWork;
  balance.array() -= balance[0];
  Figure figure{.title = "Energy",
                .xLabel = "Time [s]",
                .yLabel = "Energy [J]",
                .caption =
                    "The balance is the integrator's energy error: kinetic + potential − work of "
                    "muscles, passive and external forces."};
  const auto add = [&](const std::string& name, const Eigen::VectorXd& values, SeriesStyle style) {
    figure.series.push_back(
        {.name = name, .x = f.replay.motion.time, .y = inUnit(values, 1), .style = style});
  };
  add("kinetic", kinetic, SeriesStyle::line);
  add("potential (from the start)", potential, SeriesStyle::line);
  add("work of muscles", f.replay.motion.muscleWork, SeriesStyle::line);
  if (!f.replay.motion.externalWork.isZero(0)) {
    add("work of external forces", f.replay.motion.externalWork, SeriesStyle::line);
  }
  if (!f.replay.motion.passiveWork.isZero(0)) {
    add("work of passive forces", f.replay.motion.passiveWork, SeriesStyle::line);
  }
  add("balance", balance, SeriesStyle::dashed);
  return figure;
}

/// "rms 3.2 deg from the measured elbow_flexion over 451 samples", or nothing measured.
std::string comparison(const ReplayFindings& f) {
  std::string text;
  for (const bio::Coordinate& coordinate : f.system.skeleton().coordinates()) {
    const auto* measured = measuredOf(f, coordinate.name);
    if (measured == nullptr) continue;
    const bio::ShownUnit unit = unitOf(coordinate);
    const bio::MeasuredError error = bio::compareWithMeasured(f.system, f.replay.motion, *measured);
    text += fmt::format(
        "{}{} differs from the measurement by {:.3g} {} (RMS over {} samples), at most {:.3g} {} "
        "at {:.3g} s",
        text.empty() ? "Simulated " : "; ", coordinate.name, error.rms * unit.factor, unit.name,
        error.count, error.largest * unit.factor, unit.name, error.largestAt);
  }
  for (const bio::ChannelError& error : f.replay.channelErrors) {
    const std::string unit = unitText(bio::unitOf(error.what, f.model));
    text += fmt::format(
        "{}{} differs from the measurement by {:.3g} {} (RMS over {} samples), at most {:.3g} {} "
        "at {:.3g} s",
        text.empty() ? "Simulated " : "; ", bio::nameOf(error.what), error.error.rms, unit,
        error.error.count, error.error.largest, unit, error.error.largestAt);
  }
  return text.empty() ? "Simulated; the trial has no measured coordinate to compare with" : text;
}

}  // namespace

namespace {

/// Errors of every measured channel that the motion reaches, with its unit.
nlohmann::ordered_json channelErrors(const ReplayFindings& f) {
  nlohmann::ordered_json errors = nlohmann::ordered_json::object();
  const auto add = [&](const std::string& name, const bio::MeasuredError& error, double factor,
                       const std::string& unit) {
    errors[name] = {{"value", error.rms * factor},
                    {"unit", unit},
                    {"max", error.largest * factor},
                    {"samples", error.count}};
  };
  for (const auto& [name, error] : f.replay.errors) {
    const bool turns = bio::findCoordinate(f.model, name).isRotation;
    add(name, error, turns ? bio::degreesPerRadian : 1, turns ? "deg" : "m");
  }
  for (const bio::ChannelError& error : f.replay.channelErrors) {
    add(bio::nameOf(error.what), error.error, 1, bio::unitOf(error.what, f.model));
  }
  return errors;
}

}  // namespace

void tellReplay(const ReplayFindings& f, Summary& summary) {
  const bio::Trajectory& motion = f.replay.motion;
  const bool left = f.left && motion.outcome == bio::Outcome::completed;
  summary.set("status", f.effect ? "step_too_long"
                        : left   ? "left_range"
                                 : bio::name(motion.outcome));
  if (!motion.why.empty()) summary.set("why", motion.why);
  if (f.effect) summary.set("why", describe(*f.effect));
  if (f.left) {
    summary.set("left_range_at_s", f.left->time);
    summary.set("left_range", f.left->what);
  }
  for (const bio::Coordinate& coordinate : f.system.skeleton().coordinates()) {
    const auto* measured = measuredOf(f, coordinate.name);
    if (measured == nullptr) continue;
    const bio::MeasuredError error = bio::compareWithMeasured(f.system, motion, *measured);
    const bool first = &coordinate == &f.system.skeleton().coordinates().front();
    const std::string suffix = (coordinate.isRotation ? "_deg" : "_mm");
    const std::string prefix = first ? "" : coordinate.name + "_";
    summary.set(prefix + "rms_error" + suffix, error.rms * unitOf(coordinate).factor);
    summary.set(prefix + "max_error" + suffix, error.largest * unitOf(coordinate).factor);
    summary.set(prefix + "compared_samples", error.count);
  }
  summary.set("rms_error", channelErrors(f));
  if (!f.system.prescribed().empty()) {
    std::vector<std::string> prescribed;
    for (const int k : f.system.prescribed()) {
      prescribed.push_back(f.system.skeleton().coordinates()[static_cast<std::size_t>(k)].name);
    }
    summary.set("prescribed", prescribed);
  }
  summary.set("start_from", bio::name(f.replay.beginning.from));
  summary.set("final_time_s", motion.time.back());
  summary.set("steps", motion.steps);
  summary.set("newton_iterations_per_step",
              motion.steps > 0
                  ? static_cast<double>(motion.newtonIterations) / static_cast<double>(motion.steps)
                  : 0.0);
  summary.set("halved_steps", motion.halvedSteps);
  summary.set("energy_error_J", bio::energyError(f.system, motion));
  summary.set("external_work_J", motion.externalWork.size() > 0
                                     ? motion.externalWork[motion.externalWork.size() - 1]
                                     : 0.0);
  std::vector<std::string> muscles;
  for (const bio::SystemMuscle& muscle : f.system.muscles()) muscles.push_back(muscle.name);
  summary.set("muscles", muscles);
  summary.set("notes", f.system.notes());
}

Report replayReport(const ReplayFindings& f) {
  Report report;
  report.title = fmt::format("Replay of {} on {}", f.trialFile, f.modelFile);
  report.verdict = comparison(f) + ".";
  if (f.replay.beginning.from == bio::TrialBeginning::From::model) {
    report.verdict += " The initial state is the one that was fitted for this trial.";
  }
  if (f.replay.motion.outcome != bio::Outcome::completed) {
    report.verdict = fmt::format("The simulation did not reach the end: {}.", f.replay.motion.why);
  }
  if (f.effect) {
    report.verdict =
        fmt::format("The motion depends on the step: {}. {}", describe(*f.effect), report.verdict);
  }
  if (f.left) {
    report.verdict = fmt::format("The motion leaves the valid range of the model: {}. {}",
                                 f.left->what, report.verdict);
  }
  // where the first coordinate is prescribed, what was measured of it comes first
  std::vector<Figure> figures = channelFigures(f);
  for (std::size_t i = 0; i < f.system.skeleton().coordinates().size(); ++i) {
    const bool first = i == 0 && !f.system.isPrescribed(0);
    figures.insert(first ? figures.begin() : figures.end(), motionFigure(f, i));
  }
  report.mainFigure = std::move(figures.front());
  if (f.playback) report.details.push_back(*f.playback);
  for (std::size_t i = 1; i < figures.size(); ++i) report.details.push_back(std::move(figures[i]));
  for (const bool ofRotations : {true, false}) {
    Figure figure = reactionFigure(f, ofRotations);
    if (!figure.series.empty()) report.details.push_back(std::move(figure));
  }
  report.details.push_back(Section{
      "Muscles",
      "What drives the motion: excitations of the trial, and what the muscles make of them."});
  if (auto excitations = excitationFigure(f.trial, &f.system))
    report.details.push_back(*std::move(excitations));
  report.details.push_back(
      perMuscle(f, "Activations", "Activation [1]", f.replay.motion.activation, 1));
  report.details.push_back(perMuscle(f, "Tendon forces", "Force [N]", f.muscles.tendonForce, 1));
  const bio::Coordinate& first = f.system.skeleton().coordinates().front();
  const Eigen::MatrixXd moments = f.muscles.tendonForce.cwiseProduct(f.muscles.momentArm);
  report.details.push_back(perMuscle(f, "Moments", first.isRotation ? "Moment [N m]" : "Force [N]",
                                     moments, 1,
                                     fmt::format("Positive: tends to increase {}.", first.name)));
  report.details.push_back(perMuscle(f, "Moment arms",
                                     first.isRotation ? "Moment arm [mm]" : "−∂ℓ/∂q [10⁻³]",
                                     f.muscles.momentArm, 1e3));
  report.details.push_back(
      perMuscle(f, "Fibre lengths", "Length [mm]", f.replay.motion.fibreLength, 1e3));
  report.details.push_back(
      Section{"Energy and numerics", "Checks of the integration, not of the model."});
  report.details.push_back(energyFigure(f));
  report.details.push_back(
      Paragraph{fmt::format("{} steps of {} s with {:.3g} Newton iterations per step, {} of them "
                            "halved; the integration took {:.3g} ms.",
                            f.replay.motion.steps, numberText(f.replay.options.step),
                            static_cast<double>(f.replay.motion.newtonIterations) /
                                std::max(1.0, static_cast<double>(f.replay.motion.steps)),
                            f.replay.motion.halvedSteps, f.replay.motion.wallSeconds * 1e3)});
  if (!f.system.notes().empty()) {
    report.details.push_back(Section{"Notes", "How the model was read."});
    for (const std::string& note : f.system.notes()) report.details.push_back(Paragraph{note});
  }
  return report;
}

}  // namespace app
