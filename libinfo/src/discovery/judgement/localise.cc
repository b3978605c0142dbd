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

namespace {

/// Disturbances of the generalised force, each with its force at the nodes of every trial; those
/// that are zero everywhere are left out.
class Disturbances {
 public:
  Disturbances(const Likelihood& likelihood, const NodeStates& states)
      : likelihood_(likelihood), states_(states), columns_(likelihood.trials().size()) {}

  void addHats(double width, std::size_t axis);
  void addCells(int cellsQ, int cellsQDot, std::size_t axis);
  void addInputs(std::size_t axis);

  std::vector<Score>& scores() { return scores_; }
  /// The change of the outputs by each disturbance: per trial samples × disturbances.
  std::vector<MatrixXd> outputs() const;

 private:
  /// @param forceOf the force at the nodes of a trial on the score's axis
  template <class ForceOf>
  void add(const Score& score, const ForceOf& forceOf);
  VectorXd noForce(std::size_t trial) const { return VectorXd::Zero(states_.count(trial)); }

  const Likelihood& likelihood_;
  const NodeStates& states_;
  std::vector<Score> scores_;
  std::vector<std::vector<VectorXd>> columns_;  // per trial
};

template <class ForceOf>
void Disturbances::add(const Score& score, const ForceOf& forceOf) {
  bool any = false;
  std::vector<VectorXd> forces;
  for (std::size_t t = 0; t < columns_.size(); ++t) {
    forces.emplace_back(states_.placed(t, score.axis, forceOf(t)));
    any = any || forces.back().squaredNorm() > 0;
  }
  if (!any) return;
  for (std::size_t t = 0; t < columns_.size(); ++t)
    columns_[t].push_back(states_.linear[t].force * forces[t]);
  scores_.push_back(score);
}

// Hats in time, half a width apart.
void Disturbances::addHats(double width, std::size_t axis) {
  for (std::size_t t = 0; t < columns_.size(); ++t) {
    const std::vector<double> nodes = nodeTimes(likelihood_.data(), likelihood_.trials()[t]);
    const double half = 0.5 * width;
    for (double middle = nodes.front(); middle <= nodes.back() + 1e-9; middle += half) {
      Score score;
      score.axis = axis;
      score.trial = likelihood_.trials()[t];
      score.from = middle - half;
      score.to = middle + half;
      add(score, [&](std::size_t trial) {
        VectorXd f = noForce(trial);
        if (trial == t)
          for (Index i = 0; i < f.size(); ++i)
            f[i] = std::max(0.0, 1 - std::abs(nodes[static_cast<std::size_t>(i)] - middle) / half);
        return f;
      });
    }
  }
}

struct StateRange {
  double lowestQ = 1e300, highestQ = -1e300, lowestQDot = 1e300, highestQDot = -1e300;
};

StateRange rangeOf(const std::vector<VectorXd>& q, const std::vector<VectorXd>& qDot) {
  StateRange range;
  for (std::size_t t = 0; t < q.size(); ++t) {
    range.lowestQ = std::min(range.lowestQ, q[t].minCoeff());
    range.highestQ = std::max(range.highestQ, q[t].maxCoeff());
    range.lowestQDot = std::min(range.lowestQDot, qDot[t].minCoeff());
    range.highestQDot = std::max(range.highestQDot, qDot[t].maxCoeff());
  }
  return range;
}

// Cells of equal size in the visited part of an axis's (q, q̇).
void Disturbances::addCells(int cellsQ, int cellsQDot, std::size_t axis) {
  const std::vector<VectorXd> q = states_.positions(axis), qDot = states_.speeds(axis);
  const StateRange range = rangeOf(q, qDot);
  const double widthQ = (range.highestQ - range.lowestQ) / cellsQ + 1e-12,
               widthQDot = (range.highestQDot - range.lowestQDot) / cellsQDot + 1e-12;
  for (int a = 0; a < cellsQ; ++a)
    for (int b = 0; b < cellsQDot; ++b) {
      Score score;
      score.axis = axis;
      score.lowerQ = range.lowestQ + a * widthQ;
      score.upperQ = score.lowerQ + widthQ;
      score.lowerQDot = range.lowestQDot + b * widthQDot;
      score.upperQDot = score.lowerQDot + widthQDot;
      add(score, [&](std::size_t trial) {
        VectorXd f = noForce(trial);
        for (Index i = 0; i < f.size(); ++i)
          f[i] = q[trial][i] >= score.lowerQ && q[trial][i] < score.upperQ &&
                         qDot[trial][i] >= score.lowerQDot && qDot[trial][i] < score.upperQDot
                     ? 1
                     : 0;
        return f;
      });
    }
}

// Forces proportional to an input.
void Disturbances::addInputs(std::size_t axis) {
  const auto names = likelihood_.data().inputNames();
  for (std::size_t j = 0; j < names.size(); ++j) {
    Score score;
    score.axis = axis;
    score.input = names[j];
    add(score, [&](std::size_t trial) {
      return VectorXd(states_.inputs[trial]
                          .col(static_cast<Index>(j))
                          .segment(states_.begin(trial, axis), states_.count(trial)));
    });
  }
}

std::vector<MatrixXd> Disturbances::outputs() const {
  std::vector<MatrixXd> outputs;
  const auto m = static_cast<Index>(scores_.size());
  for (std::size_t t = 0; t < columns_.size(); ++t) {
    MatrixXd block(states_.linear[t].residuals.size(), m);
    for (Index j = 0; j < m; ++j) block.col(j) = columns_[t][static_cast<std::size_t>(j)];
    outputs.push_back(std::move(block));
  }
  return outputs;
}

// z = g/√S and the most probable amplitude g/S of each disturbance.
void setScores(std::vector<Score>& scores, const Likelihood::Projected& projected) {
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const auto j = static_cast<Index>(i);
    const double information = projected.information(j, j);
    if (information > 1e-12) {
      scores[i].z = projected.score[j] / std::sqrt(information);
      scores[i].amplitude = projected.score[j] / information;
    }
  }
}

}  // namespace

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
  Localisation result;
  result.trials = likelihood.trials();

  const NodeStates states = statesAtNodes(likelihood, fit);
  Disturbances disturbances(likelihood, states);
  std::vector<Score>& scores = disturbances.scores();
  const auto onEveryAxis = [&](const auto& addOn) {
    for (std::size_t axis = 0; axis < states.numAxes; ++axis) addOn(axis);
  };
  onEveryAxis([&](std::size_t axis) { disturbances.addHats(options.width, axis); });
  const auto numTimes = static_cast<std::ptrdiff_t>(scores.size());
  onEveryAxis(
      [&](std::size_t axis) { disturbances.addCells(options.cellsQ, options.cellsQDot, axis); });
  const auto numTimesAndCells = static_cast<std::ptrdiff_t>(scores.size());
  onEveryAxis([&](std::size_t axis) { disturbances.addInputs(axis); });
  setScores(scores, likelihood.project(fit, states.linear, disturbances.outputs()));

  const auto cells = scores.begin() + numTimes, inputs = scores.begin() + numTimesAndCells;
  result.times.assign(scores.begin(), cells);
  result.cells.assign(cells, inputs);
  result.inputs.assign(inputs, scores.end());
  for (std::vector<Score>* map : {&result.times, &result.cells, &result.inputs})
    benjaminiHochberg(*map, options.falseDiscoveries);

  for (std::size_t t = 0; t < likelihood.trials().size(); ++t) {
    result.force.push_back(likelihood.force(t, smoothing));
    result.forceSd.push_back(likelihood.forceSd(t, smoothing));
  }
  return result;
}

}  // namespace info::discover
