#include "info/discover/unknown.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "info/random_stream.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

struct Library {
  std::vector<std::string> names;
  MatrixXd columns;         // one row a node, whitened by the force's deviation
  VectorXd force;           // whitened alike
  std::vector<int> blocks;  // which block of a bootstrap a node is in
  int numBlocks = 0;
};

Library collect(const Likelihood& likelihood, const Fit& fit) {
  const Disagreement& data = likelihood.data();
  Library library;
  library.names = {"1",   "q",     "q²",   "q³", "q̇", "q̇|q̇|", "q̇³", "tanh(q̇/0.05)",
                   "q·q̇", "sin q", "cos q"};
  for (const std::string& input : data.inputNames()) library.names.push_back(input);
  std::vector<VectorXd> rows;
  std::vector<double> force;
  for (std::size_t t = 0; t < likelihood.trials().size(); ++t) {
    const int trial = likelihood.trials()[t];
    const auto linear = likelihood.linearise(t, fit, fit.values, {}, false);
    const VectorXd y = data.measured(trial) - linear.residuals;
    const VectorXd d = likelihood.force(t, fit), deviation = likelihood.forceDeviation(t, fit);
    const auto& nodes = data.latentTimes(trial);
    const auto& times = data.times(trial);
    const MatrixXd u = data.inputs(trial);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i] < times.front() || nodes[i] > times.back()) continue;
      const auto k = static_cast<Index>(
          std::lower_bound(times.begin(), times.end(), nodes[i] - 1e-9) - times.begin());
      const double q = y[k], w = linear.speeds[k];
      VectorXd row(static_cast<Index>(library.names.size()));
      row.head(11) << 1, q, q * q, q * q * q, w, w * std::abs(w), w * w * w, std::tanh(w / 0.05),
          q * w, std::sin(q), std::cos(q);
      row.tail(u.cols()) = u.row(k).transpose();
      const double weight = 1 / std::max(1e-9, deviation[static_cast<Index>(i)]);
      rows.push_back(weight * row);
      force.push_back(weight * d[static_cast<Index>(i)]);
      // blocks of half a second
      library.blocks.push_back(library.numBlocks + static_cast<int>((nodes[i] - nodes[0]) / 0.5));
    }
    library.numBlocks = library.blocks.empty() ? 0 : library.blocks.back() + 1;
  }
  library.columns.resize(static_cast<Index>(rows.size()), static_cast<Index>(library.names.size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    library.columns.row(static_cast<Index>(i)) = rows[i].transpose();
  library.force = VectorXd::Map(force.data(), static_cast<Index>(force.size()));
  return library;
}

struct Subset {
  std::vector<Index> terms;
  VectorXd coefficients, deviations;
  double explained = 0;
};

// Best subset of at most three by the Bayesian information criterion, from the normal equations.
Subset bestSubset(const MatrixXd& normal, const VectorXd& right, double power, double count) {
  Subset best;
  double score = count * std::log(power);
  const auto consider = [&](const std::vector<Index>& terms) {
    const MatrixXd A = normal(terms, terms);
    const VectorXd b = right(terms);
    const Eigen::LDLT<MatrixXd> factor(A);
    const VectorXd x = factor.solve(b);
    const double left = std::max(1e-12 * power, power - b.dot(x));
    const double now = count * std::log(left) + static_cast<double>(terms.size()) * std::log(count);
    if (now < score) {
      score = now;
      const MatrixXd inverse = factor.solve(MatrixXd::Identity(A.rows(), A.rows()));
      best = {terms, x, (inverse.diagonal() * (left / count)).cwiseMax(0).cwiseSqrt(),
              1 - left / power};
    }
  };
  const Index n = normal.rows();
  for (Index i = 0; i < n; ++i) {
    consider({i});
    for (Index j = i + 1; j < n; ++j) {
      consider({i, j});
      for (Index k = j + 1; k < n; ++k) consider({i, j, k});
    }
  }
  return best;
}

void spectrum(const Likelihood& likelihood, const Fit& fit, Unknown& unknown) {
  double power = 0, count = 0, peak = -1;
  std::vector<double> density;
  const double step = 0.1;
  for (double f = step; f < 9; f += step) {
    double sum = 0;
    for (std::size_t t = 0; t < likelihood.trials().size(); ++t) {
      const auto& nodes = likelihood.data().latentTimes(likelihood.trials()[t]);
      const VectorXd d = likelihood.force(t, fit);
      double cosine = 0, sine = 0;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double x = 2 * std::numbers::pi * f * nodes[i];
        const double r = d[static_cast<Index>(i)] - d.mean();
        cosine += r * std::cos(x);
        sine += r * std::sin(x);
      }
      sum += cosine * cosine + sine * sine;
    }
    // against the spectrum that the prior of the force has, 1/[(1 + (2πfℓ)²)(1 + (2πfτ)²)]
    const double slow = 2 * std::numbers::pi * f * fit.noise.latentTime;
    const double lag = 2 * std::numbers::pi * f * likelihood.data().latentLag();
    sum *= (1 + slow * slow) * (1 + lag * lag);
    density.push_back(sum);
    if (sum > peak) {
      peak = sum;
      unknown.peakFrequency = f;
    }
  }
  double total = 0, near = 0;
  for (std::size_t i = 0; i < density.size(); ++i) {
    total += density[i];
    if (std::abs(step * static_cast<double>(i + 1) - unknown.peakFrequency) < 0.55)
      near += density[i];
  }
  unknown.peakShare = total > 0 ? near / total : 0;
  for (std::size_t t = 0; t < likelihood.trials().size(); ++t) {
    const VectorXd d = likelihood.force(t, fit);
    power += d.squaredNorm();
    count += static_cast<double>(d.size());
  }
  unknown.forceSize = std::sqrt(power / count);
}

}  // namespace

Unknown describeUnknown(const Likelihood& likelihood, const Fit& fit) {
  Unknown unknown;
  spectrum(likelihood, fit, unknown);
  const Library library = collect(likelihood, fit);
  const auto n = static_cast<Index>(library.names.size());
  if (library.force.size() < 4 * n || !(library.force.squaredNorm() > 0)) return unknown;

  // normal equations of each block, so that a bootstrap only adds
  const auto blocks = static_cast<std::size_t>(library.numBlocks);
  std::vector<MatrixXd> normal(blocks, MatrixXd::Zero(n, n));
  std::vector<VectorXd> right(blocks, VectorXd::Zero(n));
  std::vector<double> power(blocks, 0), count(blocks, 0);
  for (Index i = 0; i < library.force.size(); ++i) {
    const auto b = static_cast<std::size_t>(library.blocks[static_cast<std::size_t>(i)]);
    const VectorXd row = library.columns.row(i).transpose();
    normal[b] += row * row.transpose();
    right[b] += row * library.force[i];
    power[b] += library.force[i] * library.force[i];
    ++count[b];
  }
  const auto select = [&](const auto& pick) {
    MatrixXd A = MatrixXd::Zero(n, n);
    VectorXd b = VectorXd::Zero(n);
    double p = 0, c = 0;
    for (std::size_t i = 0; i < blocks; ++i) {
      const std::size_t from = pick(i);
      A += normal[from];
      b += right[from];
      p += power[from];
      c += count[from];
    }
    return bestSubset(A, b, p, c);
  };
  const Subset best = select([](std::size_t i) { return i; });
  RandomStream random(1, 1);
  constexpr int kRepeats = 100;
  std::vector<int> chosen(static_cast<std::size_t>(n), 0);
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const Subset again = select([&](std::size_t) {
      return std::min(blocks - 1,
                      static_cast<std::size_t>(random.uniform() * static_cast<double>(blocks)));
    });
    for (const Index term : again.terms) ++chosen[static_cast<std::size_t>(term)];
  }
  unknown.explained = best.explained;
  unknown.stable = !best.terms.empty();
  for (std::size_t i = 0; i < best.terms.size(); ++i) {
    const auto term = static_cast<std::size_t>(best.terms[i]);
    const auto at = static_cast<Index>(i);
    const double stability = static_cast<double>(chosen[term]) / kRepeats;
    unknown.terms.push_back(
        {library.names[term], best.coefficients[at], best.deviations[at], stability});
    unknown.stable = unknown.stable && stability >= 0.9;
    unknown.formula += fmt::format("{}{:.3g}·{}", unknown.formula.empty() ? "" : " + ",
                                   best.coefficients[at], library.names[term]);
  }
  return unknown;
}

}  // namespace info::discover
