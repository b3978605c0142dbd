#pragma once

#include <memory>

#include "info/discovery/likelihood/discovery_problem.h"

namespace info::discover {

/// A discovery problem without some of its samples.
class SelectedSamples final : public DiscoveryProblem {
 public:
  /// @param data  must outlive this
  /// @param kept by trial: ascending indices of the kept samples, at least one
  SelectedSamples(const DiscoveryProblem& data, const std::vector<std::vector<std::size_t>>& kept);
  SelectedSamples(std::unique_ptr<DiscoveryProblem> data,
                  const std::vector<std::vector<std::size_t>>& kept);

  const std::vector<Quantity>& quantities() const override { return data_.quantities(); }
  const std::vector<std::size_t>& nuisances() const override { return data_.nuisances(); }
  const std::vector<Candidate>& candidates() const override { return data_.candidates(); }
  int numTrials() const override { return data_.numTrials(); }
  std::string trialName(int trial) const override { return data_.trialName(trial); }
  const std::vector<double>& times(int trial) const override { return of(trial).times; }
  const std::vector<int>& outputOfSample(int trial) const override { return of(trial).outputs; }
  const Eigen::VectorXd& measured(int trial) const override { return of(trial).measured; }
  const std::vector<Axis>& axes() const override { return data_.axes(); }
  const std::vector<Node>& nodes(int trial) const override { return data_.nodes(trial); }
  double latentLag() const override { return data_.latentLag(); }
  Prediction predict(int trial, const Eigen::VectorXd& values, const Eigen::VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override;
  std::unique_ptr<Simulation> simulated(int trial, const Eigen::VectorXd& values,
                                        const Eigen::VectorXd& latent,
                                        const std::vector<std::size_t>& wanted,
                                        bool latentToo) const override;
  Eigen::VectorXd outputs(int trial, const Eigen::VectorXd& values,
                          const Eigen::VectorXd& latent) const override;
  Eigen::VectorXd refinedOutputs(int trial, const Eigen::VectorXd& values) const override;
  std::unique_ptr<DiscoveryProblem> nudged(double frequency) const override;
  Eigen::MatrixXd inputs(int trial) const override;
  std::vector<std::string> inputNames() const override { return data_.inputNames(); }
  std::unique_ptr<DiscoveryProblem> withFormula(
      std::size_t axis, const std::vector<FormulaTerm>& terms,
      const std::vector<std::size_t>& kept) const override;

 private:
  class Some;
  struct OfTrial {
    std::vector<Eigen::Index> samples;
    std::vector<double> times;
    std::vector<int> outputs;
    Eigen::VectorXd measured;
  };
  const OfTrial& of(int trial) const { return trials_.at(static_cast<std::size_t>(trial)); }

  std::unique_ptr<DiscoveryProblem> owned_;
  const DiscoveryProblem& data_;
  std::vector<std::vector<std::size_t>> kept_;
  std::vector<OfTrial> trials_;
};

}  // namespace info::discover
