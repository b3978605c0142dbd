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

int score(const hidden::Arguments& arguments) {
  if (arguments.words.size() != 2)
    throw std::invalid_argument("first and last seed are needed, e.g. 0 20");
  const std::uint64_t first = std::stoull(arguments.words[0]),
                      last = std::stoull(arguments.words[1]);
  reduced::Plan plan;
  plan.suite = arguments.text("suite", "null");
  plan.effect = arguments.text("only");
  plan.size = arguments.number("size", 1);
  plan.emgNoise = arguments.number("emg-noise", 0);
  plan.trials = static_cast<int>(arguments.number("trials", 4));
  plan.seconds = arguments.number("seconds", 4.6);
  const std::string& suite = plan.suite;
  const double size = plan.size, emgNoise = plan.emgNoise, step = arguments.number("step", 0.01);
  const bool verbose = arguments.has("verbose"), known = !arguments.has("estimate-sigma"),
             leaveOut = arguments.has("leave-out");
  Tally detected, top, visible, inClass, falseName, confident, coverage, both, unknown,
      structureNamed;
  std::vector<double> closed, seconds, floors;
  for (std::uint64_t seed = first; seed < last; ++seed) {
    plan.seed = seed;
    reduced::DataSet set;
    try {
      set = reduced::makeDataSet(plan);
    } catch (const std::domain_error&) {
      fmt::print("seed {}: the arm went out of range, left out\n", seed);
      continue;
    }
    const reduced::Recipe& recipe = set.recipe;
    const std::vector<std::string> truth = set.hidden();
    const std::vector<std::string> lacking =
        leaveOut ? set.explaining() : std::vector<std::string>{};
    const reduced::Elbow elbow(std::move(set.trials), lacking, step);
    Options options;
    if (known) options.outputSd = recipe.outputNoise;
    options.heldOut = {plan.trials - 1};
    options.latentTolerance = emgNoise > 0 ? 2 * emgNoise : 0.02;
    const auto begin = std::chrono::steady_clock::now();
    const Verdict v = run(elbow, options);
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());

    const auto& candidates = elbow.candidates();
    const bool says = v.finding == Finding::named || v.finding == Finding::ambiguous ||
                      v.finding == Finding::parameter;
    const auto isNamed = [&](const std::string& id, bool anywhere) {
      for (const NamedEffect& e : v.effects) {
        if (candidates[e.candidate].id == id) return true;
        const auto& mates = candidates[e.candidate].equivalents;
        for (const auto& m : mates)
          if (m == id) return true;  // a declared equivalent counts as right
        for (const std::size_t c : e.equals)
          if (anywhere && candidates[c].id == id) return true;
      }
      return false;
    };
    bool all = !truth.empty(), allClass = all;
    for (const auto& id : truth) {
      all = all && isNamed(id, false);
      allClass = allClass && isNamed(id, true);
    }
    bool structure = false;
    for (const NamedEffect& e : v.effects)
      structure = structure || candidates[e.candidate].kind != EffectKind::parameter;
    detected.count(v.finding != Finding::none);
    if (suite == "null") falseName.count(says);
    if (suite == "parameter") structureNamed.count(says && structure);
    if (suite == "out" || leaveOut)
      unknown.count(!says || v.finding == Finding::ambiguous || v.vetoed);
    else if (!truth.empty()) {
      const bool right = says && all && v.effects.size() == truth.size();
      top.count(right);
      if (truth.size() == 1 && suite != "parameter" &&
          std::abs(recipe.effects[0].second) >= leastVisible(v, candidates, truth[0]))
        visible.count(right);
      if (v.finding != Finding::none) inClass.count(allClass);
      confident.count(says && v.probability >= 0.95 && !allClass);
      if (truth.size() == 2) both.count(says && allClass);
      if (says && all && truth.size() == 1 && candidates[v.effects[0].candidate].id == truth[0] &&
          !v.effects[0].estimates.empty()) {
        const Estimate& e = v.effects[0].estimates[0];
        double value = recipe.effects[0].second;
        if (suite == "parameter") value = NAN;  // drawn about its tolerance too
        if (std::isfinite(value)) coverage.count(std::abs(e.value - value) < 1.96 * e.sd);
      }
    }
    if (v.heldOut && v.heldOut->closedFromCalibrated && says)
      closed.push_back(*v.heldOut->closedFromCalibrated);
    if (v.heldOut && says) floors.push_back(v.heldOut->after / v.heldOut->floor);
    if (verbose ||
        (suite != "null" && suite != "out" && !leaveOut &&
         !(says && all && v.effects.size() == truth.size())) ||
        ((suite == "out" || leaveOut) && says && v.finding != Finding::ambiguous) ||
        (suite == "null" && v.finding != Finding::none)) {
      std::string said, table;
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
      std::string hiddenEffects;
      for (const auto& [id, amount] : recipe.effects)
        hiddenEffects += fmt::format("{}={:.3g} ", id, amount);
      fmt::print(
          "seed {} truth {}: {}{} | NIS {:.3f} LB p {:.1e} in p {:.1e} σd {:.3f}→{:.3f} num "
          "{:.3f} held {} fits {} {:.1f}s |{}\n",
          seed, hiddenEffects, name(v.finding), said, v.after.meanSquare,
          v.after.ljungBoxProbability, v.after.inputProbability, v.latentSizeBefore,
          v.latentSizeAfter, v.numericalError,
          v.heldOut ? fmt::format("{:.2f}→{:.2f}", v.heldOut->calibrated / v.heldOut->floor,
                                  v.heldOut->after / v.heldOut->floor)
                    : std::string(),
          v.fits, seconds.back(), table);
      std::string remainder;
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
  }
  const auto median = [](std::vector<double> x) {
    if (x.empty()) return std::nan("");
    std::sort(x.begin(), x.end());
    return x[x.size() / 2];
  };
  fmt::print("suite {}, size {}, EMG noise {}, seeds {} to {}\n", suite, size, emgNoise, first,
             last - 1);
  print("found anything", detected);
  print("false names", falseName);
  print("structure named, only a parameter wrong", structureNamed);
  print("right name(s) first", top);
  print("– of effects that would have shown", visible);
  print("true name(s) in the class, of detected", inClass);
  print("both named", both);
  print("confidently wrong", confident);
  print("95 % interval covers the amplitude", coverage);
  print("not given an unqualified name", unknown);
  fmt::print("gap closed on the held-out trial: median {:.3f} of {}; error/floor {:.3f}\n",
             median(closed), closed.size(), median(floors));
  fmt::print("seconds per data set: median {:.1f}, most {:.1f}\n", median(seconds),
             seconds.empty() ? NAN : *std::max_element(seconds.begin(), seconds.end()));
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
