#pragma once

#include <string>
#include <vector>

#include "score/outcome.h"
#include "score/wilson.h"

namespace hidden {

/// One line of the table: k of n, its interval, and its target.
struct Row {
  std::string metric;
  int k = 0, n = 0;
  std::string target;   ///< e.g. "≤ 2 %"
  double bound = 0;     ///< of the target
  bool atMost = false;  ///< the share is to be at most that, else at least
  bool met = false;     ///< by the share itself; false if n = 0
  std::vector<std::string> misses;
  Interval interval() const { return wilson(k, n); }
  /// Whether k is no further on the wrong side of the target than chance makes it: a tool that
  /// just meets the target p has n·p ± √(n·p(1 − p)) counted (binomial).
  ///     k ≤ n·p + d·√(n·p(1 − p)), or k ≥ n·p − d·√(n·p(1 − p))
  /// @param deviations d; true for n = 0
  bool within(double deviations) const;
};

/// What was hidden in a set and what was said of it, in one line.
std::string describe(const Outcome& outcome);

/// Medians and worst values of a quantity.
struct Spread {
  std::string metric, unit, target;
  std::vector<double> values;  ///< rising
  double median() const;       ///< NaN if empty
  double bound = 0;            ///< of the target
  bool atMost = false;         ///< the median is to be at most that, else at least
  bool met = false;
  /// The same for a median that just meets its target: how many of the values are on the right
  /// side is then binomial with p = 1/2, n/2 ± √n/2. Of up to four the binomial with two deviations
  /// would allow anything: there the median may miss the target by a factor of 1.5.
  /// @param deviations d; true without a value
  bool within(double deviations) const;
};

/// Whether probabilities mean what they say: names that are given with about the same one, beside
/// the share of them that is the truth.
struct Calibration {
  struct Bin {
    int n = 0;
    double probability = 0, right = 0;  ///< means
  };
  std::vector<Bin> bins;  ///< of [0, 0.1), …, [0.9, 1]; those without a name are left out
  int n = 0;
  double error = 0;  ///< expected calibration error, Σ n_b/n·|right − probability|
  /// The error of as many names with the same probabilities if each were right with just that one:
  /// mean, and what 19 of 20 such tables stay below (2000 draws)
  double chance = 0, chanceHighest = 0;
};

struct Score {
  std::vector<Row> rows;
  std::vector<Spread> spreads;
  Calibration calibration;
  Json asJson() const;
  std::string asMarkdown() const;
};

/// @param outcomes  of the suites that the targets are about
Score score(const std::vector<Outcome>& outcomes);

}  // namespace hidden
