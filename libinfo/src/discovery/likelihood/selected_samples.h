#pragma once

#include <memory>

#include "info/discovery/likelihood/forwarding_problem.h"

namespace info::discover {

/// A discovery problem without some of its samples.
class SelectedSamples final : public ForwardingProblem {
 public:
  /// @param data  must outlive this
  /// @param kept by trial: ascending indices of the kept samples, at least one
  SelectedSamples(const DiscoveryProblem& data, const std::vector<std::vector<std::size_t>>& kept);
  SelectedSamples(std::unique_ptr<DiscoveryProblem> data,
                  const std::vector<std::vector<std::size_t>>& kept);

  const std::vector<double>& times(int trial) const override { return of(trial).times; }
  const std::vector<int>& outputOfSample(int trial) const override { return of(trial).outputs; }
  const Eigen::VectorXd& measured(int trial) const override { return of(trial).measured; }
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
  void select();
  const OfTrial& of(int trial) const { return trials_.at(static_cast<std::size_t>(trial)); }

  std::vector<std::vector<std::size_t>> kept_;
  std::vector<OfTrial> trials_;
};

}  // namespace info::discover
