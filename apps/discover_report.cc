#include "discover_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "info/discover/hypothesis.h"
#include "info/discover/separation.h"
#include "interval_drawing.h"
#include "text.h"

namespace app {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using info::discover::Adequacy;
using info::discover::Estimate;
using info::discover::Gap;
using info::discover::Score;

/// Writes the parts of one report.
class Writer {
 public:
  explicit Writer(const DiscoverFindings& f) : f_(f), unit_(f.wording.unit) {}

  Report write() {
    report_.title = fmt::format("What {} lacks", f_.modelFile);
    report_.verdict = f_.verdict.sentence;
    for (const auto& effect : f_.verdict.effects) {
      const Estimate& amplitude = effect.estimates.front();
      const auto& quantity = f_.data.quantities()[amplitude.quantity];
      report_.verdict +=
          fmt::format(" {} = {} ± {}.", quantity.name, numberText(amplitude.value, 3),
                      withUnit(amplitude.deviation, quantity.unit, 2));
    }
    const bool gapOfHeldOut = f_.verdict.heldOut.has_value();
    const Gap& gap = gapOfHeldOut ? *f_.verdict.heldOut : f_.verdict.gap;
    if (gap.closedFromCalibrated && !f_.verdict.effects.empty()) {
      report_.verdict += fmt::format(" {} % of the gap is closed{}.",
                                     numberText(100 * *gap.closedFromCalibrated, 3),
                                     gapOfHeldOut ? " on trials that were held out" : "");
    }
    for (int t = 0; t < f_.data.numTrials(); ++t) {
      for (std::size_t output = 0; output < f_.wording.outputs.size(); ++output) {
        Figure figure = motion(t, output);
        if (t == 0 && output == 0) {
          report_.mainFigure = std::move(figure);
        } else {
          others_.push_back(std::move(figure));
        }
      }
    }
    effects();
    if (!f_.verdict.finalists.empty()) evidence();
    where();
    section("How well it fits");
    report_.details.emplace_back(gapTable());
    report_.details.emplace_back(adequacyTable());
    if (f_.verdict.unknown) unknown();
    parameters();
    detectability();
    section("Next experiment");
    say(f_.nextExperiment);
    if (!f_.foreseen.empty()) report_.details.emplace_back(foreseenTable());
    if (!others_.empty()) {
      section("The other trials");
      for (Figure& figure : others_) report_.details.emplace_back(std::move(figure));
    }
    return std::move(report_);
  }

 private:
  const info::discover::Candidate& candidate(std::size_t c) const {
    return f_.data.candidates()[c];
  }
  void section(const std::string& title) { report_.details.emplace_back(Section{title}); }
  void say(const std::string& text) { report_.details.emplace_back(Paragraph{text}); }
  std::string outputUnit() const { return f_.wording.outputs.front().unit; }

  /// Samples of one output among those of a trial.
  std::vector<Index> samplesOf(int t, std::size_t output) const {
    const auto& which = f_.data.outputOfSample(t);
    std::vector<Index> samples;
    for (std::size_t k = 0; k < f_.data.times(t).size(); ++k) {
      if (which.empty() || static_cast<std::size_t>(which[k]) == output)
        samples.push_back(static_cast<Index>(k));
    }
    return samples;
  }
  /// In the unit in which the output is shown, without its weight.
  std::vector<double> shown(const VectorXd& values, const std::vector<Index>& samples,
                            std::size_t output) const {
    const VectorXd result = unit_ / f_.wording.outputs[output].weight * values(samples);
    return {result.begin(), result.end()};
  }

  /// Measured, base after calibration, and with the effects; the band is the measurement's noise
  /// together with what the amplitudes leave open, 95 %.
  Figure motion(int t, std::size_t output) const {
    const auto& verdict = f_.verdict;
    const std::vector<Index> samples = samplesOf(t, output);
    std::vector<double> times;
    for (const Index k : samples) times.push_back(f_.data.times(t)[static_cast<std::size_t>(k)]);
    const ShownOutput& shownOutput = f_.wording.outputs[output];
    Figure figure{.title = f_.data.trialName(t) + (isHeldOut(t) ? " (held out)" : ""),
                  .xLabel = "Time [s]",
                  .yLabel = fmt::format("{} [{}]", shownOutput.name, shownOutput.unit)};
    figure.series.push_back({.name = "measured",
                             .x = times,
                             .y = shown(f_.data.measured(t), samples, output),
                             .style = SeriesStyle::points});
    if (verdict.base.size() > 0) {
      figure.series.push_back({.name = "calibrated, nothing added",
                               .x = times,
                               .y = shown(f_.data.outputs(t, verdict.base, {}), samples, output),
                               .style = SeriesStyle::dashed});
    }
    if (!verdict.effects.empty()) {
      const VectorXd after = f_.data.outputs(t, verdict.values, {});
      Series series{.name = "with the effect", .x = times, .y = shown(after, samples, output)};
      const VectorXd wide = 1.96 * info::discover::predictedDeviation(f_.data, verdict, t);
      series.bandLow = shown(after - wide, samples, output);
      series.bandHigh = shown(after + wide, samples, output);
      figure.series.push_back(std::move(series));
      figure.caption =
          "Simulations from the start to the end, without looking at what was measured. The band: "
          "95 % of measurements, with the uncertainty of the effect's size.";
    }
    return figure;
  }

  bool isHeldOut(int t) const {
    if (f_.verdict.heldOutFitted) return false;
    const auto& held = f_.options.heldOut;
    return std::find(held.begin(), held.end(), t) != held.end();
  }

  void effects() {
    const auto& verdict = f_.verdict;
    if (verdict.effects.empty()) return;
    section(verdict.surrogate ? "What imitates it best" : "What is missing");
    Table table{
        "",
        {"effect", "parameter", "unit", "estimate", "± sd", "evidence [nats]", "probability"},
        {}};
    for (const auto& effect : verdict.effects) {
      bool first = true;
      for (const Estimate& one : effect.estimates) {
        const auto& quantity = f_.data.quantities()[one.quantity];
        table.rows.push_back({first ? candidate(effect.candidate).name : "", quantity.name,
                              quantity.unit, numberText(one.value), numberText(one.deviation, 2),
                              first ? numberText(effect.logBayesFactor) : "",
                              first && !verdict.vetoed ? numberText(effect.probability, 3) : "–"});
        first = false;
      }
    }
    report_.details.emplace_back(std::move(table));
    for (const auto& effect : verdict.effects) {
      say(candidate(effect.candidate).sentence);
      if (effect.equals.size() < 2) continue;
      std::string list;
      for (const std::size_t c : effect.equals) {
        list += (list.empty() ? "" : ", ") + candidate(c).name;
      }
      say(fmt::format("These data cannot tell apart: {}{}.", list,
                      effect.exact ? " (what was measured never could, for some of them)" : ""));
    }
    if (verdict.vetoed) {
      say("What is left over has the wrong size, so that no probability is given.");
    }
  }

  /// All that were raced, as bars.
  void evidence() {
    section("Evidence");
    std::vector<IntervalRow> rows;
    std::vector<std::vector<std::string>> cells;
    for (const auto& one : f_.verdict.finalists) {
      if (rows.size() >= 20) break;
      std::string kind =
          one.effects.empty() ? "–" : info::discover::name(candidate(one.effects.front()).kind);
      const std::string name = info::discover::describe(f_.data, one.effects);
      rows.push_back({.name = fmt::format("{} ({})", name, kind),
                      .estimate = one.logEvidence,
                      .interval = std::pair(0.0, one.logEvidence)});
    }
    report_.details.emplace_back(VectorDrawing{
        "All that were raced", intervalDrawing(rows, "Evidence against the base model [nats]"),
        fmt::format("Logarithm of the Bayes factor, every parameter of the model fitted anew for "
                    "each; a name needs {} nats more than what goes without it, and rivals no more "
                    "than {} behind stay in its class.",
                    f_.options.evidence, f_.options.classWidth)});
  }

  void where() {
    const auto& map = f_.verdict.localisation;
    if (map.times.empty()) return;
    section("Where they disagree");
    Figure times{.title = "Score over time",
                 .xLabel = "Time [s]",
                 .yLabel = "Score [deviations]",
                 .caption = fmt::format(
                     "How far {} of 0.25 s would help at each time, after every parameter and "
                     "start has done its best; within ±2 is noise. Dots: significant (false "
                     "discoveries at most 5 %).",
                     f_.wording.push)};
    Series marks{.name = "significant", .style = SeriesStyle::points};
    for (const int trial : map.trials) {
      Series series{.name = f_.data.trialName(trial)};
      for (const Score& one : map.times) {
        if (one.trial != trial) continue;
        series.x.push_back((one.from + one.to) / 2);
        series.y.push_back(one.z);
        if (one.significant) {
          marks.x.push_back(series.x.back());
          marks.y.push_back(one.z);
        }
      }
      times.series.push_back(std::move(series));
    }
    if (!marks.x.empty()) times.series.push_back(std::move(marks));
    report_.details.emplace_back(std::move(times));
    if (f_.wording.hasMap) {
      report_.details.emplace_back(VectorDrawing{
          "Score over angle and speed", cells(map.cells),
          fmt::format("Orange: {} is pushed up more than the model knows, blue: down; framed: "
                      "significant. {}",
                      f_.wording.outputs.front().name,
                      map.cells.empty() ? "" : "White: it was never there.")});
    } else {
      say("There is no map over angle and speed: no angle was measured.");
    }
    Figure force{.title = "The force that is missing",
                 .xLabel = "Time [s]",
                 .yLabel = f_.wording.force,
                 .caption =
                     "Posterior mean of the latent force with ±2 standard deviations; from "
                     "the base model, by smoothing, nothing is differentiated twice."};
    for (std::size_t k = 0; k < map.trials.size(); ++k) {
      Series series{.name = f_.data.trialName(map.trials[k]),
                    .x = f_.data.latentTimes(map.trials[k])};
      const VectorXd& r = map.force[k];
      const VectorXd low = r - 2 * map.forceDeviation[k], high = r + 2 * map.forceDeviation[k];
      series.y.assign(r.begin(), r.end());
      series.bandLow.assign(low.begin(), low.end());
      series.bandHigh.assign(high.begin(), high.end());
      force.series.push_back(std::move(series));
    }
    report_.details.emplace_back(std::move(force));
    Table muscles{"Score by " + f_.wording.input,
                  {f_.wording.input, "score [deviations]", "significant"},
                  {}};
    for (const Score& one : map.inputs) {
      muscles.rows.push_back({one.input, numberText(one.z, 3), one.significant ? "yes" : "no"});
    }
    report_.details.emplace_back(std::move(muscles));
  }

  /// A heat map over output and rate.
  std::string cells(const std::vector<Score>& scores) const {
    if (scores.empty()) return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1 1\"/>";
    double lowQ = HUGE_VAL, highQ = -HUGE_VAL, lowV = HUGE_VAL, highV = -HUGE_VAL;
    for (const Score& one : scores) {
      lowQ = std::min(lowQ, one.lowerQ);
      highQ = std::max(highQ, one.upperQ);
      lowV = std::min(lowV, one.lowerQDot);
      highV = std::max(highV, one.upperQDot);
    }
    constexpr double left = 110, right = 900, top = 10, bottom = 300;
    const auto x = [&](double q) { return left + (q - lowQ) / (highQ - lowQ) * (right - left); };
    const auto y = [&](double v) { return bottom - (v - lowV) / (highV - lowV) * (bottom - top); };
    std::string svg =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 920 360\" width=\"100%\" "
        "font-family=\"sans-serif\" font-size=\"14\">\n";
    for (const Score& one : scores) {
      const double strength = std::min(1.0, std::abs(one.z) / 6);
      svg += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" "
          "fill-opacity=\"{:.2f}\" stroke=\"{}\" stroke-width=\"{}\"/>"
          "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:.1f}</text>\n",
          x(one.lowerQ) + 1, y(one.upperQDot) + 1, x(one.upperQ) - x(one.lowerQ) - 2,
          y(one.lowerQDot) - y(one.upperQDot) - 2, one.z > 0 ? "#E69F00" : "#56B4E9", strength,
          one.significant ? "#000" : "#ddd", one.significant ? 2.5 : 1,
          (x(one.lowerQ) + x(one.upperQ)) / 2, (y(one.lowerQDot) + y(one.upperQDot)) / 2 + 5,
          one.z);
    }
    for (int k = 0; k <= 4; ++k) {
      const double q = lowQ + k * (highQ - lowQ) / 4, v = lowV + k * (highV - lowV) / 4;
      svg += fmt::format(
          "<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text><text x=\"{}\" y=\"{:.1f}\" "
          "text-anchor=\"end\">{}</text>\n",
          x(q), bottom + 20, numberText(unit_ * q, 3), left - 8, y(v) + 5,
          numberText(unit_ * v, 3));
    }
    svg += fmt::format(
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-weight=\"bold\">{} [{}]</text>"
        "<text transform=\"translate(22 {}) rotate(-90)\" text-anchor=\"middle\" "
        "font-weight=\"bold\">Speed [{}/s]</text>\n",
        (left + right) / 2, bottom + 46, htmlText(f_.wording.outputs.front().name), outputUnit(),
        (top + bottom) / 2, outputUnit());
    return svg + "</svg>\n";
  }

  Table gapTable() const {
    const std::string unit = outputUnit();
    Table table{"Root mean square of measured − simulated",
                {"trials", "model as it came [" + unit + "]", "calibrated [" + unit + "]",
                 "with the effect [" + unit + "]", "to be expected [" + unit + "]",
                 "noise [" + unit + "]", "of the range [%]", "gap closed [%]"},
                {}};
    const auto row = [&](const char* name, const Gap& gap) {
      table.rows.push_back(
          {name, numberText(unit_ * gap.nominal, 3), numberText(unit_ * gap.calibrated, 3),
           numberText(unit_ * gap.after, 3),
           gap.expected ? numberText(unit_ * *gap.expected, 3) : "–",
           numberText(unit_ * gap.floor, 3), numberText(100 * gap.after / gap.range, 2),
           gap.closedFromCalibrated ? numberText(100 * *gap.closedFromCalibrated, 4)
                                    : "there was none"});
    };
    row("fitted", f_.verdict.gap);
    if (f_.verdict.heldOut) row("held out", *f_.verdict.heldOut);
    return table;
  }

  Table foreseenTable() const {
    Table table{"What experiments are expected to tell", {"experiment"}, {}};
    for (std::size_t i = 1; i < f_.verdict.rivals.size(); ++i)
      table.columns.push_back(fmt::format("{} from {} [nats]", rivalName(f_.data, f_.verdict, 0),
                                          rivalName(f_.data, f_.verdict, i)));
    for (const bio::discover::ForeseenExperiment& one : f_.foreseen) {
      std::vector<std::string> row{one.sentence};
      for (const double nats : one.nats) row.push_back(numberText(nats, 2));
      table.rows.push_back(std::move(row));
    }
    return table;
  }

  Table adequacyTable() const {
    Table table{"Is what is left white noise?", {"", "base", "with the effect", "rule"}, {}};
    const Adequacy &a = f_.verdict.before, &b = f_.verdict.after;
    const auto word = [](bool ok) { return ok ? "yes" : "no"; };
    table.rows.push_back(
        {"mean square of the innovations [1]", numberText(a.meanSquare, 3),
         numberText(b.meanSquare, 3),
         fmt::format("{} … {}", numberText(b.lowest, 3), numberText(b.highest, 3))});
    table.rows.push_back(
        {"Ljung–Box over 20 lags, probability", numberText(a.ljungBoxProbability, 2),
         numberText(b.ljungBoxProbability, 2), fmt::format("> {}", f_.options.level)});
    table.rows.push_back({fmt::format("follows past {}, probability", f_.wording.commands),
                          numberText(a.inputProbability, 2), numberText(b.inputProbability, 2),
                          fmt::format("> {}", f_.options.level)});
    const auto remainder = [&](const std::string& what, double base, double with) {
      table.rows.push_back({"follows " + what + ", evidence [nats]", numberText(base, 2),
                            numberText(with, 2), fmt::format("< {}", f_.options.remainder)});
    };
    remainder("the state (q, q̇)", a.remainder.ofState, b.remainder.ofState);
    remainder("all past " + f_.wording.commands, a.remainder.ofInputs, b.remainder.ofInputs);
    table.rows.push_back({"latent force that is still needed, " + f_.wording.ofForce,
                          numberText(f_.verdict.latentSizeBefore, 2),
                          numberText(f_.verdict.latentSizeAfter, 2),
                          fmt::format("≤ {}", f_.options.latentTolerance)});
    const auto &before = f_.verdict.heldOutBefore, &after = f_.verdict.heldOutAfter;
    if (before && after) {
      table.rows.push_back({"mean square of the innovations of what was held out [1]",
                            numberText(before->meanSquare, 3), numberText(after->meanSquare, 3),
                            fmt::format("< {}", numberText(after->highest, 3))});
    }
    if (f_.verdict.heldOut && f_.verdict.heldOut->probability) {
      table.rows.push_back({"held-out errors as large as these, probability", "",
                            numberText(*f_.verdict.heldOut->probability, 2),
                            fmt::format("> {}", f_.options.secondLook)});
    }
    table.rows.push_back({"adequate", word(a.adequate()), word(b.adequate()), ""});
    return table;
  }

  void unknown() {
    const auto& u = *f_.verdict.unknown;
    section("Something without a name");
    say(
        fmt::format("The missing force has a root mean square of {} {}; {} % of its power lies "
                    "within 0.5 Hz of {} Hz.",
                    numberText(u.forceSize, 3), f_.wording.forceUnit,
                    numberText(100 * u.peakShare, 2), numberText(u.peakFrequency, 2)));
    if (!u.formula.empty()) {
      say(fmt::format(
          "As a formula, a surrogate: {} ({} nats more than the latent force alone, {} % "
          "of its power{}).",
          u.formula, numberText(u.evidence, 3), numberText(100 * u.explained, 2),
          u.stable ? "; chosen in at least 90 % of the bootstraps"
                   : "; not stable, do not trust its form"));
    }
    if (f_.verdict.formula) raced(*f_.verdict.formula);
  }

  void raced(const info::discover::RacedFormula& formula) {
    std::string text = fmt::format(
        "Fitted and raced like a name: {}, {} nats better than the model "
        "without it",
        formula.text, numberText(formula.logBayesFactor, 3));
    const info::discover::Gap& gap = formula.heldOut ? *formula.heldOut : formula.gap;
    if (gap.closedFromCalibrated)
      text += fmt::format("; it closes {} % of the gap{}",
                          numberText(100 * *gap.closedFromCalibrated, 3),
                          formula.heldOut ? " on the trial that was held out" : "");
    say(text + (formula.wins
                    ? ". It leaves nothing else to be seen, and is in with_effect.osim."
                    : ". It does not explain everything, or has rivals: do not take it for "
                      "the effect."));
  }

  void parameters() {
    const auto& list = f_.verdict.nuisancesAfter;
    if (list.empty()) return;
    section("Parameters");
    std::vector<IntervalRow> rows;
    for (const Estimate& one : list) {
      const auto& quantity = f_.data.quantities()[one.quantity];
      const double scale = quantity.logarithmic ? quantity.deviation * std::max(one.value, 1e-300)
                                                : quantity.deviation;
      const double half = 1.96 * one.deviation / scale;
      rows.push_back({.name = quantity.name,
                      .estimate = one.surprise,
                      .interval = std::pair(one.surprise - half, one.surprise + half),
                      .before = std::pair(-1.96, 1.96)});
    }
    report_.details.emplace_back(
        VectorDrawing{"What calibration did to the parameters of the model",
                      intervalDrawing(rows, "Departure from the model [tolerances]"),
                      fmt::format("95 % intervals; beyond ±{} a parameter is called wrong.",
                                  f_.options.surprise)});
  }

  void detectability() {
    if (f_.verdict.detectability.empty()) return;
    section("What these data could not have shown");
    Table table{"", {"effect", "kind", "smaller than", "unit"}, {}};
    for (const auto& one : f_.verdict.detectability) {
      const auto& c = candidate(one.candidate);
      table.rows.push_back({c.name, info::discover::name(c.kind), numberText(one.amplitude, 2),
                            f_.data.quantities()[c.quantities.front()].unit});
    }
    report_.details.emplace_back(std::move(table));
    say("The smallest size of each effect that would have stood out by five standard deviations, "
        "beside what was found, all parameters free.");
    for (const auto& [id, present] : f_.wording.present) {
      say(fmt::format("The model has {} already ({}); it was not a candidate.", id, present));
    }
  }

  const DiscoverFindings& f_;
  double unit_;
  Report report_;
  std::vector<Figure> others_;
};

}  // namespace

Report discoverReport(const DiscoverFindings& findings) {
  return Writer(findings).write();
}

}  // namespace app
