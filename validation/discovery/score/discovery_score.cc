#include "score/discovery_score.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "generator/random_numbers.h"

namespace hidden {
namespace {

// A row whose k counts outcomes that `counts`; misses are those on the wrong side of the target.
template <class In, class Counts>
Row row(const std::vector<Outcome>& all, const std::string& metric, const std::string& target,
        double bound, bool atMost, In&& in, Counts&& counts) {
  Row r;
  r.metric = metric;
  r.target = target;
  r.bound = bound;
  r.atMost = atMost;
  for (const Outcome& o : all) {
    if (!in(o)) continue;
    const bool counted = counts(o);
    ++r.n;
    if (counted) ++r.k;
    if (counted == atMost) r.misses.push_back(describe(o));
  }
  const double share = r.n == 0 ? 0 : static_cast<double>(r.k) / r.n;
  r.met = r.n > 0 && (atMost ? share <= bound : share >= bound);
  return r;
}

template <class Value>
Spread spread(const std::vector<Outcome>& all, const std::string& metric, const std::string& unit,
              const std::string& target, double bound, bool atMost, Value&& value) {
  Spread s{metric, unit, target, {}, bound, atMost, false};
  for (const Outcome& o : all) {
    if (const std::optional<double> v = value(o)) s.values.push_back(*v);
  }
  std::sort(s.values.begin(), s.values.end());
  s.met = !s.values.empty() && (atMost ? s.median() <= bound : s.median() >= bound);
  return s;
}

}  // namespace

std::string describe(const Outcome& o) {
  const std::string truth =
      o.truth.empty() ? "nothing" : fmt::format("{}", fmt::join(o.truth, "+"));
  const std::string given =
      !o.hasVerdict
          ? "no verdict"
          : fmt::format(
                "{} [{}]{}", o.verdict, fmt::join(o.named, ", "),
                o.inClass.empty() ? "" : fmt::format(", class [{}]", fmt::join(o.inClass, ", ")));
  return fmt::format("{} ({}, size {:g}, EMG noise {:g}): {}; said: {}", o.name, o.suite, o.size,
                     o.emgNoise, truth, given);
}

bool Row::within(double deviations) const {
  const double expected = n * bound, slack = deviations * std::sqrt(n * bound * (1 - bound));
  return atMost ? k <= expected + slack : k >= expected - slack;
}

bool Spread::within(double deviations) const {
  const auto right = std::count_if(values.begin(), values.end(), [&](double value) {
    return atMost ? value <= bound : value >= bound;
  });
  const auto n = static_cast<double>(values.size());
  if (n == 0) return true;
  if (n <= 4) return atMost ? median() <= 1.5 * bound : median() >= bound / 1.5;
  return static_cast<double>(right) >= n / 2 - deviations * std::sqrt(n) / 2;
}

namespace {

struct Claim {
  double probability;
  bool right;
};

Calibration binned(const std::vector<Claim>& claims) {
  constexpr int parts = 10;
  std::vector<Calibration::Bin> bins(parts);
  Calibration c;
  for (const Claim& claim : claims) {
    auto& bin = bins[static_cast<std::size_t>(
        std::clamp(static_cast<int>(claim.probability * parts), 0, parts - 1))];
    ++bin.n;
    bin.probability += claim.probability;
    bin.right += claim.right;
  }
  for (Calibration::Bin& bin : bins) {
    if (bin.n == 0) continue;
    bin.probability /= bin.n, bin.right /= bin.n;
    c.n += bin.n;
    c.error += bin.n * std::abs(bin.right - bin.probability);
    c.bins.push_back(bin);
  }
  if (c.n > 0) c.error /= c.n;
  return c;
}

// Sets without a truth count: whatever is named there is wrong.
Calibration calibrationOf(const std::vector<Outcome>& outcomes) {
  std::vector<Claim> claims;
  for (const Outcome& o : outcomes) {
    if (!o.probability || *o.probability <= 0 || o.suite == "out") continue;  // 0: vetoed
    claims.push_back({*o.probability, o.firstIsTrue});
  }
  Calibration c = binned(claims);
  if (claims.empty()) return c;
  constexpr std::size_t draws = 2000;
  RandomNumbers random(1, 0);
  std::vector<double> errors;
  for (std::size_t draw = 0; draw < draws; ++draw) {
    for (Claim& claim : claims) claim.right = random.between(0, 1) < claim.probability;
    errors.push_back(binned(claims).error);
    c.chance += errors.back() / draws;
  }
  std::nth_element(errors.begin(), errors.begin() + draws * 19 / 20, errors.end());
  c.chanceHighest = errors[draws * 19 / 20];
  return c;
}

}  // namespace

double Spread::median() const {
  const std::size_t n = values.size();
  if (n == 0) return std::numeric_limits<double>::quiet_NaN();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

Score score(const std::vector<Outcome>& outcomes) {
  const auto of = [](const char* suite) {
    return [suite](const Outcome& o) { return o.suite == suite; };
  };
  const auto oneTruth = [](const Outcome& o) { return o.truth.size() == 1 && o.suite != "out"; };
  const auto withNoise = [&](bool noisy, bool full) {
    return [=](const Outcome& o) {
      return oneTruth(o) && (o.emgNoise > 0) == noisy && (o.size >= 0.99) == full;
    };
  };
  const auto firstIsRight = [](const Outcome& o) { return o.firstIsRight; };
  const auto hasZ = [](const Outcome& o) { return o.z.has_value(); };
  Score s;
  auto& r = s.rows;
  r.push_back(row(outcomes, "false alarms on null data", "≤ 2 %", 0.02, true, of("null"),
                  [](const Outcome& o) { return o.claims || !o.hasVerdict; }));
  r.push_back(row(outcomes, "structure named when only parameters are wrong", "≤ 2 %", 0.02, true,
                  of("parameter"),
                  [](const Outcome& o) { return o.namesStructure || !o.hasVerdict; }));
  r.push_back(row(outcomes, "right name first, clean EMG, full size", "≥ 97 %", 0.97, false,
                  withNoise(false, true), firstIsRight));
  r.push_back(row(outcomes, "right name first, clean EMG, smaller", "≥ 92 %", 0.92, false,
                  withNoise(false, false), firstIsRight));
  r.push_back(row(outcomes, "right name first, noisy EMG, full size", "≥ 85 %", 0.85, false,
                  withNoise(true, true), firstIsRight));
  r.push_back(row(
      outcomes, "of the first of these, single effects without parameters in error", "–", 0, false,
      [&](const Outcome& o) { return o.suite == "single" && withNoise(false, true)(o); },
      firstIsRight));
  const auto visible = [&](const auto& chosen) {
    return [=](const Outcome& o) { return chosen(o) && o.detectable; };
  };
  r.push_back(row(outcomes, "the same, clean, full size, not called too small to see", "–", 0,
                  false, visible(withNoise(false, true)), firstIsRight));
  r.push_back(row(outcomes, "the same, clean, smaller, not called too small to see", "–", 0, false,
                  visible(withNoise(false, false)), firstIsRight));
  r.push_back(row(outcomes, "the same, noisy, full size, not called too small to see", "–", 0,
                  false, visible(withNoise(true, true)), firstIsRight));
  r.push_back(row(outcomes, "right name first, noisy EMG, smaller", "–", 0, false,
                  withNoise(true, false), firstIsRight));
  r.push_back(row(
      outcomes, "truth inside the class, of those detected", "≥ 98 %", 0.98, false,
      [&](const Outcome& o) { return oneTruth(o) && o.claims; },
      [](const Outcome& o) { return o.classHasTruth; }));
  r.push_back(row(
      outcomes, "confidently wrong", "≤ 1 %", 0.01, true,
      [](const Outcome& o) { return o.suite != "out"; },
      [](const Outcome& o) { return o.confidentlyWrong(); }));
  r.push_back(row(outcomes, "two effects: both named", "≥ 85 %", 0.85, false, of("two"),
                  [](const Outcome& o) { return o.allNamed; }));
  r.push_back(row(outcomes, "out of catalogue: no unqualified name", "≥ 90 %", 0.9, false,
                  of("out"), [](const Outcome& o) { return o.hasVerdict && !o.unqualified; }));
  r.push_back(row(outcomes, "equivalents: given as a class of both", "100 %", 1, false,
                  of("equivalents"), [](const Outcome& o) { return o.asClass; }));
  r.push_back(row(outcomes, "equivalents after the follow-up: the one right name", "≥ 92 %", 0.92,
                  false, of("follow-up"), [](const Outcome& o) { return o.uniquelyRight; }));
  r.push_back(row(outcomes, "parameter within 2 sd of the truth", "–", 0, false, hasZ,
                  [](const Outcome& o) { return std::abs(*o.z) <= 2; }));
  Row coverage = row(outcomes, "95 % interval covers the truth", "90–98 %", 0.9, false, hasZ,
                     [](const Outcome& o) { return std::abs(*o.z) <= 1.959964; });
  coverage.met = coverage.met && coverage.k <= 0.98 * coverage.n;
  r.push_back(coverage);

  const auto hidden = [](const Outcome& o) { return !o.truth.empty() && o.suite != "out"; };
  const auto clean = [&](const Outcome& o) { return hidden(o) && !(o.emgNoise > 0) && o.claims; };
  s.spreads.push_back(
      spread(outcomes, "gap closed on the held-out trial", "", "median ≥ 0.97", 0.97, false,
             [&](const Outcome& o) { return hidden(o) ? o.gapClosed : std::nullopt; }));
  s.spreads.push_back(
      spread(outcomes, "held-out error over the noise floor", "", "median ≤ 1.03", 1.03, true,
             [&](const Outcome& o) { return hidden(o) ? o.overFloor : std::nullopt; }));
  s.spreads.push_back(
      spread(outcomes, "the same, clean EMG, as verdicts expect it", "", "–", 0, false,
             [&](const Outcome& o) { return clean(o) ? o.expectedOverFloor : std::nullopt; }));
  s.spreads.push_back(
      spread(outcomes, "the same, clean EMG, as it is", "", "–", 0, false,
             [&](const Outcome& o) { return clean(o) ? o.overFloor : std::nullopt; }));
  s.spreads.push_back(spread(outcomes, "time per data set", "s", "≤ 60 s", 60, true,
                             [](const Outcome& o) { return o.seconds; }));
  s.calibration = calibrationOf(outcomes);
  Spread& time = s.spreads.back();
  time.met = !time.values.empty() && time.values.back() <= 60;
  return s;
}

Json Score::asJson() const {
  Json json = {{"shares", Json::array()}, {"spreads", Json::array()}};
  for (const Row& r : rows) {
    const Interval i = r.interval();
    json["shares"].push_back({{"metric", r.metric},
                              {"k", r.k},
                              {"n", r.n},
                              {"share", r.n > 0 ? Json(static_cast<double>(r.k) / r.n) : Json()},
                              {"wilson_low", i.low},
                              {"wilson_high", i.high},
                              {"target", r.target},
                              {"met", r.n > 0 ? Json(r.met) : Json()},
                              {"misses", r.misses}});
  }
  for (const Spread& s : spreads) {
    const bool any = !s.values.empty();
    json["spreads"].push_back({{"metric", s.metric},
                               {"unit", s.unit},
                               {"n", s.values.size()},
                               {"median", any ? Json(s.median()) : Json()},
                               {"least", any ? Json(s.values.front()) : Json()},
                               {"greatest", any ? Json(s.values.back()) : Json()},
                               {"target", s.target},
                               {"met", any ? Json(s.met) : Json()}});
  }
  json["calibration"] = {{"n", calibration.n},
                         {"error", calibration.error},
                         {"error_by_chance", calibration.chance},
                         {"error_by_chance_95", calibration.chanceHighest}};
  for (const Calibration::Bin& bin : calibration.bins)
    json["calibration"]["bins"].push_back(
        {{"n", bin.n}, {"probability", bin.probability}, {"right", bin.right}});
  return json;
}

std::string Score::asMarkdown() const {
  std::string text =
      "| metric | k of n | share | 95 % interval | target | met |\n"
      "|---|---|---|---|---|---|\n";
  const auto yes = [](bool any, bool met) { return !any ? "–" : met ? "yes" : "no"; };
  for (const Row& r : rows) {
    const Interval i = r.interval();
    text += r.n == 0 ? fmt::format("| {} | 0 of 0 | – | – | {} | – |\n", r.metric, r.target)
                     : fmt::format("| {} | {} of {} | {:.1f} % | {:.1f}–{:.1f} % | {} | {} |\n",
                                   r.metric, r.k, r.n, 100.0 * r.k / r.n, 100 * i.low, 100 * i.high,
                                   r.target, r.target == "–" ? "–" : yes(true, r.met));
  }
  text +=
      "\n| metric | n | median | least – greatest | target | met |\n|---|---|---|---|---|---|\n";
  for (const Spread& s : spreads) {
    const bool any = !s.values.empty();
    text += any ? fmt::format("| {} | {} | {:.4g} {} | {:.4g} – {:.4g} | {} | {} |\n", s.metric,
                              s.values.size(), s.median(), s.unit, s.values.front(),
                              s.values.back(), s.target, s.target == "–" ? "–" : yes(any, s.met))
                : fmt::format("| {} | 0 | – | – | {} | – |\n", s.metric, s.target);
  }
  if (calibration.n > 0) {
    text += fmt::format(
        "\nProbability of the first name and share of first names that are the truth itself "
        "({} names, calibration error {:.3f}, target ≤ 0.05; true probabilities would give {:.3f}, "
        "19 times of 20 below {:.3f}):",
        calibration.n, calibration.error, calibration.chance, calibration.chanceHighest);
    for (const auto& bin : calibration.bins)
      text += fmt::format(" {:.2f}: {:.2f} of {};", bin.probability, bin.right, bin.n);
    text.back() = '.';
    text += '\n';
  }
  text += "\nMisses\n\n";
  for (const Row& r : rows) {
    for (const std::string& miss : r.misses) text += fmt::format("- {}: {}\n", r.metric, miss);
  }
  return text;
}

}  // namespace hidden
