#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>

#include "info/autodiff/dual.h"
#include "robots/robot_effects.h"

// Simulation of a robot with its exact derivatives. Each step is differentiated by itself with
// respect to its state, the latent acceleration at its three stages and up to kSlots quantities;
// the chain rule makes whole trials of it, so that the cost of a latent node is a column.
//
// A plant has `stateSize`, `sharedSize`, `startSize`, places `lag` and `clock` among
// its quantities, `rate1`, the place of the rate of x[0] in its state, and templates over the
// scalar
//     start(s, u, p)           state at rest but for the start quantities s
//     step(x, u, h, p)         its state (all but the last entry) after h; u at 0, h/2 and h
//     outputs(x, u, p)
// The last entry of a state is the cart's acceleration without the latent one, which lags.
namespace info::robot {

inline constexpr int kSlots = 16;

template <class T, std::size_t N>
std::array<T, N> moved(const std::array<T, N>& x, double h, const std::array<T, N>& rate) {
  std::array<T, N> y;
  for (std::size_t i = 0; i < N; ++i) y[i] = x[i] + h * rate[i];
  return y;
}

// The classical Runge–Kutta step of x' = rate(x, u).
template <class Rate, class T, std::size_t N>
std::array<T, N> rungeKutta(const Rate& rate, const std::array<T, N>& x, const std::array<T, 3>& u,
                            double h) {
  const auto k1 = rate(x, u[0]);
  const auto k2 = rate(moved(x, h / 2, k1), u[1]);
  const auto k3 = rate(moved(x, h / 2, k2), u[1]);
  const auto k4 = rate(moved(x, h, k3), u[2]);
  std::array<T, N> y;
  for (std::size_t i = 0; i < N; ++i)
    y[i] = x[i] + (h / 6) * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
  return y;
}

// What the cart does at `time` after the start of a step, the command being linear:
// T·ȧ_c = a − a_c, solved exactly.
template <class T>
T lagged(const T& behind, double command, double slope, double time, const T& lag) {
  using std::exp;
  T kept(0.0);
  if (plainValue(lag) > 0) kept = exp(-time / lag);
  return command + slope * time - slope * lag + (behind - command + slope * lag) * kept;
}

// The latent acceleration, straight between nodes.
class LatentSignal {
 public:
  LatentSignal(const std::vector<double>& nodes, const Eigen::VectorXd& values)
      : nodes_(nodes), values_(values), spacing_(nodes.size() > 1 ? nodes[1] - nodes[0] : 1) {}
  struct Place {
    Eigen::Index node = 0;
    double share = 0;
  };
  Place placeOf(double t) const {
    const double at = std::max(0.0, (t - nodes_.front()) / spacing_);
    const auto last = static_cast<double>(nodes_.size()) - 2;
    const double node = std::clamp(std::floor(at), 0.0, std::max(last, 0.0));
    return {static_cast<Eigen::Index>(node), std::min(at - node, 1.0)};
  }
  double at(double t) const {
    if (values_.size() == 0) return 0;
    const Place p = placeOf(t);
    return (1 - p.share) * values_[p.node] + p.share * values_[p.node + 1];
  }

 private:
  const std::vector<double>& nodes_;
  const Eigen::VectorXd& values_;
  double spacing_;
};

template <class Plant, class T>
class StepSensitivity {
 public:
  static constexpr int n = Plant::stateSize, starts = Plant::startSize;
  static constexpr bool differentiated = !std::same_as<T, double>;
  using State = std::array<T, static_cast<std::size_t>(n)>;

  StepSensitivity(const Request& request, std::size_t first, Response& response)
      : request_(request),
        first_(first),
        response_(response),
        latent_(request.nodes, request.latent) {
    for (std::size_t i = 0; i < p_.size(); ++i) p_[i] = T(request.shared[static_cast<int>(i)]);
    slots_ = std::min(request.wanted.size() - std::min(first, request.wanted.size()),
                      static_cast<std::size_t>(kSlots));
    for (std::size_t j = 0; j < slots_; ++j) {
      const std::size_t q = request.wanted[first + j];
      p_[q] = variable(request.shared[static_cast<int>(q)], n + 3 + static_cast<int>(j));
    }
    columns_ = starts + kSlots;
    if (request.latentToo && first == 0) columns_ += static_cast<int>(request.nodes.size());
  }

  void run() {
    begin();
    const auto& times = request_.trial.times;
    const auto& command = request_.trial.acceleration;
    keepState(0);
    for (std::size_t row = 0; row + 1 < times.size(); ++row) {
      const double all = times[row + 1] - times[row];
      const double slope = (command[row + 1] - command[row]) / all;
      const int count = std::max(1, static_cast<int>(std::ceil(all / request_.step - 1e-9)));
      const double h = all / count;
      for (int j = 0; j < count; ++j)
        if (!step(times[row] + j * h, h, command[row] + slope * (j * h), slope)) return;
      keepState(static_cast<Eigen::Index>(row) + 1);
    }
    if constexpr (differentiated) {  // nodes behind the end
      while (isCourseWanted()) keepCourse(0, 1, x_, S_, x_, S_);
    }
  }

 private:
  static T variable(double value, int direction) {
    if constexpr (differentiated)
      return T(value, 0, direction);
    else
      return direction < 0 ? 0.0 : value;
  }

  void begin() {
    std::array<T, static_cast<std::size_t>(starts)> s;
    for (int i = 0; i < starts; ++i)
      s[static_cast<std::size_t>(i)] = variable(request_.start[i], i);
    const double t = request_.trial.times.front();
    const T cart = T(request_.trial.acceleration.front());
    State x = Plant::start(s, T(cart + variable(latent_.at(t), n)), p_);
    x.back() = cart;
    if constexpr (differentiated) {
      S_ = Eigen::MatrixXd::Zero(n, columns_);
      Eigen::Matrix<double, n, T::DerType::RowsAtCompileTime> local;
      for (int i = 0; i < n; ++i) local.row(i) = x[static_cast<std::size_t>(i)].derivatives();
      S_.leftCols(starts) = local.leftCols(starts);
      S_.middleCols(starts, kSlots) = local.rightCols(kSlots);
      addLatent(S_, local.col(n), t);
    }
    for (int i = 0; i < n; ++i) x_[static_cast<std::size_t>(i)] = plainValue(x[std::size_t(i)]);
  }

  bool step(double t, double h, double command, double slope) {
    State x;
    for (int i = 0; i < n; ++i) x[std::size_t(i)] = variable(x_[std::size_t(i)], i);
    const T& lag = p_[Plant::lag];
    const double times[3] = {t, t + h / 2, t + h};
    std::array<T, 3> u;
    T end(0.0);
    for (std::size_t i = 0; i < 3; ++i) {
      const T cart = i == 0 ? x.back() : lagged(x.back(), command, slope, times[i] - t, lag);
      u[i] = cart + variable(latent_.at(times[i]), n + static_cast<int>(i));
      if (i == 2) end = cart;
    }
    State next = Plant::step(x, u, h, p_);
    next.back() = end;
    for (const T& one : next)
      if (!(std::abs(plainValue(one)) < 1e6)) return false;
    measure(t, h, x, next, u, times);
    if constexpr (differentiated) {
      Eigen::Matrix<double, n, n> A;
      Eigen::Matrix<double, n, 3> D;
      Eigen::Matrix<double, n, kSlots> B;
      for (int i = 0; i < n; ++i) {
        const auto& d = next[std::size_t(i)].derivatives();
        A.row(i) = d.template head<n>().transpose();
        D.row(i) = d.template segment<3>(n).transpose();
        B.row(i) = d.template tail<kSlots>().transpose();
      }
      Eigen::MatrixXd after = A * S_;
      after.middleCols(starts, kSlots) += B;
      for (int i = 0; i < 3; ++i) addLatent(after, D.col(i), times[i]);
      S_.swap(after);
      std::array<double, static_cast<std::size_t>(n)> ended;
      for (int i = 0; i < n; ++i) ended[std::size_t(i)] = plainValue(next[std::size_t(i)]);
      while (isCourseWanted() && request_.nodes[node_] <= t + h * (1 + 1e-9))
        keepCourse((request_.nodes[node_] - t) / h, h, x_, after, ended, S_);
    }
    for (int i = 0; i < n; ++i) x_[std::size_t(i)] = plainValue(next[std::size_t(i)]);
    return true;
  }

  template <class Target, class Column>
  void addLatent(Target& to, const Column& column, double t) const {
    if (columns_ == starts + kSlots) return;
    const auto place = latent_.placeOf(t);
    const Eigen::Index at = starts + kSlots + place.node;
    to.col(at) += (1 - place.share) * column;
    to.col(at + 1) += place.share * column;
  }

  // Samples whose time, less the clock's offset, lies in this step or before the start; straight
  // between the step's ends, before the start as at the start.
  void measure(double t, double h, const State& x0, const State& x1, const std::array<T, 3>& u,
               const double (&times)[3]) {
    for (; sample_ < request_.samples.size(); ++sample_) {
      const Sample& sample = request_.samples[sample_];
      double place = (sample.time - t) / h;
      if (std::abs(place - std::round(place)) < 1e-7) place = std::round(place);
      T s = place - p_[Plant::clock] / h;
      if (plainValue(s) > 1) break;
      if (plainValue(s) < 0 || place <= 0) s = T(0.0);
      State x;
      for (int i = 0; i < n; ++i) {
        const auto k = std::size_t(i);
        x[k] = x0[k] + s * (x1[k] - x0[k]);
        if (plainValue(s) == 1) x[k] = x1[k] + (s - 1.0) * (x1[k] - x0[k]);
      }
      T input = u[0] + s * (u[2] - u[0]);
      if (plainValue(s) == 1) input = u[2] + (s - 1.0) * (u[2] - u[0]);
      const auto channel = static_cast<std::size_t>(sample.channel);
      const T y = Plant::outputs(x, input, p_)[channel];
      const T from = Plant::outputs(x0, u[0], p_)[channel],
              to = Plant::outputs(x1, u[2], p_)[channel];
      const auto at = static_cast<Eigen::Index>(sample_);
      response_.outputs[at] = plainValue(y);
      response_.speeds[at] = (plainValue(to) - plainValue(from)) / h;
      if constexpr (differentiated) {
        const auto& d = y.derivatives();
        Eigen::RowVectorXd row = d.template head<n>().transpose() * S_;
        row.segment(starts, kSlots) += d.template tail<kSlots>().transpose();
        for (int i = 0; i < 3; ++i) addLatent(row, d.template segment<1>(n + i), times[i]);
        if (first_ == 0) {
          response_.byStart.row(at) = row.head(starts);
          if (request_.latentToo)
            response_.byLatent.row(at) = row.tail(static_cast<int>(request_.nodes.size()));
        }
        response_.byWanted.row(at).segment(static_cast<int>(first_), static_cast<int>(slots_)) =
            row.segment(starts, static_cast<int>(slots_));
      }
    }
  }

  bool isCourseWanted() const {
    return request_.latentToo && first_ == 0 && node_ < request_.nodes.size();
  }

  // The first joint at the next node, by Hermite's cubic at share s of a step of length h.
  template <class Numbers>
  void keepCourse(double s, double h, const Numbers& x0, const Eigen::MatrixXd& S0,
                  const Numbers& x1, const Eigen::MatrixXd& S1) {
    constexpr int rate = Plant::rate1;
    const double h01 = s * s * (3 - 2 * s), h00 = 1 - h01;
    const double h10 = h * s * (1 - s) * (1 - s), h11 = -h * s * s * (1 - s);
    const double slope = 6 * s * (1 - s) / h;
    const auto at = static_cast<Eigen::Index>(node_++);
    response_.angle[at] = h00 * x0[0] + h10 * x0[rate] + h01 * x1[0] + h11 * x1[rate];
    response_.rate[at] =
        slope * (x1[0] - x0[0]) + (1 - s) * (1 - 3 * s) * x0[rate] + s * (3 * s - 2) * x1[rate];
    const Eigen::RowVectorXd row =
        h00 * S0.row(0) + h10 * S0.row(rate) + h01 * S1.row(0) + h11 * S1.row(rate);
    response_.angleByLatent.row(at) = row.tail(static_cast<int>(request_.nodes.size()));
  }

  void keepState(Eigen::Index row) {
    if (first_ != 0) return;
    for (int i = 0; i < n; ++i) response_.states(row, i) = x_[std::size_t(i)];
  }

  const Request& request_;
  std::size_t first_;
  Response& response_;
  LatentSignal latent_;
  std::array<T, static_cast<std::size_t>(Plant::sharedSize)> p_;
  std::array<double, static_cast<std::size_t>(n)> x_{};
  Eigen::MatrixXd S_;
  std::size_t slots_ = 0, sample_ = 0, node_ = 0;
  int columns_ = 0;
};

template <class Plant>
Response walk(const Request& request) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto samples = static_cast<Eigen::Index>(request.samples.size());
  Response response;
  response.outputs = Eigen::VectorXd::Constant(samples, nan);
  response.speeds = response.outputs;
  response.states.setConstant(static_cast<Eigen::Index>(request.trial.times.size()),
                              Plant::stateSize, nan);
  if (!request.derivatives) {
    StepSensitivity<Plant, double>(request, 0, response).run();
    return response;
  }
  response.byWanted.setConstant(samples, static_cast<Eigen::Index>(request.wanted.size()), nan);
  response.byStart.setConstant(samples, Plant::startSize, nan);
  if (request.latentToo) {
    const auto nodes = static_cast<Eigen::Index>(request.nodes.size());
    response.byLatent.setConstant(samples, nodes, nan);
    response.angle.setConstant(nodes, nan);
    response.rate.setConstant(nodes, nan);
    response.angleByLatent.setConstant(nodes, nodes, nan);
  }
  std::size_t first = 0;
  do {
    StepSensitivity<Plant, Dual<Plant::stateSize + 3 + kSlots>>(request, first, response).run();
    first += kSlots;
  } while (first < request.wanted.size());
  return response;
}

}  // namespace info::robot
