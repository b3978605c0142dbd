#include "discover/discover_fit_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "discover/excess_error_text.h"
#include "discover/output_errors.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "output/text.h"

namespace app {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using info::discover::Adequacy;
using info::discover::Cause;
using info::discover::ExcessError;

/// In the unit in which the output is shown.
std::vector<double> shownValues(const ShownOutput& output, const VectorXd& values,
                                const std::vector<Index>& samples) {
  const VectorXd result = output.scale * values(samples);
  return {result.begin(), result.end()};
}

bool isHeldOut(const DiscoverFindings& f, int t) {
  const auto& held = f.options.heldOut;
  return std::find(held.begin(), held.end(), t) != held.end();
}

/// "elbow_flexion [deg]".
std::string axisLabel(const ShownOutput& output) {
  return output.unit.empty() ? output.name : fmt::format("{} [{}]", output.name, output.unit);
}

}  // namespace

Figure motionFigure(const DiscoverFindings& f, int t, std::size_t output) {
  const auto& verdict = f.verdict;
  const std::vector<Index> samples = samplesOf(f.data, t, output);
  std::vector<double> times;
  for (const Index k : samples) times.push_back(f.data.times(t)[static_cast<std::size_t>(k)]);
  const ShownOutput& shown = f.wording.outputs[output];
  Figure figure{.title = f.data.trialName(t) + (isHeldOut(f, t) ? " (held out)" : ""),
                .xLabel = "Time [s]",
                .yLabel = axisLabel(shown)};
  if (samples.empty()) return figure;
  figure.series.push_back({.name = "measured",
                           .x = times,
                           .y = shownValues(shown, f.data.measured(t), samples),
                           .style = SeriesStyle::points});
  if (verdict.base.size() > 0) {
    figure.series.push_back({.name = "calibrated, no effect added",
                             .x = times,
                             .y = shownValues(shown, f.data.outputs(t, verdict.base, {}), samples),
                             .style = SeriesStyle::dashed});
  }
  if (!verdict.effects.empty()) {
    const VectorXd after = f.data.outputs(t, verdict.values, {});
    Series series{.name = "with the effect", .x = times, .y = shownValues(shown, after, samples)};
    const VectorXd wide = 1.96 * info::discover::predictedSd(f.data, verdict, t);
    series.bandLow = shownValues(shown, after - wide, samples);
    series.bandHigh = shownValues(shown, after + wide, samples);
    figure.series.push_back(std::move(series));
    figure.caption =
        "Simulations from the initial state to the end, not corrected by the measurements. Band: "
        "95 % of the measurements are expected here, given the noise and the uncertainty of the "
        "effect's size.";
  }
  return figure;
}

Table excessErrorTable(const DiscoverFindings& f) {
  const std::string& unit = f.wording.errorUnit;
  const double scale = f.wording.unit;
  Table table{f.wording.isInNoise() ? "RMS error (measured − simulated) in standard deviations of "
                                      "the noise, over all outputs"
                                    : "RMS error (measured − simulated)",
              {"trials", "original model [" + unit + "]", "calibrated [" + unit + "]",
               "with the effect [" + unit + "]", "expected [" + unit + "]", "noise [" + unit + "]",
               "relative to the range [%]", "excess error explained"},
              {}};
  const auto row = [&](const char* name, const ExcessError& excess) {
    table.rows.push_back(
        {name, numberText(scale * excess.nominal, 3), numberText(scale * excess.calibrated, 3),
         numberText(scale * excess.after, 3),
         excess.expected ? numberText(scale * *excess.expected, 3) : "–",
         numberText(scale * excess.floor, 3), numberText(100 * excess.after / excess.range, 2),
         excess.closedFromCalibrated ? excessErrorCell(excess) : "no excess error"});
  };
  row("fitted", f.verdict.excess);
  if (f.verdict.heldOut) row("held out", *f.verdict.heldOut);
  return table;
}

Table outputErrorTable(const DiscoverFindings& f) {
  Table table{"RMS error (measured − simulated) by output",
              {"output", "unit", "trials", "with all fitted parameters", "noise"},
              {}};
  const Eigen::VectorXd fitted = errorsOf(f, false), heldOut = errorsOf(f, true);
  for (std::size_t o = 0; o < f.wording.outputs.size(); ++o) {
    const ShownOutput& output = f.wording.outputs[o];
    for (const bool ofHeldOut : {false, true}) {
      if (ofHeldOut && f.options.heldOut.empty()) continue;
      const double error = (ofHeldOut ? heldOut : fitted)[static_cast<Eigen::Index>(o)];
      table.rows.push_back({output.name, output.unit, ofHeldOut ? "held out" : "fitted",
                            numberText(error, 3),
                            numberText(output.scale * f.verdict.sds.sd(o), 3)});
    }
  }
  return table;
}

Table adequacyTable(const DiscoverFindings& f) {
  Table table{"Residual diagnostics", {"", "base", "with the effect", "rule"}, {}};
  const Adequacy &a = f.verdict.before, &b = f.verdict.after;
  const auto word = [](bool ok) { return ok ? "yes" : "no"; };
  table.rows.push_back({"mean square of the innovations [1]", numberText(a.meanSquare, 3),
                        numberText(b.meanSquare, 3),
                        fmt::format("{} … {}", numberText(b.lowest, 3), numberText(b.highest, 3))});
  table.rows.push_back({"Ljung–Box test over 20 lags, p-value",
                        numberText(a.ljungBoxProbability, 2), numberText(b.ljungBoxProbability, 2),
                        fmt::format("> {}", f.options.level)});
  table.rows.push_back({fmt::format("dependence on past {}, p-value", f.wording.commands),
                        numberText(a.inputProbability, 2), numberText(b.inputProbability, 2),
                        fmt::format("> {}", f.options.level)});
  const auto remainder = [&](Cause cause, const std::string& what) {
    if (a.remainder.of(cause) == 0 && b.remainder.of(cause) == 0) return;  // none of the kind
    table.rows.push_back({"dependence on " + what + ", log Bayes factor [nats]",
                          numberText(a.remainder.of(cause), 2),
                          numberText(b.remainder.of(cause), 2),
                          fmt::format("< {}", f.options.remainder)});
  };
  remainder(Cause::state, "the state (q, q̇)");
  remainder(Cause::inputs, "all past " + f.wording.commands);
  remainder(Cause::acceleration, "the acceleration");
  remainder(Cause::sensor, "the sensor's reading");
  remainder(Cause::moments, fmt::format("each {}'s moment and the {}", f.wording.input,
                                        f.wording.axes.front().position));
  table.rows.push_back(
      {"latent force still needed, " + f.wording.ofForce, numberText(f.verdict.latentSizeBefore, 2),
       numberText(f.verdict.latentSizeAfter, 2), fmt::format("≤ {}", f.options.latentTolerance)});
  const auto &before = f.verdict.heldOutBefore, &after = f.verdict.heldOutAfter;
  if (before && after) {
    table.rows.push_back({"mean square of the held-out innovations [1]",
                          numberText(before->meanSquare, 3), numberText(after->meanSquare, 3),
                          fmt::format("< {}", numberText(after->highest, 3))});
  }
  if (f.verdict.heldOut && f.verdict.heldOut->probability) {
    table.rows.push_back({"held-out errors at least as large, p-value", "",
                          numberText(*f.verdict.heldOut->probability, 2),
                          fmt::format("> {}", f.options.farOff)});
  }
  table.rows.push_back({"adequate", word(a.adequate()), word(b.adequate()), ""});
  return table;
}

}  // namespace app
