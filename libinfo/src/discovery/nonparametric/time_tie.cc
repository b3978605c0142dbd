#include "info/discovery/nonparametric/time_tie.h"

#include <algorithm>
#include <cmath>

#include "info/dynamics/linear_table.h"

namespace info::discover {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double kSpacing = 0.05;  // [s]
constexpr Index kShortest = 4;     // samples of a level

VectorXd sampled(const std::vector<double>& times, const VectorXd& force, double from, Index n) {
  VectorXd values(n);
  for (Index i = 0; i < n; ++i) {
    const double t = from + kSpacing * static_cast<double>(i);
    values[i] = linearAt(times, t).value(force);
  }
  return values;
}

void findStep(const VectorXd& mean, double from, TimeTie& tie) {
  const Index n = mean.size();
  const double variance = (mean.array() - mean.mean()).square().sum();
  if (!(variance > 0)) return;
  for (Index k = kShortest; k + kShortest <= n; ++k) {
    const double before = mean.head(k).mean(), after = mean.tail(n - k).mean();
    const auto first = static_cast<double>(k), second = static_cast<double>(n - k);
    const double between =
        first * second / (first + second) * (after - before) * (after - before) / variance;
    if (between <= tie.stepShare) continue;
    tie.stepShare = between;
    tie.stepAt = from + kSpacing * (first - 0.5);
    tie.before = before;
    tie.after = after;
  }
}

}  // namespace

TimeTie timeTie(const std::vector<std::vector<double>>& times,
                const std::vector<VectorXd>& forces) {
  TimeTie tie;
  if (forces.size() < 2) return tie;
  double from = -HUGE_VAL, until = HUGE_VAL;
  for (const std::vector<double>& time : times) {
    if (time.size() < 2) return tie;
    from = std::max(from, time.front());
    until = std::min(until, time.back());
  }
  const auto n = static_cast<Index>(std::floor((until - from) / kSpacing)) + 1;
  if (n < 2 * kShortest) return tie;
  VectorXd mean = VectorXd::Zero(n);
  double power = 0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const VectorXd values = sampled(times[i], forces[i], from, n);
    mean += values;
    power += values.squaredNorm();
  }
  const auto trials = static_cast<double>(forces.size());
  mean /= trials;
  if (!(power > 0)) return tie;
  tie.share = trials * mean.squaredNorm() / power;
  findStep(mean, from, tie);
  return tie;
}

}  // namespace info::discover
