#include "info/discovery/judgement/adequacy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "info/estimation/residuals.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double chiSquareTail(double x, double n) {
  if (!(x > 0)) return 1;
  // regularised incomplete gamma function, by its series or its continued fraction
  const double a = 0.5 * n, y = 0.5 * x;
  const double front = std::exp(a * std::log(y) - y - std::lgamma(a));
  if (y < a + 1) {
    double term = 1 / a, sum = term;
    for (int k = 1; k < 10000 && term > sum * 1e-16; ++k) sum += term *= y / (a + k);
    return 1 - front * sum;
  }
  double b = y + 1 - a, c = 1e300, d = 1 / b, f = d;
  for (int k = 1; k < 10000; ++k) {
    const double an = -k * (k - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    f *= c * d;
    if (std::abs(c * d - 1) < 1e-15) break;
  }
  return front * f;
}

double chiSquareQuantile(double probability, double n) {
  double low = 0, high = n + 40 * std::sqrt(2 * n) + 100;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (chiSquareTail(middle, n) > probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

HeldOutAdequacy heldOutAdequacy(double meanSquare, Index samples, const AdequacyOptions& options) {
  const auto n = static_cast<double>(samples);
  return {meanSquare, chiSquareQuantile(options.level, n) / n * std::exp(3.29 * options.sdError)};
}

Adequacy adequacy(const Likelihood& likelihood, const Fit& fit, const AdequacyOptions& options) {
  const DiscoveryProblem& data = likelihood.data();
  std::vector<VectorXd> series;
  double power = 0, count = 0;
  // reduction of the autocorrelation at each lag by the fitted parameters
  VectorXd taken = VectorXd::Zero(options.lags + 1);
  for (std::size_t t = 0; t < likelihood.trials().size(); ++t) {
    Likelihood::Whitened whitened = likelihood.whitened(t, fit);
    const MatrixXd carried = whitened.gamma * fit.covariance;
    for (Index lag = 0; lag <= std::min<Index>(options.lags, carried.rows() - 1); ++lag) {
      const Index pairs = carried.rows() - lag;
      taken[lag] += carried.topRows(pairs).cwiseProduct(whitened.gamma.bottomRows(pairs)).sum();
    }
    series.push_back(std::move(whitened.innovations));
    power += series.back().squaredNorm();
    count += static_cast<double>(series.back().size());
  }
  // size: each parameter that the data determine takes one degree of freedom
  double freedom = count;
  for (Index i = 0; i < fit.xi.size(); ++i)
    if (!fit.atBound[static_cast<std::size_t>(i)])
      freedom -= std::clamp(1 - fit.covariance(i, i), 0.0, 1.0);
  Adequacy result;
  result.meanSquare = power / freedom;
  // an estimated σ_y widens the acceptance region
  const double widening = std::exp(3.29 * options.sdError);
  result.lowest = chiSquareQuantile(1 - 0.5 * options.level, freedom) / freedom / widening;
  result.highest = chiSquareQuantile(0.5 * options.level, freedom) / freedom * widening;
  result.sized = result.meanSquare > result.lowest && result.meanSquare < result.highest;

  // autocorrelation, lags pooled over trials
  const std::vector<double> rho = autocorrelation(series, options.lags);
  for (std::size_t lag = 1; lag < rho.size(); ++lag) {
    double pairs = 0;
    for (const VectorXd& s : series)
      pairs += std::max(0.0, static_cast<double>(s.size()) - static_cast<double>(lag));
    const double expected = -taken[static_cast<Index>(lag)] / pairs * count / (count - taken[0]);
    result.ljungBox += pairs * (rho[lag] - expected) * (rho[lag] - expected);
  }
  result.ljungBoxProbability = chiSquareTail(result.ljungBox, options.lags);
  result.white = result.ljungBoxProbability > options.level;

  // inputs of 0, 0.05 … 0.2 s before
  const std::vector<std::string> names = data.inputNames();
  std::vector<MatrixXd> inputs;
  for (const int trial : likelihood.trials()) inputs.push_back(data.inputs(trial));
  int tests = 0;
  for (std::size_t j = 0; j < names.size(); ++j)
    for (int step = 0; step <= 4; ++step) {
      double score = 0, information = 0;
      for (std::size_t t = 0; t < series.size(); ++t) {
        const auto& times = data.times(likelihood.trials()[t]);
        const double interval =
            (times.back() - times.front()) / std::max(1.0, static_cast<double>(times.size()) - 1);
        const auto lag = static_cast<Index>(std::lround(0.05 * step / interval));
        const Index n = series[t].size() - lag;
        if (n < 2) continue;
        VectorXd u = inputs[t].col(static_cast<Index>(j)).head(n);
        u.array() -= u.mean();
        score += u.dot(series[t].tail(n));
        information += u.squaredNorm();
      }
      if (!(information > 0)) continue;
      ++tests;
      const double z = std::abs(score) / std::sqrt(information * power / count);
      if (z > result.inputScore) {
        result.inputScore = z;
        result.input = names[j];
      }
    }
  if (tests > 0)
    result.inputProbability =
        std::min(1.0, tests * std::erfc(result.inputScore / std::numbers::sqrt2));
  result.independent = result.inputProbability > options.level;

  result.remainder = residualEvidence(likelihood, fit);
  result.causeless = true;
  for (const Cause cause : kCauses)
    if (cause != Cause::sensor && !(result.remainder.of(cause) < options.evidence))
      result.causeless = false;
  return result;
}

}  // namespace info::discover
