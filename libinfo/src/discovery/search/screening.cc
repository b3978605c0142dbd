#include <algorithm>
#include <cmath>
#include <set>

#include "discovery/search/search.h"

// Predictions from existing fits: of candidates that have not been fitted, and of effects that
// have.

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// with so large a latent force the base model is too far from the data for linear steps
constexpr double kPoor = 0.2;
// Candidates with several minima that are raced first, whatever a linear step promises.
constexpr std::size_t kGrids = 3;

}  // namespace

std::vector<Screened> Search::screen(const Effects& effects, bool simulation) const {
  const Entry& entry = at(effects);
  const Fit& fit = simulation ? entry.simulation.value() : entry.fit;
  auto& [of, result] = screened_[{effects, simulation}];
  // sizes are the same where σ_d is
  const bool isKnown = !result.empty() && of.noise.latent == fit.noise.latent &&
                       of.values == fit.values && of.xi == fit.xi && of.eta == fit.eta &&
                       of.atBound == fit.atBound;
  if (isKnown) return result;
  result = screenAt(*likelihood_, fit, effects);
  of = fit;
  return result;
}

std::vector<Screened> Search::screenAt(const Likelihood& likelihood, const Fit& fit,
                                       const Effects& effects) const {
  std::vector<Screened> result;
  const auto& candidates = data_.candidates();
  // candidates with several starting values of shape parameters are evaluated once for each
  std::size_t rounds = 1;
  const auto roundsOf = [](const Candidate& c) {
    return c.quantities.size() > 1 ? c.starts.size() : 1;
  };
  for (const Candidate& c : candidates) rounds = std::max(rounds, roundsOf(c));
  // of the first round: the others differ in effects that are absent
  std::vector<Likelihood::Linear> linear;
  Fit bare = fit;
  bare.hypothesis.free.clear();
  for (std::size_t round = 0; round < rounds; ++round) {
    std::vector<std::size_t> which, amplitudes;
    VectorXd values = fit.values;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      if (std::find(effects.begin(), effects.end(), c) != effects.end()) continue;
      if (roundsOf(candidates[c]) <= round) continue;
      which.push_back(c);
      amplitudes.push_back(candidates[c].quantities[0]);
      // shape parameters at this start, the amplitude 0
      for (std::size_t i = 1; i < candidates[c].quantities.size(); ++i) {
        const std::size_t q = candidates[c].quantities[i];
        if (fit.hypothesis.indexOf(q) < 0)
          values[static_cast<Index>(q)] = candidates[c].starts[round][static_cast<Index>(i)];
      }
    }
    if (which.empty()) continue;  // all candidates have been chosen
    std::vector<MatrixXd> columns;
    for (std::size_t t = 0; t < trials_.size(); ++t) {
      const bool isFirst = linear.size() == t;
      Likelihood::Linear one =
          likelihood.linearise(t, isFirst ? fit : bare, values, amplitudes, false);
      columns.push_back(one.extra);
      if (isFirst) linear.push_back(std::move(one));
    }
    const auto projected = likelihood.project(fit, linear, columns);
    for (std::size_t i = 0; i < which.size(); ++i) {
      const Candidate& c = candidates[which[i]];
      const Quantity& q = data_.quantities()[c.quantities[0]];
      double variance = c.sds[0] * c.sds[0];
      double g = projected.score[static_cast<Index>(i)];
      double S = projected.information(static_cast<Index>(i), static_cast<Index>(i));
      const int there = fit.hypothesis.indexOf(c.quantities[0]);
      if (q.logarithmic) {
        const double value = values[static_cast<Index>(c.quantities[0])];
        g *= value;
        S *= value * value;
      }
      if (there >= 0) {
        // wider prior of a free parameter: equivalent to a disturbance with the additional variance
        const double narrow = fit.hypothesis.free[static_cast<std::size_t>(there)].sd;
        variance = std::max(0.0, variance - narrow * narrow);
      }
      const double growth = 1 + variance * std::max(S, 0.0);
      const bool blocked = there < 0 && q.lower >= q.nominal && g < 0;
      Screened s;
      s.candidate = which[i];
      s.gain = (blocked ? 0 : 0.5 * variance * g * g / growth) - 0.5 * std::log(growth);
      s.information =
          std::max(projected.information(static_cast<Index>(i), static_cast<Index>(i)), 0.0);
      if (!std::isfinite(s.gain)) {  // no derivative here
        s.gain = -HUGE_VAL;
        s.information = 0;
      }
      const auto known = std::find_if(result.begin(), result.end(), [&](const Screened& r) {
        return r.candidate == s.candidate;
      });
      if (known == result.end())
        result.push_back(s);
      else if (s.gain > known->gain)
        *known = s;
    }
  }
  std::sort(result.begin(), result.end(),
            [](const Screened& a, const Screened& b) { return a.gain > b.gain; });
  return result;
}

std::vector<Screened> Search::probe(const Effects& effects) {
  const Fit base = at(effects).fit;
  std::vector<Screened> result;
  for (std::size_t c = 0; c < data_.candidates().size(); ++c) {
    if (std::find(effects.begin(), effects.end(), c) != effects.end()) continue;
    report_(describe(data_, with(effects, c)));
    const Hypothesis hypothesis = makeHypothesis(data_, with(effects, c), trials_);
    Screened s{c, -HUGE_VAL, 0};
    for (std::size_t start = 0; start < data_.candidates()[c].starts.size(); ++start) {
      const auto fit = likelihood_->tryFit(hypothesis, base.noise, started(c, start, base.values),
                                           base.eta, {4, 0.1});
      ++fits_;
      if (!fit) continue;
      s.gain = std::max(s.gain, fit->logEvidence - base.logEvidence);
      s.information = 1;
    }
    result.push_back(s);
  }
  std::sort(result.begin(), result.end(),
            [](const Screened& a, const Screened& b) { return a.gain > b.gain; });
  return result;
}

std::vector<std::size_t> Search::shortlist(const Effects& effects, int most) {
  this->simulation(effects);
  const bool poor = at(effects).fit.noise.latent > kPoor;
  const auto held = screenHeld(effects);
  const auto filter = !poor ? screen(effects, false) : held.empty() ? probe(effects) : held;
  const auto simulation = screen(effects, true);
  std::vector<std::size_t> list;
  const auto add = [&](const Screened& s) {
    if (s.information > 0 && std::find(list.begin(), list.end(), s.candidate) == list.end())
      list.push_back(s.candidate);
  };
  // a linear step sees only the nearest of several minima
  const auto addGrids = [&] {
    std::size_t left = kGrids;
    for (const Screened& s : filter) {
      if (left == 0) return;
      if (!isGrid(data_.candidates()[s.candidate])) continue;
      add(s);
      --left;
    }
  };
  // candidates are taken from all modes in turn
  for (std::size_t i = 0; i < filter.size(); ++i)
    for (const auto* mode : {&filter, &simulation, &held})
      if (i < mode->size() && static_cast<int>(list.size()) < most - 2) add((*mode)[i]);
  if (most >= 6) {
    std::set<EffectKind> kinds;
    for (const std::size_t c : list) kinds.insert(data_.candidates()[c].kind);
    for (const Screened& s : filter)
      if (kinds.insert(data_.candidates()[s.candidate].kind).second) add(s);
  }
  if (effects.empty()) addGrids();
  const std::vector<std::size_t> touched = list;
  for (const std::size_t c : touched)
    for (const std::string& id : data_.candidates()[c].equivalents)
      for (const Screened& s : filter)
        if (data_.candidates()[s.candidate].id == id) add(s);
  return list;
}

double Search::significance(const Entry& entry, std::size_t effect) const {
  const std::size_t amplitude = data_.candidates()[effect].quantities[0];
  const int i = entry.fit.hypothesis.indexOf(amplitude);
  // its standard deviation for given shape parameters, which have no effect at amplitude 0
  std::vector<Index> own;
  for (const std::size_t q : data_.candidates()[effect].quantities) {
    const int k = entry.fit.hypothesis.indexOf(q);
    if (k == i || !entry.fit.atBound[static_cast<std::size_t>(k)]) own.push_back(k);
  }
  const MatrixXd covariance = entry.fit.covariance(own, own);
  const double variance = covariance(0, 0) > 0 ? 1 / covariance.inverse()(0, 0) : 0;
  const double sd =
      std::sqrt(variance) *
      std::abs(entry.fit.hypothesis.free[static_cast<std::size_t>(i)].slope(entry.fit.xi[i]));
  const double distance = std::abs(entry.fit.values[static_cast<Index>(amplitude)] -
                                   data_.quantities()[amplitude].nominal);
  return sd > 0 ? distance / sd : 0.0;
}

double Search::significance(const Entry& entry) const {
  if (!entry.works() || entry.effects.empty()) return 0;
  double least = 1e300;
  for (const std::size_t e : entry.effects) least = std::min(least, significance(entry, e));
  return least;
}

}  // namespace info::discover
