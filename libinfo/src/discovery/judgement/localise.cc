#include "info/discovery/judgement/localise.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "discovery/judgement/node_states.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void benjaminiHochberg(std::vector<Score>& scores, double share) {
  std::vector<std::size_t> order(scores.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(scores[a].z) > std::abs(scores[b].z);
  });
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double p = std::erfc(std::abs(scores[order[i]].z) / std::numbers::sqrt2);
    if (p <= share * static_cast<double>(i + 1) / static_cast<double>(order.size()))
      accepted = i + 1;
  }
  for (std::size_t i = 0; i < order.size(); ++i) scores[order[i]].significant = i < accepted;
}

Localisation localise(const Likelihood& likelihood, const Fit& fit, const Fit& smoothing,
                      const LocaliseOptions& options) {
  const DiscoveryProblem& data = likelihood.data();
  const std::size_t n = likelihood.trials().size();
  Localisation result;
  result.trials = likelihood.trials();

  const NodeStates states = statesAtNodes(likelihood, fit);
  const auto& linear = states.linear;
  const auto& q = states.q;
  const auto& qDot = states.qDot;
  double range[4] = {1e300, -1e300, 1e300, -1e300};
  for (std::size_t t = 0; t < n; ++t) {
    range[0] = std::min(range[0], q[t].minCoeff());
    range[1] = std::max(range[1], q[t].maxCoeff());
    range[2] = std::min(range[2], qDot[t].minCoeff());
    range[3] = std::max(range[3], qDot[t].maxCoeff());
  }

  // one column of force per element of the map
  std::vector<Score> scores;
  std::vector<std::vector<VectorXd>> columns(n);
  const auto add = [&](const Score& score, const auto& forceOf) {
    bool any = false;
    std::vector<VectorXd> forces;
    for (std::size_t t = 0; t < n; ++t) {
      forces.push_back(forceOf(t));
      any = any || forces.back().squaredNorm() > 0;
    }
    if (!any) return;
    for (std::size_t t = 0; t < n; ++t) columns[t].push_back(linear[t].force * forces[t]);
    scores.push_back(score);
  };
  for (std::size_t t = 0; t < n; ++t) {
    const auto& nodes = data.latentTimes(likelihood.trials()[t]);
    const double half = 0.5 * options.width;
    for (double middle = nodes.front(); middle <= nodes.back() + 1e-9; middle += half) {
      Score score;
      score.trial = likelihood.trials()[t];
      score.from = middle - half;
      score.to = middle + half;
      add(score, [&](std::size_t of) {
        VectorXd f = VectorXd::Zero(linear[of].force.cols());
        if (of == t)
          for (Index i = 0; i < f.size(); ++i)
            f[i] = std::max(0.0, 1 - std::abs(nodes[static_cast<std::size_t>(i)] - middle) / half);
        return f;
      });
    }
  }
  const std::size_t numTimes = scores.size();
  const double width[2] = {(range[1] - range[0]) / options.cellsQ + 1e-12,
                           (range[3] - range[2]) / options.cellsQDot + 1e-12};
  for (int a = 0; a < options.cellsQ; ++a)
    for (int b = 0; b < options.cellsQDot; ++b) {
      Score score;
      score.lowerQ = range[0] + a * width[0];
      score.upperQ = score.lowerQ + width[0];
      score.lowerQDot = range[2] + b * width[1];
      score.upperQDot = score.lowerQDot + width[1];
      add(score, [&](std::size_t of) {
        VectorXd f = VectorXd::Zero(linear[of].force.cols());
        for (Index i = 0; i < f.size(); ++i)
          f[i] = q[of][i] >= score.lowerQ && q[of][i] < score.upperQ &&
                         qDot[of][i] >= score.lowerQDot && qDot[of][i] < score.upperQDot
                     ? 1
                     : 0;
        return f;
      });
    }
  const std::size_t numCells = scores.size() - numTimes;
  const auto names = data.inputNames();
  for (std::size_t j = 0; j < names.size(); ++j) {
    Score score;
    score.input = names[j];
    add(score,
        [&](std::size_t of) { return VectorXd(states.inputs[of].col(static_cast<Index>(j))); });
  }

  std::vector<MatrixXd> disturbances;
  const auto m = static_cast<Index>(scores.size());
  for (std::size_t t = 0; t < n; ++t) {
    MatrixXd block(linear[t].residuals.size(), m);
    for (Index j = 0; j < m; ++j) block.col(j) = columns[t][static_cast<std::size_t>(j)];
    disturbances.push_back(std::move(block));
  }
  const auto projected = likelihood.project(fit, linear, disturbances);
  for (Index j = 0; j < m; ++j) {
    Score& score = scores[static_cast<std::size_t>(j)];
    const double information = projected.information(j, j);
    if (information > 1e-12) {
      score.z = projected.score[j] / std::sqrt(information);
      score.amplitude = projected.score[j] / information;
    }
  }
  const auto from = scores.begin();
  const auto cells = from + static_cast<std::ptrdiff_t>(numTimes);
  const auto last = cells + static_cast<std::ptrdiff_t>(numCells);
  result.times.assign(from, cells);
  result.cells.assign(cells, last);
  result.inputs.assign(last, scores.end());
  benjaminiHochberg(result.times, options.falseDiscoveries);
  benjaminiHochberg(result.cells, options.falseDiscoveries);
  benjaminiHochberg(result.inputs, options.falseDiscoveries);

  for (std::size_t t = 0; t < n; ++t) {
    result.force.push_back(likelihood.force(t, smoothing));
    result.forceSd.push_back(likelihood.forceSd(t, smoothing));
  }
  return result;
}

}  // namespace info::discover
