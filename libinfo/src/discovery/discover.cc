#include "info/discovery/discover.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "discovery/finalists.h"
#include "discovery/judgement/held_out_trials.h"
#include "discovery/judgement/replication.h"
#include "discovery/judgement/step_error.h"
#include "discovery/likelihood/selected_samples.h"
#include "discovery/likelihood/watched_problem.h"
#include "discovery/nonparametric/nonparametric_force.h"
#include "discovery/nonparametric/race_formula.h"
#include "discovery/search/select.h"
#include "discovery/verdict_estimates.h"
#include "discovery/verdict_sentence.h"
#include "info/discovery/judgement/decide.h"
#include "info/discovery/judgement/expected_error.h"
#include "info/discovery/judgement/output_sd.h"
#include "info/discovery/search/needed_memory.h"

namespace info::discover {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr int kMostRepeated = 2;

// The state of run() from stage to stage.
class Work {
 public:
  Work(const DiscoveryProblem& data, const Options& options, RecordedNoise noise)
      : data_(data, [this] { return stopped_ || !options_.goOn || options_.goOn(); }),
        options_(options),
        trials_(fittedTrials(data, options)) {
    verdict_.noise = std::move(noise);
  }

  Verdict run(WarmStart* draft) {
    try {
      const WarmStart memory = draft != nullptr ? *draft : nullptr;
      if (memory != nullptr) verdict_.noise.reduce(memory->noiseReduced);
      search(memory.get(), draft);
      for (int i = 0; i < kMostRepeated && isOverestimated(); ++i) {
        verdict_.noise.reduce(std::sqrt(verdict_.after.meanSquare));
        fits_ += search_->fits();
        search(nullptr, draft);  // what was found with another noise is worth nothing
      }
      conclude();
      verdict_.reached = Stage::finished;
      report(Stage::finished, 1, "");
    } catch (const Stopped&) {
      stopped_ = true;
      forgetDecision();
      verdict_.sentence = "Stopped before the end" + keepWhatIsThere() + ".";
    }
    if (search_) verdict_.fits = fits_ + search_->fits() + nonparametricFits_;
    return verdict_;
  }

 private:
  void report(Stage stage, double fraction, const std::string& doing) {
    fraction_ = std::max(fraction_, fraction);
    if (options_.progress && !options_.progress({stage, fraction_, doing})) throw Stopped();
  }

  // No conclusion stands before it has been tested to the end.
  void forgetDecision() {
    verdict_.finding = Finding::none;
    verdict_.effects.clear();
    verdict_.probability = 0;
    verdict_.vetoed = verdict_.surrogate = false;
    verdict_.remainder.reset();
  }

  // The fits before the search was stopped, and the score map of the base model. The sentence names
  // the leader.
  std::string keepWhatIsThere() {
    if (!search_ || search_->entries().count({}) == 0 || !search_->at({}).works()) return "";
    judge();
    const Entry& entry = search_->at({});
    const Fit& map = entry.simulation ? *entry.simulation : entry.fit;
    if (entry.fit.noise.latent > 0)
      verdict_.localisation = localise(search_->likelihood(), map, entry.fit, mapOptions());
    const auto best = std::max_element(
        verdict_.finalists.begin(), verdict_.finalists.end(),
        [](const Finalist& a, const Finalist& b) { return a.logEvidence < b.logEvidence; });
    if (best->effects.empty()) return "";
    std::set<std::size_t> tried;
    for (const Finalist& f : verdict_.finalists) tried.insert(f.effects.begin(), f.effects.end());
    return fmt::format(
        "; of {} hypotheses fitted so far, with {} of {} effects, {} leads, with a log Bayes "
        "factor "
        "of {:.1f} nats against the base model",
        verdict_.finalists.size() - 1, tried.size(), data_.candidates().size(),
        describe(data_, best->effects), best->logEvidence);
  }

  LocaliseOptions mapOptions() const { return {0.25, 8, 6, options_.falseDiscoveries}; }

  void prepare(const SearchMemory* memory) {
    AdequacyOptions& test = test_;
    test.level = options_.level;
    test.evidence = options_.remainder;
    if (options_.sds) {
      verdict_.sds = *options_.sds;
    } else {
      const OutputSd& found = verdict_.noise.sd;
      verdict_.sds = found.value;
      verdict_.sdEstimated = true;
      test.sdError = found.relativeError;
    }
    stage_ = Stage::calibrate;
    search_.emplace(data_, trials_, options_, verdict_.sds, [this](const std::string& doing) {
      report(stage_, fraction_ + 0.5 * (0.9 - fraction_) * 0.05, doing);
    });
    if (memory != nullptr)
      search_->adopt(*memory);
    else
      search_->calibrate();
    base();
    verdict_.reached = Stage::localise;
    report(Stage::localise, 0.2, "");
  }

  void search(const SearchMemory* memory, WarmStart* draft) {
    prepare(memory);
    stage_ = Stage::race;
    report(Stage::screen, 0.25, "");
    chosen_ = select(*search_, options_);
    search_->refineEvidence(chosen_, options_.classWidth);
    if (draft != nullptr)
      *draft = std::make_shared<const SearchMemory>(
          SearchMemory{search_->entries(), chosen_, search_->scaleValues(),
                       search_->hasRacedFromNominal(), verdict_.noise.reduced});
    judge();
    tooLong_ = stepsTooLong();
  }

  bool isFinal() const { return tooLong_.empty() || options_.concludesNumerical; }

  // Whether the residual is much smaller than the noise that was estimated, as where errors of the
  // model passed for correlated noise.
  bool isOverestimated() const {
    if (options_.sds || !data_.outputOfSample(0).empty() || !isFinal()) return false;
    const double square = verdict_.after.meanSquare;
    return square > 0 && square < options_.overestimated &&
           std::sqrt(square) * verdict_.sds.sd(0) > verdict_.noise.leastSd();
  }

  // If a simulation depends on its time step, no conclusion about the system is certain. Tested
  // with the final effects: a base model with a missing effect may diverge, and then every step is
  // too long. Returns what is to be said, if it is so.
  std::string stepsTooLong() {
    const StepError error =
        stepError(data_, trials_, search_->simulation(chosen_).values, verdict_.sds);
    verdict_.numericalError = error.largest;
    if (error.largest <= options_.numericalTolerance) return "";
    return fmt::format(
        "Halving the time step changes the simulation of {} by {:.2g} standard deviations of the "
        "measurement noise: use shorter steps.",
        data_.trialName(error.trial), error.largest);
  }

  // What was found with steps that are too long is told, not trusted.
  void reserveForSteps() {
    verdict_.finding = Finding::numerical;
    verdict_.vetoed = !verdict_.effects.empty() && !verdict_.surrogate;
    verdict_.probability = 0;
    verdict_.sentence =
        verdict_.effects.empty() ? tooLong_ : tooLong_ + " With these steps: " + verdict_.sentence;
  }

  void base() {
    const Entry& entry = search_->at({});
    verdict_.base = entry.fit.values;
    verdict_.values = entry.fit.values;
    verdict_.latentSizeBefore = verdict_.latentSizeAfter = entry.fit.noise.latent;
    verdict_.before = verdict_.after = adequacy(search_->likelihood(), entry.fit, test_);
    verdict_.calibration = verdict_.nuisancesAfter =
        estimatesOf(entry.fit, data_.nuisances(), data_);
  }

  void judge() {
    verdict_.finalists = finalistsOf(*search_);
    base();  // a better base may have been found since
    const Entry& leader = search_->at(chosen_);
    if (!chosen_.empty()) {
      verdict_.after = adequacy(search_->likelihood(), leader.fit, test_);
      verdict_.values = leader.fit.values;
      verdict_.latentSizeAfter = leader.fit.noise.latent;
      verdict_.nuisancesAfter = estimatesOf(leader.fit, data_.nuisances(), data_);
    }
    for (Finalist& f : verdict_.finalists) {
      if (f.effects == chosen_) f.adequate = verdict_.after.adequate();
      if (f.effects.empty()) f.adequate = verdict_.before.adequate();
    }
  }

  void conclude() {
    stage_ = Stage::decide;
    report(Stage::decide, 0.9, "");
    const Entry& before = search_->at({});
    const Entry& after = search_->at(chosen_);
    Judgement judgement;
    judgement.raced = verdict_.finalists;
    judgement.chosen = chosen_;
    judgement.before = verdict_.before;
    judgement.after = verdict_.after;
    judgement.latentBefore = verdict_.latentSizeBefore;
    judgement.latentAfter = verdict_.latentSizeAfter;
    const Estimate* worst = farthestFromPrior(verdict_.calibration, data_);
    if (worst != nullptr) judgement.priorZ = std::abs(worst->priorZ);

    addMoves(search_->likelihood(), after.fit, verdict_.nuisancesAfter);
    gaps(before, after, judgement);
    judgement.explained = verdict_.excess.closedFromCalibrated;
    judgement.heldOutExplained =
        verdict_.heldOut ? verdict_.heldOut->closedFromCalibrated : std::nullopt;
    if (!isFinal()) return reserveForSteps();
    Decision decision = decide(data_.candidates(), judgement, options_);
    const Fit smoothing =
        before.fit.noise.latent > 0 ? before.fit : refit(before, options_.latentScale);
    if (options_.symbolic && (!chosen_.empty() || decision.finding == Finding::unknown)) {
      verdict_.nonparametric = raceNonparametric(
          *search_, chosen_, smoothing, options_, verdict_.sds,
          [this](const std::string& doing) { report(stage_, fraction_, doing); },
          nonparametricFits_);
      judgement.nonparametricWins = verdict_.nonparametric && verdict_.nonparametric->wins;
      if (judgement.nonparametricWins) decision = decide(data_.candidates(), judgement, options_);
    }
    verdict_.finding = decision.finding;
    verdict_.effects = decision.effects;
    verdict_.probability = decision.probability;
    verdict_.vetoed = decision.vetoed;
    verdict_.surrogate = decision.surrogate;
    if (decision.reserved)
      verdict_.remainder =
          strongestForce(search_->likelihood(), refit(after, options_.latentScale));
    collectRivals();
    if (decision.finding == Finding::parameter && decision.effects.empty())
      verdict_.effects = evidentError(*worst, data_);

    // score map of the base model, with the scatter of inputs estimated together with the effects
    const bool small = before.fit.noise.latent <= options_.latentTolerance;
    const bool trusted = decision.finding != Finding::unknown && !chosen_.empty();
    Fit map = search_->simulation({});
    if (trusted && after.fit.noise.latent > 0)
      map = refit(before, after.fit.noise.latent);
    else if (decision.finding == Finding::none && small)
      map = before.fit;
    verdict_.localisation = localise(search_->likelihood(), map, smoothing, mapOptions());
    for (const Screened& s : search_->screen(chosen_, false))
      verdict_.detectability.push_back(
          {s.candidate, s.information > 0 ? 5 / std::sqrt(s.information) : HUGE_VAL});
    std::sort(verdict_.detectability.begin(), verdict_.detectability.end(),
              [](const Detectable& a, const Detectable& b) { return a.candidate < b.candidate; });
    if (decision.finding == Finding::unknown && options_.symbolic) {
      verdict_.unknown = describeUnknown(search_->likelihood(), smoothing);
      verdict_.formula = raceFormula(*search_, *verdict_.unknown, chosen_, optionsOfFormula());
    }
    verdict_.sentence = verdictSentence(data_, verdict_, options_, !chosen_.empty());
    if (!tooLong_.empty()) reserveForSteps();
  }

  void collectRivals() {
    for (const NamedEffect& named : verdict_.effects)
      for (const std::size_t rival : named.equals) {
        if (rival == named.candidate) continue;
        const auto entry = search_->entries().find(with(without(chosen_, named.candidate), rival));
        if (entry != search_->entries().end() && entry->second.works())
          verdict_.rivals.push_back(entry->second.fit);
      }
    if (!verdict_.rivals.empty())
      verdict_.rivals.insert(verdict_.rivals.begin(), search_->at(chosen_).fit);
  }

  // The formula is compared last.
  Options optionsOfFormula() const {
    Options options = options_;
    options.sds = verdict_.sds;
    if (options_.progress)
      options.progress = [this, from = fraction_](const Progress& now) {
        return options_.progress({Stage::decide, from + now.fraction * (0.97 - from), now.doing});
      };
    return options;
  }

  Fit refit(const Entry& entry, double size) const {
    const Fit& old = entry.fit;
    const Noise noise{verdict_.sds, size, options_.latentTime};
    const Likelihood& likelihood = search_->likelihood();
    if (auto fit = likelihood.tryFit(old.hypothesis, noise, old.values)) return std::move(*fit);
    // the simulation follows the data only because of its latent force
    return likelihood.fit(old.hypothesis, noise, old.values,
                          forceKept(old.eta, old.noise.latent, size));
  }

  void gaps(const Entry& before, const Entry& after, Judgement& judgement) {
    ExcessError& excess = verdict_.excess;
    excess.floor = verdict_.sds.sd(0);
    excess.range = rangeOf(data_, trials_, verdict_.sds);
    const Noise still{verdict_.sds, 0, options_.latentTime};
    const Likelihood& likelihood = search_->likelihood();
    excess.nominal = nominalError(likelihood, still);
    excess.calibrated = likelihood.simulationError(search_->simulation({}).values, still.output);
    excess.after = likelihood.simulationError(search_->simulation(chosen_).values, still.output);
    explainExcess(excess);
    if (options_.heldOut.empty()) return;
    std::vector<int> every;
    for (int t = 0; t < data_.numTrials(); ++t) every.push_back(t);
    const VectorXd& scale = search_->scaleValues();
    const Likelihood all(data_, every, scale, options_.latentTime);
    const Likelihood held(data_, options_.heldOut, scale, options_.latentTime);
    const HeldOutTrials without = heldOutTrials(data_, *search_, before, all, held);
    const HeldOutTrials with =
        chosen_.empty() ? without : heldOutTrials(data_, *search_, after, all, held);
    keepStarts(without, verdict_.base);
    verdict_.heldOutStarts = keepStarts(with, verdict_.values);
    ExcessError other;
    other.floor = excess.floor;
    other.range = excess.range;
    other.nominal = nominalError(held, still);
    other.calibrated = without.error;
    other.after = with.error;
    if (with.starts) {
      const ExpectedError expected = expectedError(held, *with.starts, after.fit);
      other.expected = expected.rms;
      other.probability = expected.probability(with.error);
    }
    explainExcess(other);
    verdict_.heldOut = other;
    verdict_.heldOutBefore = heldOutAdequacy(without.meanSquare, held.samples(), test_);
    verdict_.heldOutAfter = chosen_.empty()
                                ? verdict_.heldOutBefore
                                : heldOutAdequacy(with.meanSquare, held.samples(), test_);
    judgement.strangeBefore = !verdict_.heldOutBefore->expected();
    judgement.strangeAfter = !verdict_.heldOutAfter->expected();
    judgement.heldOutFarOff = other.probability && *other.probability < options_.farOff;
    judgement.heldOutVague = !chosen_.empty() && other.isVague(options_.vague);
    // by more than chance; since the evidence is inaccurate for a base model that fits badly, the
    // simulation must be no worse either
    judgement.heldOutWorse =
        !chosen_.empty() && with.score < without.score - 3 && with.error > 0.95 * without.error;
    if (!chosen_.empty() && (judgement.strangeAfter || judgement.heldOutWorse)) {
      verdict_.replication =
          replicate(data_, options_, verdict_.sds, after,
                    [this](const std::string& doing) { report(stage_, fraction_, doing); });
      judgement.replicated = verdict_.replication && verdict_.replication->replicated;
    }
  }

  // Sets the initial states of the held-out trials.
  std::vector<Estimate> keepStarts(const HeldOutTrials& held, VectorXd& values) const {
    if (!held.starts) return {};
    std::vector<std::size_t> starts;
    for (const FreeQuantity& free : held.starts->hypothesis.free) {
      starts.push_back(free.quantity);
      const auto q = static_cast<Index>(free.quantity);
      values[q] = held.starts->values[q];
    }
    return estimatesOf(*held.starts, starts, data_);
  }

  WatchedProblem data_;
  const Options& options_;
  bool stopped_ = false;
  std::vector<int> trials_;
  AdequacyOptions test_;
  std::optional<Search> search_;
  Effects chosen_;
  Stage stage_ = Stage::calibrate;
  double fraction_ = 0;
  std::string tooLong_;  // what is to be said of the time step, if anything
  int fits_ = 0;         // of earlier searches
  int nonparametricFits_ = 0;
  Verdict verdict_;
};

}  // namespace

Verdict run(const DiscoveryProblem& data, const Options& options, WarmStart* draft) {
  const std::vector<int> trials = fittedTrials(data, options);
  requireMemory(data, trials, availableMemory());
  RecordedNoise noise;
  if (options.judgeSamples)
    noise = recordedNoise(data, trials, options.sds);
  else if (!options.sds)
    noise.sd = estimateOutputSd(data, trials);
  if (noise.usesAll()) return Work(data, options, std::move(noise)).run(draft);
  const SelectedSamples selected(data, noise.kept);
  return Work(selected, options, std::move(noise)).run(draft);
}

}  // namespace info::discover
