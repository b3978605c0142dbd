#include "discovery/likelihood/selected_samples.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

SelectedSamples::SelectedSamples(const DiscoveryProblem& data,
                                 const std::vector<std::vector<std::size_t>>& kept)
    : data_(data), kept_(kept) {
  for (int trial = 0; trial < data.numTrials(); ++trial) {
    OfTrial one;
    const auto& outputs = data.outputOfSample(trial);
    for (const std::size_t k : kept.at(static_cast<std::size_t>(trial))) {
      one.samples.push_back(static_cast<Index>(k));
      one.times.push_back(data.times(trial)[k]);
      if (!outputs.empty()) one.outputs.push_back(outputs[k]);
    }
    one.measured = data.measured(trial)(one.samples);
    trials_.push_back(std::move(one));
  }
}

SelectedSamples::SelectedSamples(std::unique_ptr<DiscoveryProblem> data,
                                 const std::vector<std::vector<std::size_t>>& kept)
    : SelectedSamples(*data, kept) {
  owned_ = std::move(data);
}

DiscoveryProblem::Prediction SelectedSamples::predict(int trial, const VectorXd& values,
                                                      const VectorXd& latent,
                                                      const std::vector<std::size_t>& wanted,
                                                      bool latentToo) const {
  Prediction all = data_.predict(trial, values, latent, wanted, latentToo);
  const auto& samples = of(trial).samples;
  Prediction some;
  some.outputs = all.outputs(samples);
  some.gamma = all.gamma(samples, Eigen::all);
  if (latentToo) some.latentGamma = all.latentGamma(samples, Eigen::all);
  some.latentScale = std::move(all.latentScale);
  some.speeds = all.speeds(samples);
  return some;
}

VectorXd SelectedSamples::outputs(int trial, const VectorXd& values, const VectorXd& latent) const {
  return data_.outputs(trial, values, latent)(of(trial).samples);
}

VectorXd SelectedSamples::refinedOutputs(int trial, const VectorXd& values) const {
  const VectorXd all = data_.refinedOutputs(trial, values);
  return all.size() == 0 ? all : VectorXd(all(of(trial).samples));
}

std::unique_ptr<DiscoveryProblem> SelectedSamples::nudged(double frequency) const {
  auto held = data_.nudged(frequency);
  if (!held) return nullptr;
  return std::make_unique<SelectedSamples>(std::move(held), kept_);
}

MatrixXd SelectedSamples::inputs(int trial) const {
  return data_.inputs(trial)(of(trial).samples, Eigen::all);
}

std::unique_ptr<DiscoveryProblem> SelectedSamples::withFormula(
    const std::vector<FormulaTerm>& terms, const std::vector<std::size_t>& kept) const {
  auto widened = data_.withFormula(terms, kept);
  if (!widened) return nullptr;
  return std::make_unique<SelectedSamples>(std::move(widened), kept_);
}

}  // namespace info::discover
