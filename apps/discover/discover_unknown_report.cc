#include "discover/discover_unknown_report.h"

#include <fmt/format.h>

#include <cmath>

#include "discover/excess_error_text.h"
#include "output/text.h"

namespace app {
namespace {

using info::discover::NonparametricForce;

Paragraph formulaOf(const info::discover::Unknown& u) {
  return {
      fmt::format("Formula that approximates the latent force: {} (log Bayes factor of {} nats "
                  "against the latent force alone; {} % of its power{}).",
                  u.formula, numberText(u.evidence, 3), numberText(100 * u.explained, 2),
                  u.stable ? "; chosen in at least 90 % of the bootstrap samples"
                           : "; not stable: do not rely on its form")};
}

Paragraph raced(const DiscoverFindings& f, const info::discover::RacedFormula& formula) {
  std::string text = fmt::format(
      "Fitted as a candidate effect: {}, with a log Bayes factor of {} nats against the model "
      "without it",
      formula.text, numberText(formula.logBayesFactor, 3));
  const info::discover::ExcessError& excess = formula.heldOut ? *formula.heldOut : formula.excess;
  text += ". ";
  if (excess.closedFromCalibrated)
    text += excessErrorWords(excess, f.wording.unit, symbolOf(f.wording.errorUnit),
                             formula.heldOut.has_value()) +
            " ";
  return {text + (formula.wins ? "With it the residual is adequate; with_effect.osim contains it."
                               : "It does not explain the whole residual, or other effects explain "
                                 "it as well: do not take it for the missing effect.")};
}

// "viscous damping, dry friction"; "" for none
std::string besides(const DiscoverFindings& f, const NonparametricForce& force) {
  std::string names;
  for (const std::size_t c : force.besides)
    names += (names.empty() ? "" : ", ") + f.data.candidates()[c].name;
  return names;
}

Figure curve(const DiscoverFindings& f, const NonparametricForce& force) {
  const bool position = force.follows == NonparametricForce::Follows::position;
  const ShownAxis& axis = f.wording.axes.at(force.axis);
  const std::string names = besides(f, force);
  Figure figure{
      .title = "Free-form force" + f.wording.named(force.axis),
      .xLabel = position ? fmt::format("{} [{}]", axis.name, axis.unit)
                         : fmt::format("Speed [{}/s]", axis.unit),
      .yLabel = axis.force,
      .caption = fmt::format(
          "Fitted together with all parameters, ±2 standard deviations: any smooth function of the "
          "{} alone{}. Its form suggests what to look for.",
          followedBy(f, force), names.empty() ? "" : ", in addition to " + names)};
  Series series{.name = "force"};
  for (std::size_t i = 0; i < force.at.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    series.x.push_back(axis.scale * force.at[i]);
    series.y.push_back(force.force[k]);
    series.bandLow.push_back(force.force[k] - 2 * force.sd[k]);
    series.bandHigh.push_back(force.force[k] + 2 * force.sd[k]);
  }
  figure.series.push_back(std::move(series));
  return figure;
}

}  // namespace

std::vector<ReportPart> withoutName(const DiscoverFindings& f) {
  if (!f.verdict.unknown) return {};
  const info::discover::Unknown& u = *f.verdict.unknown;
  std::vector<ReportPart> parts;
  parts.emplace_back(
      Section{"Effect outside the catalogue",
              "A force that no effect of the catalogue describes, as the data show it."});
  parts.emplace_back(Paragraph{fmt::format(
      "The missing force{} has an RMS of {} {}; {} % of its power lies within 0.5 Hz of {} Hz.",
      f.wording.axes.size() > 1 ? " on " + f.wording.axes.at(u.axis).name : "",
      numberText(u.forceSize, 3), f.wording.axes.at(u.axis).forceUnit,
      numberText(100 * u.peakShare, 2), numberText(u.peakFrequency, 2))});
  if (!u.formula.empty()) parts.emplace_back(formulaOf(u));
  if (f.verdict.formula) parts.emplace_back(raced(f, *f.verdict.formula));
  if (f.verdict.nonparametric && f.verdict.nonparametric->wins) {
    const std::string better = fmt::format(
        "A free-form force of the {}{} alone explains the data better than {} (log Bayes factor {} "
        "nats)",
        followedBy(f, *f.verdict.nonparametric),
        f.wording.axes.size() > 1 ? " of " + f.wording.axes.at(f.verdict.nonparametric->axis).name
                                  : "",
        f.verdict.effects.empty() ? "the model without it" : "the effects above",
        numberText(f.verdict.nonparametric->ahead, 3));
    parts.emplace_back(Paragraph{
        better + (f.verdict.effects.empty() ? "." : ", which are probably only proxies.")});
    parts.emplace_back(curve(f, *f.verdict.nonparametric));
  }
  return parts;
}

std::string namesAgainstForces(const DiscoverFindings& f) {
  const auto& force = f.verdict.nonparametric;
  if (!force || force->wins || f.verdict.effects.empty()) return "";
  return fmt::format(
      "A free-form force (any smooth function of the {} or of the speed alone) is {} nats {}.",
      f.wording.axes.at(force->axis).position, numberText(std::abs(force->ahead), 3),
      force->ahead > 0 ? "better than the named effects, too little to doubt them"
                       : "worse than the named effects");
}

}  // namespace app
