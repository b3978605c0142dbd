#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "design/riccati_checks.h"
#include "info/design/riccati.h"
#include "info/dynamics/adaptive.h"

namespace info {
namespace {

using namespace detail;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Backwards in continuous time: P(t), K(t) and, with `cost`, r(t).
class ContinuousSweep {
 public:
  std::vector<MatrixXd> K;
  std::vector<VectorXd> feedforward;  // R⁻¹(Bᵀr + b)

  ContinuousSweep(const LinearSequence& system, double step, const QuadraticWeights& weights,
                  const CheckedLq& c, const LinearCost* cost, RiccatiIntegration integration)
      : system_(system), step_(step), weights_(weights), c_(c), cost_(cost) {
    if (!(step > 0 && std::isfinite(step)))
      throw std::domain_error(
          fmt::format("step between nodes: {} s, must be > 0 and finite", step));
    inverseR_ = weights.R.llt().solve(MatrixXd::Identity(c.m, c.m));
    K.resize(c.steps + 1);
    if (cost) feedforward.resize(c.steps + 1);
    if (integration == RiccatiIntegration::adaptive)
      adaptively();
    else
      byRungeKutta();
  }

 private:
  // P and r together, r empty without a cost
  struct Values {
    MatrixXd P;
    VectorXd r;
  };
  struct Coefficients {
    MatrixXd A, B;
    VectorXd a, b;
  };

  Coefficients at(std::size_t k, double fraction) const {
    const auto between = [&](const auto& list) {
      using Entry = std::decay_t<decltype(list[k])>;
      if (fraction == 0) return Entry(list[k]);
      return Entry((1 - fraction) * list[k] + fraction * list[k + 1]);
    };
    Coefficients out{between(system_.A), between(system_.B), {}, {}};
    if (cost_) {
      out.a = between(cost_->a);
      out.b = between(cost_->b);
    }
    return out;
  }

  // −Ṗ and −ṙ
  Values rates(const Coefficients& at, const Values& value) const {
    const MatrixXd PA = value.P * at.A, PB = value.P * at.B;
    Values out{weights_.Q + PA + PA.transpose(), {}};
    out.P.noalias() -= (PB * inverseR_) * PB.transpose();
    if (cost_)
      out.r = at.a + at.A.transpose() * value.r -
              PB * (inverseR_ * (at.B.transpose() * value.r + at.b));
    return out;
  }

  Values end() const { return {c_.Qf, cost_ ? VectorXd::Zero(c_.n) : VectorXd()}; }

  void keep(std::size_t k, const Values& value) {
    checkRiccati(value.P, k);
    const MatrixXd BT = system_.B[k].transpose();
    K[k] = inverseR_ * BT * value.P;
    if (cost_) feedforward[k] = inverseR_ * (BT * value.r + cost_->b[k]);
  }

  void byRungeKutta() {
    const auto moved = [](const Values& from, double h, const Values& rate) {
      return Values{from.P + h * rate.P, from.r + h * rate.r};
    };
    Values value = end();
    keep(c_.steps, value);
    Coefficients last = at(c_.steps, 0);
    for (std::size_t k = c_.steps; k-- > 0;) {
      const Coefficients middle = at(k, 0.5);
      Coefficients first = at(k, 0);
      const Values k1 = rates(last, value);
      const Values k2 = rates(middle, moved(value, 0.5 * step_, k1));
      const Values k3 = rates(middle, moved(value, 0.5 * step_, k2));
      const Values k4 = rates(first, moved(value, step_, k3));
      value.P += step_ / 6 * (k1.P + 2 * k2.P + 2 * k3.P + k4.P);
      value.r += step_ / 6 * (k1.r + 2 * k2.r + 2 * k3.r + k4.r);
      keep(k, value);
      last = std::move(first);
    }
  }

  // (vec P, r) in the time left, τ = T − t
  void adaptively() {
    const Index nn = c_.n * c_.n, nr = cost_ ? c_.n : 0;
    const double duration = step_ * static_cast<double>(c_.steps);
    const auto unpack = [=, n = c_.n](const double* z) {
      return Values{Eigen::Map<const MatrixXd>(z, n, n), Eigen::Map<const VectorXd>(z + nn, nr)};
    };
    const auto field = [&](double left, const double* z, double* zDot) {
      const double nodes = std::clamp((duration - left) / step_, 0.0, double(c_.steps));
      const std::size_t k = std::min(static_cast<std::size_t>(nodes), c_.steps - 1);
      const Values rate = rates(at(k, nodes - static_cast<double>(k)), unpack(z));
      Eigen::Map<VectorXd>(zDot, nn) = rate.P.reshaped();
      Eigen::Map<VectorXd>(zDot + nn, nr) = rate.r;
    };
    VectorXd z(nn + nr);
    z << end().P.reshaped(), end().r;
    std::vector<double> times;
    for (std::size_t k = 0; k <= c_.steps; ++k) times.push_back(step_ * static_cast<double>(k));
    const auto solution = solveOde(field, z, times);
    if (!solution.complete)
      throw std::domain_error(fmt::format("Riccati equation: {} at {} s", solution.why,
                                          duration - solution.reachedTime));
    for (std::size_t i = 0; i <= c_.steps; ++i) keep(c_.steps - i, unpack(solution.x[i].data()));
  }

  const LinearSequence& system_;
  double step_;
  const QuadraticWeights& weights_;
  const CheckedLq& c_;
  const LinearCost* cost_;
  MatrixXd inverseR_;
};

}  // namespace

std::vector<MatrixXd> continuousLqrGains(const LinearSequence& system, double step,
                                         const QuadraticWeights& weights,
                                         RiccatiIntegration integration) {
  const CheckedLq c = checkLq(system, weights, true);
  return ContinuousSweep(system, step, weights, c, nullptr, integration).K;
}

AffineLqSolution continuousAffineLq(const LinearSequence& system, double step,
                                    const LinearCost& cost, const QuadraticWeights& weights,
                                    RiccatiIntegration integration) {
  const CheckedLq c = checkLq(system, weights, true);
  checkLinearCost(cost, c, c.steps + 1);
  const ContinuousSweep sweep(system, step, weights, c, &cost, integration);
  AffineLqSolution out{{VectorXd::Zero(c.n)}, {}, 0};
  const auto input = [&](std::size_t k, const VectorXd& z) {
    return VectorXd(-sweep.K[k] * z - sweep.feedforward[k]);
  };
  for (std::size_t k = 0;; ++k) {
    const VectorXd& z = out.z[k];
    out.v.push_back(input(k, z));
    const double weight = k == 0 || k == c.steps ? 0.5 * step : step;
    out.slope += weight * (cost.a[k].dot(z) + cost.b[k].dot(out.v[k]));
    if (k == c.steps) return out;
    // the closed loop, its input linear between nodes like everything else
    const MatrixXd A = 0.5 * (system.A[k] + system.A[k + 1]);
    const MatrixXd B = 0.5 * (system.B[k] + system.B[k + 1]);
    const MatrixXd K = 0.5 * (sweep.K[k] + sweep.K[k + 1]);
    const VectorXd forward = 0.5 * (sweep.feedforward[k] + sweep.feedforward[k + 1]);
    const auto rate = [&](const VectorXd& at) { return VectorXd(A * at - B * (K * at + forward)); };
    const VectorXd k1 = system.A[k] * z + system.B[k] * out.v[k];
    const VectorXd k2 = rate(z + 0.5 * step * k1), k3 = rate(z + 0.5 * step * k2);
    const VectorXd last = z + step * k3;
    const VectorXd k4 = system.A[k + 1] * last + system.B[k + 1] * input(k + 1, last);
    out.z.push_back(z + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4));
  }
}

}  // namespace info
