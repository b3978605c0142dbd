#pragma once

#include <array>
#include <string>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"
#include "reduced/reduced_formula.h"

namespace reduced {

constexpr int kMuscles = 4;     ///< biceps, brachialis, brachioradialis, triceps
constexpr double kTick = 0.01;  ///< between samples [s]
constexpr double kNode = 0.05;  ///< between nodes of the latent force [s]

/// One recording: excitations and elbow angle at 100 Hz.
struct Trial {
  std::vector<std::array<double, kMuscles>>
      excitations;            ///< at 0, 0.01, 0.02 … s, straight between
  double firstSample = 0.12;  ///< [s]; before it there is only history, for delays and clocks
  Eigen::VectorXd angles;     ///< measured [rad], every 0.01 s from firstSample on
  double startAngle = 0, startSpeed = 0;  ///< what is believed of t = 0 [rad], [rad/s]
};

struct Motion;

/// A reduced elbow: one hinge, gravity, four muscles with rigid tendons whose excitations are
/// given.
///
///     I·q̈ = Σ_i r_i(q)·F_i − M·g·l_c·sin q + effects + d
///     F_i = F0_i·(a_i·f_l(ℓ_i)·f_v(v_i) + f_p(ℓ_i)),   ȧ = (u − a)·(u/τ_a + (1 − u)/τ_d)
///     ℓ_i = (ℓ_i0 − ∫r_i dq)/ℓ_opt,i,   v_i = −r_i·q̇/(10/s·ℓ_opt,i)
/// q = 0 hangs, flexion counts positive. Solved by the classical Runge–Kutta method in steps of
/// `step`, with its exact derivatives carried along.
///
/// Uncertain in every hypothesis: F0_i (15 %), ℓ_opt,i (4 %), mass (5 %), activation time (20 %),
/// and each trial's start. Catalogue of 31 effects; the truth in benchmarks is other code
/// (reduced_truth.h).
class Elbow final : public info::discover::DiscoveryProblem {
 public:
  /// @param hidden candidates that the catalogue shall not have (leave-one-out)
  explicit Elbow(std::vector<Trial> trials, const std::vector<std::string>& hidden = {},
                 double step = 0.01);

  const std::vector<info::discover::Quantity>& quantities() const override { return quantities_; }
  const std::vector<std::size_t>& nuisances() const override { return nuisances_; }
  const std::vector<info::discover::Candidate>& candidates() const override { return candidates_; }
  int numTrials() const override { return static_cast<int>(trials_.size()); }
  std::string trialName(int trial) const override { return "trial " + std::to_string(trial + 1); }
  const std::vector<double>& times(int trial) const override { return times_[index(trial)]; }
  const Eigen::VectorXd& measured(int trial) const override { return trials_[index(trial)].angles; }
  const std::vector<info::discover::Axis>& axes() const override;
  const std::vector<info::discover::Node>& nodes(int trial) const override {
    return nodes_[index(trial)];
  }
  Prediction predict(int trial, const Eigen::VectorXd& values, const Eigen::VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override;
  Eigen::VectorXd outputs(int trial, const Eigen::VectorXd& values,
                          const Eigen::VectorXd& latent) const override;
  Eigen::VectorXd refinedOutputs(int trial, const Eigen::VectorXd& values) const override;
  Eigen::MatrixXd inputs(int trial) const override;
  std::vector<std::string> inputNames() const override { return {"BIC", "BRA", "BRD", "TRI"}; }
  /// Null if StateTerm knows one of the terms not.
  std::unique_ptr<info::discover::DiscoveryProblem> withFormula(
      std::size_t axis, const std::vector<info::discover::FormulaTerm>& terms,
      const std::vector<std::size_t>& kept) const override;

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  template <bool derivatives>
  Motion solve(int trial, double step, const Eigen::VectorXd& values, const Eigen::VectorXd& latent,
               const std::vector<std::size_t>& wanted, bool latentToo) const;

  std::vector<Trial> trials_;
  double step_;
  std::vector<StateTerm> formula_;
  Eigen::Index formulaAt_ = 0;  ///< its first quantity
  std::vector<info::discover::Quantity> quantities_;
  std::vector<std::size_t> nuisances_;
  std::vector<info::discover::Candidate> candidates_;
  std::vector<std::vector<double>> times_;
  std::vector<std::vector<info::discover::Node>> nodes_;
};

}  // namespace reduced
