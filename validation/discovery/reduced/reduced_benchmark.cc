// Blind scoring of discovery on the reduced elbow: reduced_benchmark FIRST LAST --suite S …
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "generator/arguments.h"
#include "info/discovery/discover.h"
#include "reduced/reduced_plan.h"
#include "score/wilson.h"

namespace {

using namespace info::discover;

struct Tally {
  int hits = 0, of = 0;
  void count(bool hit) { hits += hit, ++of; }
};

// The least amplitude of an effect that would have shown: five deviations of the estimate where it
// was named, else what the verdict says.
double leastVisible(const Verdict& v, const std::vector<Candidate>& candidates,
                    const std::string& id) {
  for (const NamedEffect& e : v.effects)
    if (candidates[e.candidate].id == id && !e.estimates.empty()) return 5 * e.estimates[0].sd;
  for (const Detectable& d : v.detectability)
    if (candidates[d.candidate].id == id) return d.amplitude;
  return HUGE_VAL;
}

void print(const char* what, const Tally& tally) {
  if (tally.of == 0) return;
  const hidden::Interval interval = hidden::wilson(tally.hits, tally.of);
  fmt::print("{:<44} {:4d} / {:<4d} = {:5.1f} %   ({:.1f} … {:.1f})\n", what, tally.hits, tally.of,
             100.0 * tally.hits / tally.of, 100 * interval.low, 100 * interval.high);
}

/// What a verdict says of what was hidden.
struct Reading {
  std::vector<std::string> truth;
  bool says = false;      ///< it names something
  bool all = false;       ///< all that was hidden, or a declared equivalent of it, comes first
  bool allClass = false;  ///< or stands in the class of what comes first
  bool structure = false;
  bool isRight() const { return says && all; }
};

bool isNamed(const Verdict& v, const std::vector<Candidate>& candidates, const std::string& id,
             bool anywhere) {
  for (const NamedEffect& e : v.effects) {
    if (candidates[e.candidate].id == id) return true;
    for (const auto& mate : candidates[e.candidate].equivalents)
      if (mate == id) return true;  // a declared equivalent counts as right
    for (const std::size_t c : e.equals)
      if (anywhere && candidates[c].id == id) return true;
  }
  return false;
}

Reading read(const Verdict& v, const std::vector<Candidate>& candidates,
             std::vector<std::string> truth) {
  Reading reading;
  reading.says = v.finding == Finding::named || v.finding == Finding::ambiguous ||
                 v.finding == Finding::parameter;
  reading.all = reading.allClass = !truth.empty();
  for (const auto& id : truth) {
    reading.all = reading.all && isNamed(v, candidates, id, false);
    reading.allClass = reading.allClass && isNamed(v, candidates, id, true);
  }
  for (const NamedEffect& e : v.effects)
    reading.structure = reading.structure || candidates[e.candidate].kind != EffectKind::parameter;
  reading.truth = std::move(truth);
  return reading;
}

class Benchmark {
 public:
  explicit Benchmark(const hidden::Arguments& arguments)
      : step_(arguments.number("step", 0.01)),
        verbose_(arguments.has("verbose")),
        known_(!arguments.has("estimate-sigma")),
        leaveOut_(arguments.has("leave-out")) {
    plan_.suite = arguments.text("suite", "null");
    plan_.effect = arguments.text("only");
    plan_.size = arguments.number("size", 1);
    plan_.emgNoise = arguments.number("emg-noise", 0);
    plan_.trials = static_cast<int>(arguments.number("trials", 4));
    plan_.seconds = arguments.number("seconds", 4.6);
  }

  void score(std::uint64_t seed) {
    plan_.seed = seed;
    reduced::DataSet set;
    try {
      set = reduced::makeDataSet(plan_);
    } catch (const std::domain_error&) {
      fmt::print("seed {}: the arm went out of range, left out\n", seed);
      return;
    }
    const reduced::Recipe& recipe = set.recipe;
    const std::vector<std::string> lacking =
        leaveOut_ ? set.explaining() : std::vector<std::string>{};
    const reduced::Elbow elbow(std::move(set.trials), lacking, step_);
    Options options;
    if (known_) options.sds = recipe.outputNoise;
    options.heldOut = {plan_.trials - 1};
    options.latentTolerance = plan_.emgNoise > 0 ? 2 * plan_.emgNoise : 0.02;
    const auto begin = std::chrono::steady_clock::now();
    const Verdict v = run(elbow, options);
    seconds_.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    const Reading reading = read(v, elbow.candidates(), set.hidden());
    count(v, elbow.candidates(), reading, recipe);
    if (verbose_ || isWorthTelling(v, reading)) tell(v, elbow, recipe);
  }

  void tellTotals(std::uint64_t first, std::uint64_t last) const {
    const auto median = [](std::vector<double> x) {
      if (x.empty()) return std::nan("");
      std::sort(x.begin(), x.end());
      return x[x.size() / 2];
    };
    fmt::print("suite {}, size {}, EMG noise {}, seeds {} to {}\n", plan_.suite, plan_.size,
               plan_.emgNoise, first, last - 1);
    print("found anything", detected_);
    print("false names", falseName_);
    print("structure named, only a parameter wrong", structureNamed_);
    print("right name(s) first", top_);
    print("– of effects that would have shown", visible_);
    print("true name(s) in the class, of detected", inClass_);
    print("both named", both_);
    print("confidently wrong", confident_);
    print("95 % interval covers the amplitude", coverage_);
    print("not given an unqualified name", unknown_);
    fmt::print("gap closed on the held-out trial: median {:.3f} of {}; error/floor {:.3f}\n",
               median(closed_), closed_.size(), median(floors_));
    fmt::print("seconds per data set: median {:.1f}, most {:.1f}\n", median(seconds_),
               seconds_.empty() ? NAN : *std::max_element(seconds_.begin(), seconds_.end()));
  }

 private:
  bool hasNoName() const { return plan_.suite == "out" || leaveOut_; }

  void count(const Verdict& v, const std::vector<Candidate>& candidates, const Reading& r,
             const reduced::Recipe& recipe) {
    detected_.count(v.finding != Finding::none);
    if (plan_.suite == "null") falseName_.count(r.says);
    if (plan_.suite == "parameter") structureNamed_.count(r.says && r.structure);
    if (hasNoName()) {
      unknown_.count(!r.says || v.finding == Finding::ambiguous || v.vetoed);
    } else if (!r.truth.empty()) {
      countNames(v, candidates, r, recipe);
    }
    if (v.heldOut && v.heldOut->closedFromCalibrated && r.says)
      closed_.push_back(*v.heldOut->closedFromCalibrated);
    if (v.heldOut && r.says) floors_.push_back(v.heldOut->after / v.heldOut->floor);
  }

  void countNames(const Verdict& v, const std::vector<Candidate>& candidates, const Reading& r,
                  const reduced::Recipe& recipe) {
    const bool isOne = r.truth.size() == 1;
    const bool right = r.isRight() && v.effects.size() == r.truth.size();
    top_.count(right);
    if (isOne && plan_.suite != "parameter" &&
        std::abs(recipe.effects[0].second) >= leastVisible(v, candidates, r.truth[0]))
      visible_.count(right);
    if (v.finding != Finding::none) inClass_.count(r.allClass);
    confident_.count(r.says && v.probability >= 0.95 && !r.allClass);
    if (r.truth.size() == 2) both_.count(r.says && r.allClass);
    if (!r.isRight() || !isOne || candidates[v.effects[0].candidate].id != r.truth[0] ||
        v.effects[0].estimates.empty())
      return;
    const Estimate& e = v.effects[0].estimates[0];
    double value = recipe.effects[0].second;
    if (plan_.suite == "parameter") value = NAN;  // drawn about its tolerance too
    if (std::isfinite(value)) coverage_.count(std::abs(e.value - value) < 1.96 * e.sd);
  }

  bool isWorthTelling(const Verdict& v, const Reading& r) const {
    if (plan_.suite == "null") return v.finding != Finding::none;
    if (hasNoName()) return r.says && v.finding != Finding::ambiguous;
    return !(r.isRight() && v.effects.size() == r.truth.size());
  }

  void tell(const Verdict& v, const reduced::Elbow& elbow, const reduced::Recipe& recipe) const {
    const auto& candidates = elbow.candidates();
    std::string said, table, hiddenEffects, remainder;
    for (const NamedEffect& e : v.effects) {
      said += " [";
      for (std::size_t i = 0; i < e.equals.size(); ++i)
        said += fmt::format("{}{}", i ? "|" : "", candidates[e.equals[i]].id);
      said += fmt::format(" p={:.3f} B={:.1f}", e.probability, e.logBayesFactor);
      if (!e.estimates.empty())
        said += fmt::format(" {:.3g}±{:.2g}", e.estimates[0].value, e.estimates[0].sd);
      said += "]";
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(6, v.finalists.size()); ++i)
      table += fmt::format(" {}:{:.1f}(σd {:.3f})", describe(elbow, v.finalists[i].effects),
                           v.finalists[i].logEvidence, v.finalists[i].latentSize);
    for (const auto& [id, amount] : recipe.effects)
      hiddenEffects += fmt::format("{}={:.3g} ", id, amount);
    fmt::print(
        "seed {} truth {}: {}{} | NIS {:.3f} LB p {:.1e} in p {:.1e} σd {:.3f}→{:.3f} num "
        "{:.3f} held {} fits {} {:.1f}s |{}\n",
        plan_.seed, hiddenEffects, name(v.finding), said, v.after.meanSquare,
        v.after.ljungBoxProbability, v.after.inputProbability, v.latentSizeBefore,
        v.latentSizeAfter, v.numericalError,
        v.heldOut ? fmt::format("{:.2f}→{:.2f}", v.heldOut->calibrated / v.heldOut->floor,
                                v.heldOut->after / v.heldOut->floor)
                  : std::string(),
        v.fits, seconds_.back(), table);
    for (const Cause cause : kCauses)
      remainder += fmt::format(" {} {:.1f}", name(cause), v.after.remainder.of(cause));
    fmt::print("    what is left follows, nats:{}\n", remainder);
    if (v.nonparametric)
      fmt::print("    without a name: follows the {}, {:.1f} nats, {:.1f} ahead of the names\n",
                 info::discover::name(v.nonparametric->follows), v.nonparametric->logBayesFactor,
                 v.nonparametric->ahead);
    if (v.unknown)
      fmt::print("    formula {} (explains {:.2f}, stable {}), peak {:.1f} Hz share {:.2f}\n",
                 v.unknown->formula, v.unknown->explained, v.unknown->stable,
                 v.unknown->peakFrequency, v.unknown->peakShare);
    std::fflush(stdout);
  }

  reduced::Plan plan_;
  double step_;
  bool verbose_, known_, leaveOut_;
  Tally detected_, top_, visible_, inClass_, falseName_, confident_, coverage_, both_, unknown_,
      structureNamed_;
  std::vector<double> closed_, seconds_, floors_;
};

int score(const hidden::Arguments& arguments) {
  if (arguments.words.size() != 2)
    throw std::invalid_argument("first and last seed are needed, e.g. 0 20");
  const std::uint64_t first = std::stoull(arguments.words[0]),
                      last = std::stoull(arguments.words[1]);
  Benchmark benchmark(arguments);
  for (std::uint64_t seed = first; seed < last; ++seed) benchmark.score(seed);
  benchmark.tellTotals(first, last);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return score(hidden::Arguments(
        argc, argv, {"suite", "size", "emg-noise", "step", "only", "trials", "seconds"},
        {"leave-out", "estimate-sigma", "verbose"}));
  } catch (const std::exception& error) {
    fmt::print(stderr,
               "reduced_benchmark: {}\nusage: reduced_benchmark FIRST LAST [--suite null|single|"
               "parameter|two|equivalents|out] [--size s] [--emg-noise c] [--only id] "
               "[--trials n] [--seconds s] [--leave-out] [--estimate-sigma] [--verbose]\n",
               error.what());
    return 2;
  }
}
