#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "info/discovery/likelihood/forwarding_problem.h"

namespace info::discover {

/// Thrown internally if the caller requests a stop.
struct Stopped {};

/// A discovery problem that asks before every simulation whether to go on. Formulas are simulated
/// without asking.
class WatchedProblem final : public ForwardingProblem {
 public:
  /// @param data  must outlive this
  /// @param goOn  false: the simulation throws Stopped; empty: never
  WatchedProblem(const DiscoveryProblem& data, std::function<bool()> goOn)
      : ForwardingProblem(data), goOn_(std::move(goOn)) {}
  WatchedProblem(std::unique_ptr<DiscoveryProblem> data, std::function<bool()> goOn)
      : ForwardingProblem(std::move(data)), goOn_(std::move(goOn)) {}

  Prediction predict(int trial, const Eigen::VectorXd& values, const Eigen::VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override {
    ask();
    return data().predict(trial, values, latent, wanted, latentToo);
  }
  std::unique_ptr<Simulation> simulated(int trial, const Eigen::VectorXd& values,
                                        const Eigen::VectorXd& latent,
                                        const std::vector<std::size_t>& wanted,
                                        bool latentToo) const override {
    ask();
    return data().simulated(trial, values, latent, wanted, latentToo);
  }
  Eigen::VectorXd outputs(int trial, const Eigen::VectorXd& values,
                          const Eigen::VectorXd& latent) const override {
    ask();
    return data().outputs(trial, values, latent);
  }
  std::unique_ptr<DiscoveryProblem> nudged(double frequency) const override {
    auto held = data().nudged(frequency);
    if (!held) return nullptr;
    return std::make_unique<WatchedProblem>(std::move(held), goOn_);
  }

 private:
  void ask() const {
    if (goOn_ && !goOn_()) throw Stopped();
  }

  std::function<bool()> goOn_;
};

}  // namespace info::discover
