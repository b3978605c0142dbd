#pragma once

#include <string>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"
#include "robots/robot_effects.h"

namespace info::robot {

struct DisagreementOptions {
  double step = 0.005;          ///< longest time step [s] > 0
  double latentSpacing = 0.05;  ///< between nodes of the latent acceleration [s] > 0
  /// Standard deviation of the noise of each channel [its unit] > 0; empty: from the data's third
  /// differences.
  std::vector<double> sds;
  std::vector<std::string> without;  ///< ids of excluded candidates
};

/// The discovery problem of a robot and its recordings for info::discover.
///
/// The latent force is an additional acceleration of the cart [m/s²], of scale 1, as caused by
/// drives and floors. Friction of the first joint has nearly the same effect; its angle is
/// therefore taken as the position of the axis.
///
/// A robot may measure several channels, each an output; samples are in the order of time.
///
/// All derivatives are exact. The cart is at rest before the first row.
class RobotProblem final : public discover::DiscoveryProblem {
 public:
  /// @throws std::invalid_argument for a trial that violates a rule of Trial or has no measured
  ///   value, a channel with fewer than eight values in all, an unknown id, an option out of range
  RobotProblem(Model model, std::vector<Trial> trials, DisagreementOptions options = {});

  const std::vector<discover::Quantity>& quantities() const override { return quantities_; }
  const std::vector<std::size_t>& nuisances() const override { return nuisances_; }
  const std::vector<discover::Candidate>& candidates() const override { return model_.candidates; }
  int numTrials() const override { return static_cast<int>(trials_.size()); }
  std::string trialName(int trial) const override { return of(trial).trial.name; }
  const std::vector<double>& times(int trial) const override { return of(trial).times; }
  const std::vector<int>& outputOfSample(int trial) const override { return of(trial).channels; }
  const Eigen::VectorXd& measured(int trial) const override { return of(trial).measured; }
  const std::vector<discover::Axis>& axes() const override { return axes_; }
  const std::vector<discover::Node>& nodes(int trial) const override {
    return of(trial).latentNodes;
  }
  Prediction predict(int trial, const Eigen::VectorXd& values, const Eigen::VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override;
  Eigen::VectorXd outputs(int trial, const Eigen::VectorXd& values,
                          const Eigen::VectorXd& latent) const override;
  Eigen::VectorXd refinedOutputs(int trial, const Eigen::VectorXd& values) const override;
  Eigen::MatrixXd inputs(int trial) const override;
  std::vector<std::string> inputNames() const override { return {"cart acceleration"}; }

  const Model& model() const { return model_; }
  /// σ_c [unit of the channel].
  const std::vector<double>& sds() const { return sds_; }
  /// Model::states at the trial's rows.
  Eigen::MatrixXd states(int trial, const Eigen::VectorXd& values) const;

 private:
  struct OfTrial {
    Trial trial;
    std::vector<Sample> samples;
    std::vector<double> times, nodes;
    std::vector<discover::Node> latentNodes;  ///< the same
    std::vector<int> channels;
    Eigen::VectorXd measured;
    std::size_t start;  ///< index of the first quantity of its initial state
  };
  const OfTrial& of(int trial) const { return trials_.at(static_cast<std::size_t>(trial)); }
  Response simulate(const OfTrial& trial, const Eigen::VectorXd& values,
                    const Eigen::VectorXd& latent, const std::vector<std::size_t>& shared,
                    bool derivatives, bool latentToo, double stepFactor) const;

  Model model_;
  DisagreementOptions options_;
  std::vector<double> sds_;
  std::vector<discover::Axis> axes_ = {{"angle of the first joint", "rad", "m/s²"}};
  std::vector<discover::Quantity>
      quantities_;  ///< those of the model, then the initial states of the trials
  std::vector<std::size_t> nuisances_;
  std::vector<OfTrial> trials_;
};

}  // namespace info::robot
