#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <string>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"
#include "info/probability/random_stream.h"

/// A mass on a spring and damper, one step a sample, in which everything is linear, so that every
/// law of the engine has a closed form:
///     x_{k+1} = F x_k + B (d_k + push + Σ nothing else),   y_k = x_k[0] + bias
/// Quantities: start position and speed of each trial, drag of the input (nuisance "gain" of u),
/// and the effects "push" (constant force, two-sided), "shove" (constant force, one-sided) and
/// "bias".
class LinearDisagreement : public info::discover::DiscoveryProblem {
 public:
  using VectorXd = Eigen::VectorXd;
  using MatrixXd = Eigen::MatrixXd;
  static constexpr double kStep = 0.05;

  LinearDisagreement(int trials, int samples) {
    F << 1, kStep, -8 * kStep, 1 - 1.2 * kStep;
    F(0, 0) -= 0.5 * 8 * kStep * kStep;
    B << 0.5 * kStep * kStep, kStep;
    quantities_ = {{"gain", "", 1, -10, 10, 0.2},
                   {"push", "N", 0, -50, 50, 1},
                   {"shove", "N", 0, 0, 50, 1},
                   {"bias", "m", 0, -50, 50, 0.5}};
    nuisances_ = {0};
    for (int t = 0; t < trials; ++t) {
      quantities_.push_back({"x" + std::to_string(t), "m", 0, -50, 50, 0.3, false, t});
      quantities_.push_back({"v" + std::to_string(t), "m/s", 0, -50, 50, 0.3, false, t});
      nuisances_.push_back(quantities_.size() - 2);
      nuisances_.push_back(quantities_.size() - 1);
    }
    for (std::size_t i = 1; i < 4; ++i) {
      info::discover::Candidate c;
      c.id = c.name = quantities_[i].name;
      c.sentence = "test";
      c.quantities = {i};
      c.sds = {quantities_[i].sd};
      c.starts = {VectorXd::Constant(1, i == 2 ? 0.1 : 0.0)};
      if (i == 3) c.kind = info::discover::EffectKind::sensor;
      candidates_.push_back(c);
    }
    for (int k = 0; k < samples; ++k) times_.push_back(kStep * k), nodes_.push_back({kStep * k, 0});
    measured_.assign(static_cast<std::size_t>(trials), VectorXd::Zero(samples));
  }

  /// Fills in measurements drawn from the model itself.
  void draw(std::uint64_t seed, const VectorXd& values, double output, double latent,
            double latentTime) {
    for (int t = 0; t < numTrials(); ++t) {
      info::RandomStream random(seed, static_cast<std::uint64_t>(t));
      const auto n = static_cast<Eigen::Index>(times_.size());
      VectorXd d(n);
      const double rho = std::exp(-kStep / latentTime);
      for (Eigen::Index k = 0; k < n; ++k)
        d[k] = k == 0 ? latent * random.normal()
                      : rho * d[k - 1] + latent * std::sqrt(1 - rho * rho) * random.normal();
      VectorXd y = outputs(t, values, d);
      for (Eigen::Index k = 0; k < n; ++k) y[k] += output * random.normal();
      measured_[static_cast<std::size_t>(t)] = y;
    }
  }
  void measure(int trial, const VectorXd& y) { measured_[static_cast<std::size_t>(trial)] = y; }
  double input(Eigen::Index k) const { return std::sin(0.3 * static_cast<double>(k)); }

  const std::vector<info::discover::Quantity>& quantities() const override { return quantities_; }
  const std::vector<std::size_t>& nuisances() const override { return nuisances_; }
  const std::vector<info::discover::Candidate>& candidates() const override { return candidates_; }
  int numTrials() const override { return static_cast<int>(measured_.size()); }
  std::string trialName(int trial) const override { return "trial " + std::to_string(trial); }
  const std::vector<double>& times(int) const override { return times_; }
  const VectorXd& measured(int trial) const override {
    return measured_[static_cast<std::size_t>(trial)];
  }
  const std::vector<info::discover::Node>& nodes(int) const override { return nodes_; }
  double latentLag() const override { return lag; }

  Prediction predict(int trial, const VectorXd& values, const VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    const auto n = static_cast<Eigen::Index>(times_.size());
    Prediction p;
    p.outputs = outputs(trial, values, latent);
    p.speeds = tellsSpeeds ? speeds(p.outputs) : VectorXd(VectorXd::Zero(n));
    p.gamma.resize(n, static_cast<Eigen::Index>(wanted.size()));
    for (std::size_t j = 0; j < wanted.size(); ++j) {
      VectorXd unit = VectorXd::Zero(values.size());
      unit[static_cast<Eigen::Index>(wanted[j])] = 1;
      p.gamma.col(static_cast<Eigen::Index>(j)) = outputs(trial, unit, {});
    }
    if (latentToo) {
      p.scale = scale.size() == 0 ? MatrixXd(MatrixXd::Ones(n, 1)) : scale;
      p.byNode.resize(n, n);
      p.courseByNode.resize(n, n);
      const VectorXd still = VectorXd::Zero(values.size());
      for (Eigen::Index j = 0; j < n; ++j) {
        p.byNode.col(j) = outputs(trial, still, VectorXd::Unit(n, j));
        p.courseByNode.col(j) = states(trial, still, VectorXd::Unit(n, j)).col(0);
      }
      const MatrixXd x = states(trial, values, latent);
      p.course = {x.col(0), x.col(1)};
    }
    return p;
  }
  VectorXd outputs(int trial, const VectorXd& values, const VectorXd& latent) const override {
    return states(trial, values, latent).col(0).array() + values[3];
  }
  MatrixXd inputs(int) const override {
    MatrixXd u(times_.size(), 1);
    for (Eigen::Index k = 0; k < u.rows(); ++k) u(k, 0) = input(k);
    return u;
  }
  std::vector<std::string> inputNames() const override { return {"u"}; }

  MatrixXd scale;  ///< of the latent force, samples × channels; empty: 1
  double lag = 0;  ///< [s]
  bool tellsSpeeds = false;
  Eigen::Matrix2d F;
  Eigen::Vector2d B;

 private:
  MatrixXd states(int trial, const VectorXd& values, const VectorXd& latent) const {
    const auto n = static_cast<Eigen::Index>(times_.size());
    MatrixXd all(n, 2);
    Eigen::Vector2d x = values.segment<2>(4 + 2 * trial);
    for (Eigen::Index k = 0; k < n; ++k) {
      all.row(k) = x.transpose();
      const double d = latent.size() != 0 ? latent[k] : 0;
      x = F * x + B * (d + values[0] * input(k) + values[1] + values[2]);
    }
    return all;
  }
  static VectorXd speeds(const VectorXd& y) {
    const Eigen::Index n = y.size();
    VectorXd slopes = VectorXd::Zero(n);
    slopes.segment(1, n - 2) = (y.tail(n - 2) - y.head(n - 2)) / (2 * kStep);
    return slopes;
  }

  std::vector<info::discover::Quantity> quantities_;
  std::vector<std::size_t> nuisances_;
  std::vector<info::discover::Candidate> candidates_;
  std::vector<double> times_;
  std::vector<info::discover::Node> nodes_;
  std::vector<VectorXd> measured_;
};
