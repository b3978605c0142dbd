#include "discovery/verdict_sentence.h"

#include <fmt/format.h>

#include <cmath>

namespace info::discover {
namespace {

constexpr double kWorthSaying = 0.005;  // smallest σ_d that the sentence mentions
constexpr double kTied = 0.8;           // share of a force's power that is the same in all trials
constexpr double kStep = 0.8;           // share of its variance between two levels

class VerdictSentence {
 public:
  VerdictSentence(const DiscoveryProblem& data, const Verdict& verdict, const Options& options,
                  bool somethingChosen)
      : data_(data), verdict_(verdict), options_(options), somethingChosen_(somethingChosen) {}

  // The scatter attributed to noise of the inputs, on which the effects found depend.
  std::string scatter() const {
    if (verdict_.latentSizeAfter < kWorthSaying) return "";
    return fmt::format(" {:.2g} % of the inputs' effect is attributed to input noise.",
                       100 * verdict_.latentSizeAfter);
  }

  std::string farOff() const {
    if (verdict_.remainder) return "";  // what is left is told
    if (!verdict_.heldOut || !verdict_.heldOut->probability ||
        !(*verdict_.heldOut->probability < options_.farOff))
      return "";
    return fmt::format(
        " However, the held-out errors are larger than expected by chance (p = {:.1g}).",
        *verdict_.heldOut->probability);
  }

  std::string vague() const {
    if (!verdict_.heldOut || !verdict_.heldOut->isVague(options_.vague)) return "";
    return fmt::format(
        " The held-out trials confirm little: they are predicted no better than to {:.1f} times "
        "their noise.",
        *verdict_.heldOut->expected / verdict_.heldOut->floor);
  }

  // What the effects do not explain, though they are named.
  std::string reserved() const {
    if (!verdict_.remainder) return "";
    return fmt::format(
               " {:.1f} % of the excess error of the held-out trials is explained, but what is "
               "left of the fitted trials is not noise.",
               100 * *verdict_.heldOut->closedFromCalibrated) +
           cause() + nonparametric();
  }

  // That the held-out trials show the same effects, though not with the same parameters.
  std::string replicated() const {
    if (!verdict_.replication || !verdict_.replication->replicated) return "";
    std::string words;
    for (const Estimate& e : verdict_.replication->estimates) {
      const Quantity& quantity = data_.quantities()[e.quantity];
      words += fmt::format("{}{} = {:.3g} ± {:.1g}{}{}", words.empty() ? "" : ", ", quantity.name,
                           e.value, e.sd, quantity.unit.empty() ? "" : " ", quantity.unit);
    }
    return " The held-out trials, fitted by themselves, show the same (" + words +
           "), but not the parameters of the other trials.";
  }

  // The samples that were not used, and the reason.
  std::string samples() const {
    const RecordedNoise& noise = verdict_.noise;
    std::string words;
    if (noise.outliers > 0)
      words += fmt::format(" {} of {} samples are outliers and were left out.", noise.outliers,
                           noise.samples);
    if (noise.reduced < 1)
      words += fmt::format(
          " With the effects found, the residual was smaller than the first estimate of the noise; "
          "the search was repeated with {:.2g} times that.",
          noise.reduced);
    if (noise.spacing > 1)
      words += fmt::format(
          " The measurement noise is correlated, so only one sample in {:.2g} s was used.",
          noise.interval);
    return words;
  }

  std::string sentence() const {
    const auto& candidates = data_.candidates();
    std::string names;
    for (const NamedEffect& e : verdict_.effects) {
      std::string one;
      for (const std::size_t c : e.equals) one += (one.empty() ? "" : " or ") + candidates[c].name;
      if (e.equals.size() > 1 && verdict_.effects.size() > 1) one = "(" + one + ")";
      names += (names.empty() ? "" : ", and ") + one;
    }
    switch (verdict_.finding) {
      case Finding::none:
        return "No missing effect above the detectable size." + scatter() + farOff();
      case Finding::parameter:
        return "Parameter error: " + names + "." + scatter() + reserved() + farOff() + vague();
      case Finding::named:
      case Finding::ambiguous:
        return "Missing: " + names +
               (verdict_.vetoed && !verdict_.after.sized && !verdict_.remainder
                    ? "; the size of the residual does not match the noise."
                    : ".") +
               scatter() + replicated() + reserved() + farOff() + vague();
      case Finding::unknown:
        return "The model lacks an effect that is not in the catalogue." +
               (names.empty() ? std::string()
                              : " The closest match is " + names + atBounds() + ".") +
               cause() + tie() + nonparametric() +
               (verdict_.formula && verdict_.formula->wins
                    ? " The force " + verdict_.formula->text + on(verdict_.formula->axis) +
                          " explains the residual."
                    : "");
      case Finding::numerical:
        break;
    }
    return verdict_.sentence;
  }

  std::string cause() const {
    const Adequacy& left = somethingChosen_ ? verdict_.after : verdict_.before;
    if (left.causeless) return "";
    switch (left.remainder.strongest()) {
      case Cause::state:
        return " The residual depends on the angle and the speed.";
      case Cause::inputs:
        return " The residual depends on the inputs.";
      case Cause::acceleration:
        return " The residual depends on the acceleration, which suggests a wrong inertia.";
      case Cause::sensor:
        return " The residual depends on the sensor's reading, which suggests an error of the "
               "sensor.";
      case Cause::moments:
        return " The residual depends on the inputs' moments and the angle, which suggests wrong "
               "moment arms.";
    }
    return "";
  }

  std::string tie() const {
    if (!verdict_.unknown || verdict_.unknown->tie.share < kTied) return "";
    const TimeTie& tie = verdict_.unknown->tie;
    std::string words = fmt::format(
        " The missing force{} is tied to time: {:.0f} % of its power is the same in every trial",
        on(verdict_.unknown->axis), 100 * tie.share);
    if (tie.stepShare < kStep) return words + ".";
    const char* how = std::abs(tie.after) > 3 * std::abs(tie.before)   ? "begins"
                      : std::abs(tie.before) > 3 * std::abs(tie.after) ? "ends"
                                                                       : "changes";
    return words + fmt::format("; it {} at {:.1f} s.", how, tie.stepAt);
  }

  std::string nonparametric() const {
    if (!verdict_.nonparametric || !verdict_.nonparametric->wins) return "";
    return fmt::format(" A free-form force of the {} alone{} explains {}.",
                       name(verdict_.nonparametric->follows), on(verdict_.nonparametric->axis),
                       somethingChosen_ ? "the data better" : "part of the residual");
  }

  // Which axis, if there are several.
  std::string on(std::size_t axis) const {
    return data_.axes().size() > 1 ? " on " + data_.axes()[axis].name : "";
  }

  std::string atBounds() const {
    std::string quantities;
    for (const NamedEffect& e : verdict_.effects)
      for (const Estimate& estimate : e.estimates)
        if (estimate.atBound)
          quantities +=
              (quantities.empty() ? "" : ", ") + data_.quantities()[estimate.quantity].name;
    return quantities.empty() ? "" : " (at its bound: " + quantities + ")";
  }

 private:
  const DiscoveryProblem& data_;
  const Verdict& verdict_;
  const Options& options_;
  bool somethingChosen_;
};

}  // namespace

std::string verdictSentence(const DiscoveryProblem& data, const Verdict& verdict,
                            const Options& options, bool somethingChosen) {
  const VerdictSentence text(data, verdict, options, somethingChosen);
  return text.sentence() + text.samples();
}

}  // namespace info::discover
