#include "compare/compare_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bio/analysis/replay.h"
#include "bio/model/units.h"
#include "bio/simulation/integrator_names.h"
#include "compare/compare_figures.h"
#include "options/excitation_figure.h"
#include "output/text.h"

namespace app {
namespace {

Table cellTable(const CompareFindings& f) {
  Table table{"",
              {"integrator", "step [s]", "status", "RMS error [deg]", "largest [deg]", "time [ms]",
               "Newton iterations per step", "energy error [J]"},
              {}};
  for (const bio::CompareCell& cell : f.comparison.cells) {
    table.rows.push_back(
        {bio::name(cell.integrator), numberText(cell.step),
         isOk(cell) ? (cell.halvedSteps > 0 ? fmt::format("ok, {} halved", cell.halvedSteps) : "ok")
                    : fmt::format("{} at {} s", bio::name(cell.outcome), numberText(cell.failedAt)),
         numberText(cell.error.rms * bio::degreesPerRadian, 3),
         numberText(cell.error.largest * bio::degreesPerRadian, 3),
         numberText(cell.wallSeconds * 1e3, 4), numberText(cell.newtonPerStep, 3),
         numberText(cell.energyError, 3)});
  }
  return table;
}

Table failureTable(const CompareFindings& f) {
  Table table{"How runs failed", {"integrator", "step [s]", "why"}, {}};
  for (const bio::CompareCell& cell : f.comparison.cells) {
    if (isOk(cell)) continue;
    table.rows.push_back({bio::name(cell.integrator), numberText(cell.step), cell.why});
  }
  return table;
}

Table limitTable(const CompareFindings& f) {
  Table table{"", {"integrator", "stable at [s]", "not stable at [s]", "failure"}, {}};
  for (const bio::StepLimit& limit : f.comparison.limits) {
    table.rows.push_back({bio::name(limit.integrator), numberText(limit.stable),
                          numberText(limit.failing), limit.why});
  }
  return table;
}

std::string referenceText(const CompareFindings& f) {
  const bio::ConvergedReference& reference = f.comparison.reference;
  const std::string text = fmt::format(
      "The reference is CVODE at a relative tolerance of {:g}. At {:g} it differs by {:.2g} deg "
      "RMS and at most {:.2g} deg; interpolating it adds {:.2g} deg. Smaller errors are not "
      "resolved.",
      reference.relativeTolerance, reference.looserTolerance,
      reference.problem.rms * bio::degreesPerRadian,
      reference.problem.largest * bio::degreesPerRadian,
      reference.interpolationError * bio::degreesPerRadian);
  if (!reference.confirmed()) {
    return fmt::format("{} It is disputed: {}.", text, reference.whyDisputed);
  }
  return fmt::format("{} The variational integrator at {:g} s confirms it to {:.2g} deg RMS.", text,
                     reference.secondStep, reference.second.rms * bio::degreesPerRadian);
}

std::string verdictOf(const CompareFindings& f) {
  std::string text;
  const bio::ConvergedReference& reference = f.comparison.reference;
  if (!reference.confirmed()) {
    text = fmt::format("The reference is not reliable: {}. Errors are given against cvode: ",
                       reference.whyDisputed);
  }
  if (isOk(*f.chosen)) {
    text += fmt::format("{} at {} s has an RMS error of {:.2g} deg against the converged reference",
                        bio::name(f.chosen->integrator), numberText(f.chosen->step),
                        f.chosen->error.rms * bio::degreesPerRadian);
  } else {
    text += fmt::format("{} at {} s does not reach the end", bio::name(f.chosen->integrator),
                        numberText(f.chosen->step));
  }
  for (const bio::StepLimit& limit : f.comparison.limits) {
    if (std::isnan(limit.stable)) {
      text += fmt::format("; no stable step of {} was found", bio::name(limit.integrator));
    } else if (std::isnan(limit.failing)) {
      text += fmt::format("; {} is stable at every step tried, to {:.2g} s",
                          bio::name(limit.integrator), limit.stable);
    } else {
      text += fmt::format("; {} is stable to {:.2g} s", bio::name(limit.integrator), limit.stable);
    }
  }
  return text + ".";
}

void addMeasured(const CompareFindings& f, Report& report) {
  for (const bio::MeasuredChannel& measured : f.trial.measured) {
    if (measured.what != bio::ofCoordinate(f.coordinate.name)) continue;
    Figure figure = besideFigure(f, "Comparison with the measured motion");
    const bio::MeasuredError error =
        bio::compareWithMeasured(f.system, f.comparison.reference.motion, measured);
    Series series{.name = "measured", .style = SeriesStyle::points};
    for (Eigen::Index k = 0; k < measured.times.size(); ++k) {
      series.x.push_back(measured.times[k]);
      series.y.push_back(measured.values[k] * bio::degreesPerRadian);
    }
    figure.series.push_back(std::move(series));
    figure.caption = fmt::format(
        "The reference has an RMS error of {:.3g} deg against the measured motion, which is an "
        "error of the model and not of an integrator. Each integrator is drawn at its longest step "
        "with an error below {:.2g} deg.",
        error.rms * bio::degreesPerRadian, f.options.usefulError * bio::degreesPerRadian);
    report.details.push_back(std::move(figure));
  }
}

void addAlso(const CompareFindings& f, Report& report) {
  if (f.also.empty()) return;
  Figure figure = besideFigure(f, "Comparison with other programs");
  for (const AlsoCurve& curve : f.also) {
    Series series{.name = curve.name, .x = curve.curve.time, .style = SeriesStyle::points};
    for (const double value : curve.curve.value) series.y.push_back(value * bio::degreesPerRadian);
    figure.series.push_back(std::move(series));
    figure.caption += fmt::format("{}{} differs from the reference by {:.2g} deg (RMS).",
                                  figure.caption.empty() ? "" : " ", curve.name,
                                  curve.rms * bio::degreesPerRadian);
  }
  report.details.push_back(std::move(figure));
}

}  // namespace

void writeCells(const bio::Comparison& comparison, std::ostream& out) {
  const auto cell = [](double value) { return cellText(value, 9); };
  out << "integrator,step_s,status,failed_at_s,rms_deg,max_deg,wall_ms,newton_per_step,"
         "energy_error_J\n";
  for (const bio::CompareCell& one : comparison.cells) {
    out << fmt::format("{},{},{},{},{},{},{},{},{}\n", bio::name(one.integrator), cell(one.step),
                       bio::name(one.outcome), cell(one.failedAt),
                       cell(one.error.rms * bio::degreesPerRadian),
                       cell(one.error.largest * bio::degreesPerRadian), cell(one.wallSeconds * 1e3),
                       cell(one.newtonPerStep), cell(one.energyError));
  }
}

void tellCompare(const CompareFindings& f, Summary& summary) {
  using Json = nlohmann::ordered_json;
  const bio::ConvergedReference& reference = f.comparison.reference;
  Json stable = {{"rk4", nullptr}, {"vi", nullptr}};
  for (const bio::StepLimit& limit : f.comparison.limits) {
    stable[bio::name(limit.integrator)] = limit.stable;
  }
  Json observed = {{"vi", nullptr}, {"vi-left", nullptr}, {"rk4", nullptr}};
  Json used = Json::object();
  for (const bio::ObservedOrder& order : f.comparison.orders) {
    observed[bio::name(order.integrator)] = order.order;
    used[bio::name(order.integrator)] = order.steps;
  }
  summary.set("largest_stable_step_s", stable);
  summary.set("observed_order", observed);
  summary.set("observed_order_steps_s", used);
  summary.set("stable_means_rms_below_deg", f.options.usefulError * bio::degreesPerRadian);
  summary.set("reference_status", !reference.completed()  ? "failed"
                                  : reference.confirmed() ? "confirmed"
                                                          : "disputed");
  if (!reference.whyDisputed.empty()) summary.set("reference_disputed", reference.whyDisputed);
  if (!reference.completed()) {
    summary.set("why", reference.motion.why);
    return;
  }
  summary.set("status", bio::name(f.chosen->outcome));
  summary.set("rms_deg", f.chosen->error.rms * bio::degreesPerRadian);
  summary.set("max_deg", f.chosen->error.largest * bio::degreesPerRadian);
  summary.set("newton_iterations_per_step", f.chosen->newtonPerStep);
  summary.set("energy_error_J", f.chosen->energyError);
  summary.set("reference_relative_tolerances",
              Json::array({reference.looserTolerance, reference.relativeTolerance}));
  summary.set("reference_disagreement_rms_deg", reference.problem.rms * bio::degreesPerRadian);
  summary.set("reference_disagreement_max_deg", reference.problem.largest * bio::degreesPerRadian);
  summary.set("reference_interpolation_rms_deg",
              reference.interpolationError * bio::degreesPerRadian);
  summary.set("reference_second_integrator", "vi");
  summary.set("reference_second_step_s", reference.secondStep);
  summary.set("reference_second_rms_deg", reference.second.rms * bio::degreesPerRadian);
  for (const bio::MeasuredChannel& measured : f.trial.measured) {
    if (measured.what != bio::ofCoordinate(f.coordinate.name)) continue;
    summary.set(
        "reference_from_measured_rms_deg",
        bio::compareWithMeasured(f.system, reference.motion, measured).rms * bio::degreesPerRadian);
  }
  for (const AlsoCurve& curve : f.also) {
    summary.set("also_" + curve.name + "_rms_deg", curve.rms * bio::degreesPerRadian);
  }
  summary.set("timings_per_run", f.options.timings);
  summary.set("notes", f.system.notes());
}

Report compareReport(const CompareFindings& f) {
  Report report;
  report.title = fmt::format("Integrators on {} with {}", f.trialFile, f.modelFile);
  if (!f.comparison.reference.completed()) {
    report.verdict = fmt::format("No converged reference: {}.", f.comparison.reference.motion.why);
    return report;
  }
  report.verdict = verdictOf(f);
  report.mainFigure = workPrecisionFigure(f);
  report.details.push_back(errorFigure(f));
  report.details.push_back(Paragraph{referenceText(f)});
  if (!f.system.switches().empty()) {
    report.details.push_back(
        Paragraph{"A muscle path of this model gains or loses points at certain angles, where its "
                  "length jumps. Every integrator ends a step at such an angle."});
  }
  report.details.push_back(
      Section{"Largest stable steps", "How long a step each integrator takes before it fails."});
  report.details.push_back(limitTable(f));
  report.details.push_back(Paragraph{fmt::format(
      "A step is stable if the run reaches the end with an RMS error below {:.2g} deg "
      "against the reference. The limit is found by bisection to {:.2g} %.",
      f.options.usefulError * bio::degreesPerRadian, (f.options.stepResolution - 1) * 100)});
  report.details.push_back(failureTimeline(f));
  if (Table failures = failureTable(f); !failures.rows.empty()) {
    report.details.push_back(std::move(failures));
  }
  report.details.push_back(Section{"Motions", "Simulated motions beside the converged reference."});
  if (!cellsOf(f, bio::Integrator::rungeKutta4).empty()) {
    report.details.push_back(rungeKuttaFigure(f));
  }
  if (!cellsOf(f, bio::Integrator::variational).empty()) {
    report.details.push_back(variationalFigure(f));
  }
  addMeasured(f, report);
  addAlso(f, report);
  if (auto excitations = excitationFigure(f.trial, &f.system))
    report.details.push_back(*std::move(excitations));
  report.details.push_back(Section{"Runs", "Every combination of integrator and step."});
  report.details.push_back(cellTable(f));
  report.details.push_back(Paragraph{fmt::format(
      "Times are medians of {} runs. The energy error is the largest difference between kinetic "
      "plus potential energy and the work of muscles and passive forces. For CVODE the step is the "
      "interval of its output; its internal steps follow from a relative tolerance of 1e-10. For "
      "vi-adaptive it is the longest step. "
      "Halved steps are those that did not converge in one piece.",
      f.options.timings)});
  if (!f.system.notes().empty()) {
    report.details.push_back(Section{"Notes"});
    for (const std::string& note : f.system.notes()) report.details.push_back(Paragraph{note});
  }
  return report;
}

}  // namespace app
