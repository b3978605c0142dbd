#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "info/design/information_rate_cost.h"

namespace info {

/// Options of the search for an action.
struct ActionOptions {
  double horizon = 1.2;          ///< T [s] > 0, prediction horizon
  double step = 0.02;            ///< time step of the prediction [s] > 0, ≤ T
  double descentRate = -10;      ///< α_d/J0 [1/s] < 0: target of dJ/dΔt for an action
  double firstDuration = 0.2;    ///< Δt0 [s] > 0, ≤ T
  int maxHalvings = 8;           ///< of Δt0, ≥ 0
  double improvement =
      1e-6;  ///< an action is accepted if J decreases by this fraction of J0, in [0, 1)
  bool searchTime = false;       ///< search for the best time to act; else act immediately
  double waitingExponent = 1.6;  ///< exponent γ of the waiting cost (τ − t0)^γ, > 0
};

/// Outcome of the search for an action.
enum class ActionEnd {
  acts,
  noGradient,     ///< no input changes J to first order: no action
  noImprovement,  ///< no duration lowered J enough: no action
  notFinite       ///< the predicted motion does not stay finite
};
std::string describe(ActionEnd why);

/// @throws std::domain_error naming the option, its value and the rule
void checkActionOptions(const ActionOptions& options);

namespace detail {
void checkActionLimits(const Eigen::Ref<const Eigen::VectorXd>& lower,
                       const Eigen::Ref<const Eigen::VectorXd>& upper);
void checkActionWeights(const Eigen::MatrixXd& inverseCovariance, const Eigen::VectorXd& scale,
                        double epsilon, const Eigen::MatrixXd& stateWeight,
                        const Eigen::MatrixXd& inputWeight);
}  // namespace detail

/// A constant input for a limited time, zero before and after.
template <int M>
struct Action {
  Vector<double, M> value = Vector<double, M>::Zero();
  double start = 0;     ///< τ − t0 [s]
  double duration = 0;  ///< Δt [s]
  ActionEnd why = ActionEnd::notFinite;
  double nominalCost = 0;  ///< J0, the cost without an action
  double cost = 0;         ///< J with the action
  double slope = 0;        ///< dJ/dΔt at Δt = 0, ≤ 0
  int trials = 0;          ///< durations tried
};

/// Sequential action control: computes one short, saturated action that improves the cost over the
/// next T seconds, without iterating over motions.
///
/// For systems affine in the input, ẋ = f(x, θ) + h(x, θ) u, extended by ψ: x̄ = (x, ψ). From the
/// current x̄, with u = 0,
///     J = ∫ l(x̄, u) dt,    −dρ/dt = D_x̄ lᵀ + D_x̄ f̄ᵀ ρ,  ρ(T) = 0,     b = h̄ᵀ ρ + D_u lᵀ
///     u* = (b bᵀ + R)⁻¹ b α_d,   α_d = descentRate·J0                       (2.21)
/// u* is clipped to its limits, which contain 0, so that it remains a descent direction. The time
/// of action is t0, or the node with the smallest |u*| + dJ/dΔt + (τ − t0)^γ. The duration is Δt0,
/// halved until J decreases. dJ/dΔt at Δt = 0 is the mode insertion gradient
///     ρᵀ (f̄(x̄, u*) − f̄(x̄, 0)) + l(x̄, u*) − l(x̄, 0)
///
/// x̄ and J by Runge–Kutta of order 4, ρ likewise on x̄ interpolated by cubics: errors O(step⁴).
/// Steps are split where the action begins and ends. A decision allocates no memory.
///
/// Source: Wilson's thesis, section 2.3.2, after Ansari and Murphey 2016. Differences: the term D_u
/// l, since the output and with it the information depend on u, and no terminal cost.
template <SmoothSystem S>
class SequentialActionControl {
 public:
  static constexpr int n = S::stateSize, m = S::inputSize, p = S::parameterSize;
  using State = StateOf<S>;
  using Psi = StateSensitivityOf<S>;
  using Input = InputOf<S>;
  using Theta = ParametersOf<S>;

  /// @param lower, upper limits of u with lower_i < 0 < upper_i
  /// @param inputWeight R ≻ 0
  /// @throws std::domain_error naming the violated rule
  SequentialActionControl(S system, InformationRateCost<S> cost, const Input& lower,
                          const Input& upper, const Matrix<double, m, m>& inputWeight,
                          const ActionOptions& options = {});

  /// The action for the current x and ψ.
  Action<m> decide(const State& x, const Psi& psi, const Theta& theta);

  /// J from (x, ψ) with `value` during [start, start + duration], 0 otherwise.
  double predictedCost(const State& x, const Psi& psi, const Theta& theta, const Input& value,
                       double start, double duration) const;

  /// dJ/dΔt at Δt = 0 of `value` inserted at node k of the last prediction.
  double insertionGradient(std::size_t k, const Input& value) const;

  /// b = h̄ᵀρ + D_u lᵀ at node k of the last prediction: the gradient of dJ/dΔt in u at u = 0.
  const Input& inputSlope(std::size_t k) const { return nodes_[k].b; }
  std::size_t nodes() const { return nodes_.size(); }
  double nodeTime(std::size_t k) const { return static_cast<double>(k) * step_; }

 private:
  struct Extended {
    State x;
    Psi psi;
  };
  struct Node {
    Extended at, rate, rho;
    Input b;
  };
  /// D_x̄ l, D_x̄ f̄ at a point.
  struct Local {
    decltype(extendedRateDerivatives(std::declval<S>(), State(), Psi(), Input(), Theta())) rate;
    typename InformationRateCost<S>::Gradient cost;
  };

  Extended rate(const Extended& at, const Input& u, const Theta& theta) const {
    const auto r = extendedRate(system_, at.x, at.psi, u, theta);
    return {r.value, r.along};
  }
  static Extended moved(const Extended& at, double h, const Extended& along) {
    return {at.x + h * along.x, at.psi + h * along.psi};
  }
  double costRate(const Extended& at, const Input& u, const Theta& theta) const {
    return cost_.value(system_, at.x, at.psi, u, theta);
  }
  /// One step of x̄; returns ∫ l dt over it.
  double advance(Extended& at, const Input& u, const Theta& theta, double h) const;
  double predict(const State& x, const Psi& psi, const Theta& theta);
  Local local(const Extended& at, const Theta& theta) const;
  Extended costateRate(const Local& at, const Extended& rho) const;
  void sweepBack(const Theta& theta);
  Input bestValue(const Input& b, double descent) const;

  S system_;
  InformationRateCost<S> cost_;
  Input lower_, upper_;
  Matrix<double, m, m> inputWeight_;
  ActionOptions options_;
  double step_;
  std::vector<Node> nodes_;
  Theta theta_ = Theta::Zero();
};

template <SmoothSystem S>
SequentialActionControl<S>::SequentialActionControl(S system, InformationRateCost<S> cost,
                                                    const Input& lower, const Input& upper,
                                                    const Matrix<double, m, m>& inputWeight,
                                                    const ActionOptions& options)
    : system_(std::move(system)),
      cost_(std::move(cost)),
      lower_(lower),
      upper_(upper),
      inputWeight_(inputWeight),
      options_(options) {
  checkActionOptions(options);
  detail::checkActionLimits(lower, upper);
  detail::checkActionWeights(cost_.inverseCovariance, cost_.scale, cost_.epsilon, cost_.stateWeight,
                             inputWeight);
  const auto steps = std::max(1.0, std::round(options.horizon / options.step));
  step_ = options.horizon / steps;
  nodes_.resize(static_cast<std::size_t>(steps) + 1);
}

template <SmoothSystem S>
double SequentialActionControl<S>::advance(Extended& at, const Input& u, const Theta& theta,
                                           double h) const {
  const Extended k1 = rate(at, u, theta);
  const Extended at2 = moved(at, h / 2, k1), k2 = rate(at2, u, theta);
  const Extended at3 = moved(at, h / 2, k2), k3 = rate(at3, u, theta);
  const Extended at4 = moved(at, h, k3), k4 = rate(at4, u, theta);
  const double cost = h / 6 *
                      (costRate(at, u, theta) + 2 * costRate(at2, u, theta) +
                       2 * costRate(at3, u, theta) + costRate(at4, u, theta));
  at.x += h / 6 * (k1.x + 2 * k2.x + 2 * k3.x + k4.x);
  at.psi += h / 6 * (k1.psi + 2 * k2.psi + 2 * k3.psi + k4.psi);
  return cost;
}

template <SmoothSystem S>
double SequentialActionControl<S>::predictedCost(const State& x, const Psi& psi, const Theta& theta,
                                                 const Input& value, double start,
                                                 double duration) const {
  // the nodes are kept, so that the error of the sum changes little with the action
  const double end = start + duration;
  Extended at{x, psi};
  double sum = 0;
  for (std::size_t k = 0; k + 1 < nodes_.size(); ++k) {
    const double from = nodeTime(k), to = nodeTime(k + 1);
    const double first = std::clamp(start, from, to), last = std::clamp(end, first, to);
    if (first > from) sum += advance(at, Input::Zero(), theta, first - from);
    if (last > first) sum += advance(at, value, theta, last - first);
    if (to > last) sum += advance(at, Input::Zero(), theta, to - last);
  }
  return sum;
}

template <SmoothSystem S>
double SequentialActionControl<S>::predict(const State& x, const Psi& psi, const Theta& theta) {
  Extended at{x, psi};
  double sum = 0;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    nodes_[k].at = at;
    nodes_[k].rate = rate(at, Input::Zero(), theta);
    if (k + 1 < nodes_.size()) sum += advance(at, Input::Zero(), theta, step_);
  }
  return sum;
}

template <SmoothSystem S>
typename SequentialActionControl<S>::Local SequentialActionControl<S>::local(
    const Extended& at, const Theta& theta) const {
  return {extendedRateDerivatives(system_, at.x, at.psi, Input(Input::Zero()), theta),
          cost_.gradient(system_, at.x, at.psi, Input::Zero(), theta)};
}

// D_x̄ lᵀ + D_x̄ f̄ᵀ ρ: ψ̇ depends on ψ by D_xf, and on x by the second derivatives of f.
template <SmoothSystem S>
typename SequentialActionControl<S>::Extended SequentialActionControl<S>::costateRate(
    const Local& at, const Extended& rho) const {
  const auto df_dx = at.rate.dw.template leftCols<n>();
  return {at.cost.x + df_dx.transpose() * rho.x +
              at.rate.dpsiw.template leftCols<n>().transpose() * rho.psi.reshaped(),
          at.cost.psi + df_dx.transpose() * rho.psi};
}

template <SmoothSystem S>
void SequentialActionControl<S>::sweepBack(const Theta& theta) {
  const double h = step_;
  const auto inputSlopeAt = [](const Local& at, const Extended& rho) -> Input {
    return at.rate.dw.template rightCols<m>().transpose() * rho.x +
           at.rate.dpsiw.template rightCols<m>().transpose() * rho.psi.reshaped() + at.cost.u;
  };
  Local after = local(nodes_.back().at, theta);
  nodes_.back().rho = {State::Zero(), Psi::Zero()};
  nodes_.back().b = inputSlopeAt(after, nodes_.back().rho);
  for (std::size_t k = nodes_.size() - 1; k-- > 0;) {
    const Node& next = nodes_[k + 1];
    Node& here = nodes_[k];
    const Extended middle{
        0.5 * (here.at.x + next.at.x) + h / 8 * (here.rate.x - next.rate.x),
        0.5 * (here.at.psi + next.at.psi) + h / 8 * (here.rate.psi - next.rate.psi)};
    const Local between = local(middle, theta), before = local(here.at, theta);
    const Extended k1 = costateRate(after, next.rho);
    const Extended k2 = costateRate(between, moved(next.rho, h / 2, k1));
    const Extended k3 = costateRate(between, moved(next.rho, h / 2, k2));
    const Extended k4 = costateRate(before, moved(next.rho, h, k3));
    here.rho.x = next.rho.x + h / 6 * (k1.x + 2 * k2.x + 2 * k3.x + k4.x);
    here.rho.psi = next.rho.psi + h / 6 * (k1.psi + 2 * k2.psi + 2 * k3.psi + k4.psi);
    here.b = inputSlopeAt(before, here.rho);
    after = before;
  }
}

template <SmoothSystem S>
double SequentialActionControl<S>::insertionGradient(std::size_t k, const Input& value) const {
  const Node& node = nodes_[k];
  const Extended with = rate(node.at, value, theta_);
  return node.rho.x.dot(with.x - node.rate.x) +
         (node.rho.psi.array() * (with.psi - node.rate.psi).array()).sum() +
         costRate(node.at, value, theta_) - costRate(node.at, Input::Zero(), theta_);
}

template <SmoothSystem S>
typename SequentialActionControl<S>::Input SequentialActionControl<S>::bestValue(
    const Input& b, double descent) const {
  const Matrix<double, m, m> H = b * b.transpose() + inputWeight_;
  const Input value = H.ldlt().solve(b * descent);
  return value.cwiseMax(lower_).cwiseMin(upper_);
}

template <SmoothSystem S>
Action<SequentialActionControl<S>::m> SequentialActionControl<S>::decide(const State& x,
                                                                         const Psi& psi,
                                                                         const Theta& theta) {
  Action<m> action;
  theta_ = theta;
  action.nominalCost = action.cost = predict(x, psi, theta);
  if (!std::isfinite(action.nominalCost)) return action;
  sweepBack(theta);
  const double descent = options_.descentRate * action.nominalCost;

  // time of the action
  std::size_t best = 0;
  if (options_.searchTime) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < nodes_.size(); ++k) {
      const Input value = bestValue(nodes_[k].b, descent);
      const double waiting = value.norm() + insertionGradient(k, value) +
                             std::pow(nodeTime(k), options_.waitingExponent);
      if (waiting < least) {
        least = waiting;
        best = k;
      }
    }
  }
  if (!nodes_[best].b.allFinite()) return action;
  const Input value = bestValue(nodes_[best].b, descent);
  action.slope = insertionGradient(best, value);
  if (value.isZero(0) || !(action.slope < 0)) {
    action.why = ActionEnd::noGradient;
    return action;
  }

  // how long
  action.start = nodeTime(best);
  double duration = options_.firstDuration;
  for (int halvings = 0; halvings <= options_.maxHalvings; ++halvings, duration /= 2) {
    ++action.trials;
    const double cost = predictedCost(x, psi, theta, value, action.start, duration);
    if (cost < action.nominalCost - options_.improvement * std::abs(action.nominalCost)) {
      action.value = value;
      action.duration = duration;
      action.cost = cost;
      action.why = ActionEnd::acts;
      return action;
    }
  }
  action.why = ActionEnd::noImprovement;
  return action;
}

}  // namespace info
