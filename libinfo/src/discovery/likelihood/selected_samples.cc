#include "discovery/likelihood/selected_samples.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

SelectedSamples::SelectedSamples(const DiscoveryProblem& data,
                                 const std::vector<std::vector<std::size_t>>& kept)
    : ForwardingProblem(data), kept_(kept) {
  select();
}

SelectedSamples::SelectedSamples(std::unique_ptr<DiscoveryProblem> data,
                                 const std::vector<std::vector<std::size_t>>& kept)
    : ForwardingProblem(std::move(data)), kept_(kept) {
  select();
}

void SelectedSamples::select() {
  for (int trial = 0; trial < data().numTrials(); ++trial) {
    OfTrial one;
    const auto& outputs = data().outputOfSample(trial);
    for (const std::size_t k : kept_.at(static_cast<std::size_t>(trial))) {
      one.samples.push_back(static_cast<Index>(k));
      one.times.push_back(data().times(trial)[k]);
      if (!outputs.empty()) one.outputs.push_back(outputs[k]);
    }
    one.measured = data().measured(trial)(one.samples);
    trials_.push_back(std::move(one));
  }
}

namespace {

DiscoveryProblem::Prediction selected(DiscoveryProblem::Prediction all,
                                      const std::vector<Index>& samples) {
  DiscoveryProblem::Prediction some;
  some.outputs = all.outputs(samples);
  some.gamma = all.gamma(samples, Eigen::all);
  if (all.byNode.size() > 0) some.byNode = all.byNode(samples, Eigen::all);
  some.scale = std::move(all.scale);
  some.speeds = all.speeds(samples);
  some.course = std::move(all.course);
  some.courseByNode = std::move(all.courseByNode);
  return some;
}

}  // namespace

DiscoveryProblem::Prediction SelectedSamples::predict(int trial, const VectorXd& values,
                                                      const VectorXd& latent,
                                                      const std::vector<std::size_t>& wanted,
                                                      bool latentToo) const {
  return selected(data().predict(trial, values, latent, wanted, latentToo), of(trial).samples);
}

/// A simulation of which only the selected samples are seen.
class SelectedSamples::Some final : public Simulation {
 public:
  Some(std::unique_ptr<Simulation> all, const std::vector<Index>& samples)
      : all_(std::move(all)), samples_(samples), outputs_(all_->outputs()(samples)) {}
  const VectorXd& outputs() const override { return outputs_; }
  Prediction predict() override { return selected(all_->predict(), samples_); }

 private:
  std::unique_ptr<Simulation> all_;
  const std::vector<Index>& samples_;
  VectorXd outputs_;
};

std::unique_ptr<DiscoveryProblem::Simulation> SelectedSamples::simulated(
    int trial, const VectorXd& values, const VectorXd& latent,
    const std::vector<std::size_t>& wanted, bool latentToo) const {
  auto all = data().simulated(trial, values, latent, wanted, latentToo);
  if (!all) return nullptr;
  return std::make_unique<Some>(std::move(all), of(trial).samples);
}

VectorXd SelectedSamples::outputs(int trial, const VectorXd& values, const VectorXd& latent) const {
  return data().outputs(trial, values, latent)(of(trial).samples);
}

VectorXd SelectedSamples::refinedOutputs(int trial, const VectorXd& values) const {
  const VectorXd all = data().refinedOutputs(trial, values);
  return all.size() == 0 ? all : VectorXd(all(of(trial).samples));
}

std::unique_ptr<DiscoveryProblem> SelectedSamples::nudged(double frequency) const {
  auto held = data().nudged(frequency);
  if (!held) return nullptr;
  return std::make_unique<SelectedSamples>(std::move(held), kept_);
}

MatrixXd SelectedSamples::inputs(int trial) const {
  return data().inputs(trial)(of(trial).samples, Eigen::all);
}

std::unique_ptr<DiscoveryProblem> SelectedSamples::withFormula(
    std::size_t axis, const std::vector<FormulaTerm>& terms,
    const std::vector<std::size_t>& kept) const {
  auto widened = data().withFormula(axis, terms, kept);
  if (!widened) return nullptr;
  return std::make_unique<SelectedSamples>(std::move(widened), kept_);
}

}  // namespace info::discover
