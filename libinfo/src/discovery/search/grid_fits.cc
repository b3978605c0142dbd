#include <algorithm>
#include <cmath>

#include "discovery/search/search.h"
#include "discovery/search/search_tuning.h"
#include "info/estimation/nudge_stages.h"

// Candidates with several minima, whose amplitude is tried on a grid.

namespace info::discover {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// σ_d of a grid with a latent force: small enough to show what the candidate explains, large enough
// to keep the simulation near the data while the candidate is still wrong.
constexpr double kGridSize = 0.05;
// The best fit of the grid is continued with the amplitude free if it is this many nats
// above the base.
constexpr double kGridGain = 2;

}  // namespace

// The amplitude on its grid, then by golden section next to the best value, with the nuisance
// parameters fitted at each; a joint fit would be led to another minimum by the nuisance
// parameters.
Search::GridStart Search::searchGrid(std::size_t candidate, const Fit& base) const {
  const Likelihood& held = nudgedLikelihoods_[kHeldStage];
  const auto amplitude = static_cast<Index>(data_.candidates()[candidate].quantities[0]);
  GridStart best;
  const auto at = [&](double x) {
    VectorXd values = base.values;
    values[amplitude] = x;
    const auto fit = held.tryFit(base.hypothesis, base.noise, values, {}, {2, 0.3});
    const double gain = fit ? fit->logEvidence - base.logEvidence : -HUGE_VAL;
    if (gain > best.gain) best = {fit->values, gain};
    return gain;
  };
  std::vector<double> grid = {data_.quantities()[static_cast<std::size_t>(amplitude)].nominal};
  for (const VectorXd& start : data_.candidates()[candidate].starts) grid.push_back(start[0]);
  std::sort(grid.begin(), grid.end());
  std::size_t top = 0;
  double most = -HUGE_VAL;
  for (std::size_t k = 0; k < grid.size(); ++k)
    if (const double gain = at(grid[k]); gain > most) {
      most = gain;
      top = k;
    }
  double low = grid[top > 0 ? top - 1 : 0], high = grid[std::min(top + 1, grid.size() - 1)];
  constexpr double kGolden = 0.381966;
  double left = low + kGolden * (high - low), right = high - kGolden * (high - low);
  double ofLeft = at(left), ofRight = at(right);
  for (int k = 0; k < 5; ++k) {
    if (ofLeft > ofRight) {
      high = right;
      right = left;
      ofRight = ofLeft;
      left = low + kGolden * (high - low);
      ofLeft = at(left);
    } else {
      low = left;
      left = right;
      ofLeft = ofRight;
      right = high - kGolden * (high - low);
      ofRight = at(right);
    }
  }
  return best;
}

// The same with a latent force instead of nudging, from the base model's fit: where the valley is
// narrower than a step of the nudged grid would show, or where the nudged model hides it.
std::optional<Fit> Search::searchForcedGrid(std::size_t candidate) {
  const Fit& base = at({}).fit;
  if (!(base.noise.latent > 0)) return {};
  const auto amplitude = static_cast<Index>(data_.candidates()[candidate].quantities[0]);
  const Noise noise{output_, std::max(kGridSize, base.noise.latent), options_.latentTime};
  const auto eta = forceKept(base.eta, base.noise.latent, noise.latent);
  const auto fitted = [&](double x) {
    VectorXd values = base.values;
    values[amplitude] = x;
    ++fits_;
    return likelihood_->tryFit(base.hypothesis, noise, values, eta, {3, 0.3});
  };
  const auto absent = fitted(data_.quantities()[static_cast<std::size_t>(amplitude)].nominal);
  std::optional<Fit> best;
  for (const VectorXd& start : data_.candidates()[candidate].starts) {
    auto fit = fitted(start[0]);
    if (fit && (!best || fit->logEvidence > best->logEvidence)) best = std::move(fit);
  }
  if (!best || !absent || best->logEvidence < absent->logEvidence + kGridGain) return {};
  return best;
}

}  // namespace info::discover
