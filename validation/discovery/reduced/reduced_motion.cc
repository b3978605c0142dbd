#include "reduced/reduced_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "reduced/reduced_activation.h"
#include "reduced/reduced_dynamics.h"

namespace reduced {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

double plain(double x) {
  return x;
}
double plain(const info::Dual<5>& x) {
  return x.value();
}

// The classical Runge–Kutta method with the derivatives of each stage.
template <bool derivatives>
class MotionSolver {
  using Level = std::conditional_t<derivatives, info::Dual<5>, double>;

 public:
  explicit MotionSolver(const MotionTask& task)
      : task_(task),
        numWanted_(static_cast<Index>(task.wanted.size())),
        numSamples_(static_cast<Index>(task.times.size())),
        numTerms_(static_cast<Index>(task.formula.size())),
        steps_(static_cast<std::size_t>(std::lround(
            kTick * static_cast<double>(task.trial.excitations.size() - 1) / task.step))),
        activation_(activate<Level>(task.trial, 0.5 * task.step, 2 * steps_ + 1, task.values)),
        q_(task.values[task.start]),
        w_(task.values[task.start + 1]),
        terms_(task.formula.size()),
        amplitude_(numTerms_ > 0 ? task.values[task.formulaAt] : 0) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    motion_.outputs = VectorXd::Constant(numSamples_, nan);
    motion_.speeds = VectorXd::Zero(numSamples_);
    if (task.latentToo) {
      motion_.scale = motion_.q = motion_.qDot = VectorXd::Constant(task.numNodes, nan);
      if (derivatives) motion_.courseByNode.setConstant(task.numNodes, task.numNodes, nan);
    }
    const Index columns = numWanted_ + (task.latentToo ? task.numNodes : 0);
    if (derivatives) motion_.gamma.setConstant(numSamples_, columns, nan);
    Sq_ = Sw_ = stageQ_ = stageW_ = oldQ_ = oldW_ = ArrayXd::Zero(columns);
    kq_.fill(Sq_);
    kw_.fill(Sq_);
    for (Index j = 0; j < numWanted_; ++j) {
      if (isWanted(j, task.start)) Sq_[j] = 1;
      if (isWanted(j, task.start + 1)) Sw_[j] = 1;
    }
  }

  Motion solve() {
    for (std::size_t n = 0; n < steps_ && sample_ < numSamples_; ++n) {
      const double t0 = static_cast<double>(n) * task_.step, q0 = q_, w0 = w_;
      const Index active = numActive(t0);
      advance(n, t0, active);
      if (!(std::abs(q_) < 50)) return std::move(motion_);
      if constexpr (derivatives) advanceDerivatives(active);
      sampleStep(t0, q0, w0, active);
    }
    if (task_.latentToo) {  // the node at the end, and one beyond it
      for (Index i = 1; i < task_.numNodes; ++i)
        if (!std::isfinite(motion_.scale[i])) {
          motion_.scale[i] = motion_.scale[i - 1];
          keepCourse(i);
        }
    }
    return std::move(motion_);
  }

 private:
  // The state as that of a node.
  void keepCourse(Index node) {
    motion_.q[node] = q_;
    motion_.qDot[node] = w_;
    if constexpr (derivatives)
      motion_.courseByNode.row(node) = Sq_.tail(task_.numNodes).matrix().transpose();
  }

  std::size_t wanted(Index j) const { return task_.wanted[static_cast<std::size_t>(j)]; }
  bool isWanted(Index j, Index quantity) const {
    return wanted(j) == static_cast<std::size_t>(quantity);
  }

  // Columns that can differ from 0: a node acts from the one before it on.
  Index numActive(double t0) const {
    if (!task_.latentToo) return numWanted_;
    const auto reached = static_cast<Index>((t0 + task_.step) / kNode + 1e-6) + 2;
    return numWanted_ + std::min<Index>(task_.numNodes, reached);
  }

  double latentForce(double t, Index& node, double& share) const {
    node = std::min<Index>(static_cast<Index>(t / kNode + 1e-9), task_.numNodes - 2);
    share = t / kNode - static_cast<double>(node);
    const VectorXd& latent = task_.latent;
    return latent.size() == 0 ? 0.0 : latent[node] + share * (latent[node + 1] - latent[node]);
  }

  // c·(e_1 + r_2·e_2 + …) over c; of each term its share r_k
  StateTerm::Value formula(double angle, double speed) {
    StateTerm::Value sum{0, 0, 0};
    for (Index k = 0; k < numTerms_; ++k) {
      const double ratio = k == 0 ? 1 : task_.values[task_.formulaAt + k];
      const StateTerm::Value e = task_.formula[static_cast<std::size_t>(k)].at(angle, speed);
      terms_[static_cast<std::size_t>(k)] = e;
      sum = {sum.value + ratio * e.value, sum.byQ + ratio * e.byQ, sum.bySpeed + ratio * e.bySpeed};
    }
    return sum;
  }

  void advance(std::size_t n, double t0, Index active) {
    const double h = task_.step, q0 = q_, w0 = w_;
    std::array<double, 4> vq{}, vw{};
    std::array<double, kMuscles> level, used;
    for (std::size_t s = 0; s < 4; ++s) {
      const double reach = s == 0 ? 0 : s == 3 ? h : 0.5 * h;
      const std::size_t place = 2 * n + (s == 0 ? 0 : s == 3 ? 2 : 1);
      const double qs = s == 0 ? q0 : q0 + reach * vq[s - 1];
      const double ws = s == 0 ? w0 : w0 + reach * vw[s - 1];
      for (std::size_t m = 0; m < kMuscles; ++m) {
        level[m] = plain(activation_.level[place][m]);
        used[m] = plain(activation_.used[place][m]);
      }
      Index node = 0;
      double share = 0;
      const double d = latentForce(t0 + reach, node, share);
      const StateTerm::Value shape = formula(qs, ws);
      evaluate<derivatives>(task_.values, qs, ws, level, used, d + amplitude_ * shape.value, now_);
      vq[s] = ws;
      vw[s] = now_.acceleration;
      if (task_.latentToo && s == 0 && share < 1e-6) {
        motion_.scale[node] = now_.scale;
        keepCourse(node);
      }
      if constexpr (derivatives) {
        differentiateStage(s, reach, active, shape);
        differentiateByInputs(s, place);
        if (task_.latentToo) {
          kw_[s][numWanted_ + node] += (1 - share) / now_.inertia;
          kw_[s][numWanted_ + node + 1] += share / now_.inertia;
        }
      }
    }
    q_ += h / 6 * (vq[0] + 2 * (vq[1] + vq[2]) + vq[3]);
    w_ += h / 6 * (vw[0] + 2 * (vw[1] + vw[2]) + vw[3]);
  }

  // Through the state, and by what acts at once.
  void differentiateStage(std::size_t s, double reach, Index active,
                          const StateTerm::Value& shape) {
    auto nowQ = stageQ_.head(active), nowW = stageW_.head(active);
    if (s == 0) {
      nowQ = Sq_.head(active);
      nowW = Sw_.head(active);
    } else {
      nowQ = Sq_.head(active) + reach * kq_[s - 1].head(active);
      nowW = Sw_.head(active) + reach * kw_[s - 1].head(active);
    }
    now_.byQ += amplitude_ * shape.byQ / now_.inertia;
    now_.bySpeed += amplitude_ * shape.bySpeed / now_.inertia;
    kq_[s].head(active) = nowW;
    kw_[s].head(active) = now_.byQ * nowQ + now_.bySpeed * nowW;
    for (Index j = 0; j < numWanted_; ++j) {
      const std::size_t i = wanted(j);
      if (i < kShared) kw_[s][j] += now_.direct[i];
      const Index k = static_cast<Index>(i) - task_.formulaAt;
      if (numTerms_ > 0 && k >= 0)
        kw_[s][j] +=
            (k == 0 ? shape.value : amplitude_ * terms_[static_cast<std::size_t>(k)].value) /
            now_.inertia;
    }
  }

  // Through activations.
  void differentiateByInputs(std::size_t s, std::size_t place) {
    for (std::size_t c = 0; c < 5; ++c) {
      for (Index j = 0; j < numWanted_; ++j) {
        if (wanted(j) != kInputLike[c]) continue;
        for (std::size_t m = 0; m < kMuscles; ++m) {
          const auto i = static_cast<Index>(c);
          kw_[s][j] += now_.byLevel[m] * activation_.level[place][m].derivatives()[i] +
                       now_.byUsed[m] * activation_.used[place][m].derivatives()[i];
        }
      }
    }
  }

  void advanceDerivatives(Index active) {
    const double h = task_.step;
    oldQ_.head(active) = Sq_.head(active);
    oldW_.head(active) = Sw_.head(active);
    const auto part = [&](const ArrayXd& x) { return x.head(active); };
    Sq_.head(active) += h / 6 * (part(kq_[0]) + 2 * (part(kq_[1]) + part(kq_[2])) + part(kq_[3]));
    Sw_.head(active) += h / 6 * (part(kw_[0]) + 2 * (part(kw_[1]) + part(kw_[2])) + part(kw_[3]));
  }

  // Samples within the step, by the cubic through both ends and their speeds, as they are read.
  void sampleStep(double t0, double q0, double w0, Index active) {
    const double h = task_.step;
    const double bias = task_.values[kBias], gain = task_.values[kGain],
                 clock = task_.values[kClock];
    for (; sample_ < numSamples_; ++sample_) {
      const double s = (task_.times[static_cast<std::size_t>(sample_)] - clock - t0) / h;
      if (s > 1 + 1e-9) break;
      const double h00 = (1 + 2 * s) * (1 - s) * (1 - s), h10 = s * (1 - s) * (1 - s);
      const double h01 = s * s * (3 - 2 * s), h11 = s * s * (s - 1);
      const double angle = h00 * q0 + h * h10 * w0 + h01 * q_ + h * h11 * w_;
      const double speed =
          (6 * s * (s - 1) * (q0 - q_)) / h + (1 - s) * (1 - 3 * s) * w0 + s * (3 * s - 2) * w_;
      motion_.outputs[sample_] = (1 + gain) * angle + bias;
      motion_.speeds[sample_] = speed;
      if constexpr (derivatives) {
        auto row = motion_.gamma.row(sample_);
        row.setZero();
        row.head(active) = ((1 + gain) * (h00 * oldQ_.head(active) + h * h10 * oldW_.head(active) +
                                          h01 * Sq_.head(active) + h * h11 * Sw_.head(active)))
                               .matrix()
                               .transpose();
        for (Index j = 0; j < numWanted_; ++j) {
          const std::size_t i = wanted(j);
          if (i == kBias) row[j] = 1;
          if (i == kGain) row[j] = angle;
          if (i == kClock) row[j] = -(1 + gain) * speed;
        }
      }
    }
  }

  const MotionTask& task_;
  Index numWanted_, numSamples_, numTerms_;
  std::size_t steps_;
  Activation<Level> activation_;
  double q_, w_;
  std::vector<StateTerm::Value> terms_;
  double amplitude_;
  Index sample_ = 0;
  Instant now_;
  ArrayXd Sq_, Sw_, stageQ_, stageW_, oldQ_, oldW_;
  std::array<ArrayXd, 4> kq_, kw_;
  Motion motion_;
};

}  // namespace

template <bool derivatives>
Motion solveMotion(const MotionTask& task) {
  return MotionSolver<derivatives>(task).solve();
}
template Motion solveMotion<false>(const MotionTask&);
template Motion solveMotion<true>(const MotionTask&);

}  // namespace reduced
