#pragma once

#include <memory>
#include <utility>

#include "info/discovery/likelihood/discovery_problem.h"

namespace info::discover {

/// A discovery problem that is another one, but for what a derived class changes.
class ForwardingProblem : public DiscoveryProblem {
 public:
  /// @param data  must outlive this
  explicit ForwardingProblem(const DiscoveryProblem& data) : data_(data) {}
  explicit ForwardingProblem(std::unique_ptr<DiscoveryProblem> data)
      : owned_(std::move(data)), data_(*owned_) {}

  const std::vector<Quantity>& quantities() const override { return data_.quantities(); }
  const std::vector<std::size_t>& nuisances() const override { return data_.nuisances(); }
  const std::vector<Candidate>& candidates() const override { return data_.candidates(); }
  int numTrials() const override { return data_.numTrials(); }
  std::string trialName(int trial) const override { return data_.trialName(trial); }
  const std::vector<double>& times(int trial) const override { return data_.times(trial); }
  const std::vector<int>& outputOfSample(int trial) const override {
    return data_.outputOfSample(trial);
  }
  const Eigen::VectorXd& measured(int trial) const override { return data_.measured(trial); }
  const std::vector<Axis>& axes() const override { return data_.axes(); }
  const std::vector<Node>& nodes(int trial) const override { return data_.nodes(trial); }
  double latentLag() const override { return data_.latentLag(); }
  Prediction predict(int trial, const Eigen::VectorXd& values, const Eigen::VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    return data_.predict(trial, values, latent, wanted, latentToo);
  }
  std::unique_ptr<Simulation> simulated(int trial, const Eigen::VectorXd& values,
                                        const Eigen::VectorXd& latent,
                                        const std::vector<std::size_t>& wanted,
                                        bool latentToo) const override {
    return data_.simulated(trial, values, latent, wanted, latentToo);
  }
  Eigen::VectorXd outputs(int trial, const Eigen::VectorXd& values,
                          const Eigen::VectorXd& latent) const override {
    return data_.outputs(trial, values, latent);
  }
  Eigen::VectorXd refinedOutputs(int trial, const Eigen::VectorXd& values) const override {
    return data_.refinedOutputs(trial, values);
  }
  std::unique_ptr<DiscoveryProblem> nudged(double frequency) const override {
    return data_.nudged(frequency);
  }
  Eigen::MatrixXd inputs(int trial) const override { return data_.inputs(trial); }
  std::vector<std::string> inputNames() const override { return data_.inputNames(); }
  std::unique_ptr<DiscoveryProblem> withFormula(
      std::size_t axis, const std::vector<FormulaTerm>& terms,
      const std::vector<std::size_t>& kept) const override {
    return data_.withFormula(axis, terms, kept);
  }

 protected:
  const DiscoveryProblem& data() const { return data_; }

 private:
  std::unique_ptr<DiscoveryProblem> owned_;
  const DiscoveryProblem& data_;
};

}  // namespace info::discover
