#include "info/discovery/likelihood/joint_fit.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "discovery/likelihood/joint_point.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

std::vector<std::size_t> wantedOf(const Hypothesis& h) {
  std::vector<std::size_t> wanted;
  for (const FreeQuantity& q : h.free) wanted.push_back(q.quantity);
  return wanted;
}

}  // namespace

Likelihood::Likelihood(const DiscoveryProblem& data, std::vector<int> trials,
                       const VectorXd& values, double latentTime)
    : data_(data), trials_(std::move(trials)) {
  if (trials_.empty()) throw std::invalid_argument("likelihood: no trial, must have at least one");
  for (const int trial : trials_) {
    const std::vector<Node>& nodes = data.nodes(trial);
    const VectorXd& measured = data.measured(trial);
    const auto n = static_cast<Index>(nodes.size());
    if (measured.size() == 0 || !measured.allFinite() ||
        measured.size() != static_cast<Index>(data.times(trial).size()))
      throw std::invalid_argument(
          fmt::format("{}: samples must be finite, at least one, and one for each time",
                      data.trialName(trial)));
    requireOrdered(data, trial);
    const MatrixXd G = data.predict(trial, values, {}, {}, true).scale;
    if (G.rows() != n || G.cols() < 1 || !G.allFinite())
      throw std::invalid_argument(
          fmt::format("{}: scale of the latent force must be finite at its {} nodes",
                      data.trialName(trial), n));
    roots_.push_back(latentCovariance(nodes, G, latentTime, data.latentLag()).llt().matrixL());
  }
}

Index Likelihood::samples() const {
  Index n = 0;
  for (const int trial : trials_) n += data_.measured(trial).size();
  return n;
}

// J of whitened residuals whose squares have this sum.
double Likelihood::cost(const Point& point, double squares) {
  double cost = 0.5 * point.xi.squaredNorm() + 0.5 * squares;
  for (const VectorXd& eta : point.eta) cost += 0.5 * eta.squaredNorm();
  return std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
}

void Likelihood::whiten(std::size_t at, const Noise& noise, VectorXd& samples) const {
  noise.output.whiten(data_.outputOfSample(trials_[at]), samples);
}

VectorXd Likelihood::latentForce(std::size_t at, const Noise& noise, const VectorXd& eta) const {
  if (eta.size() == 0) return {};
  return noise.latent * (roots_[at] * eta);
}

double Likelihood::simulatedCost(const Noise& noise, const Point& point) const {
  double squares = 0;
  for (std::size_t t = 0; t < trials_.size(); ++t) {
    VectorXd e = data_.measured(trials_[t]) -
                 data_.outputs(trials_[t], point.values, latentForce(t, noise, point.eta[t]));
    whiten(t, noise, e);
    squares += e.squaredNorm();
  }
  return cost(point, squares);
}

Likelihood::Linear Likelihood::linearise(std::size_t at, const Hypothesis& hypothesis,
                                         const Noise& noise, const VectorXd& values,
                                         const VectorXd& xi, const VectorXd& eta,
                                         const std::vector<std::size_t>& extra, bool force) const {
  std::vector<std::size_t> wanted = wantedOf(hypothesis);
  wanted.insert(wanted.end(), extra.begin(), extra.end());
  const bool latent = eta.size() != 0;
  return linearOf(
      at, hypothesis, noise, xi,
      data_.predict(trials_[at], values, latentForce(at, noise, eta), wanted, latent || force),
      latent, force);
}

Likelihood::Linear Likelihood::linearOf(std::size_t at, const Hypothesis& hypothesis,
                                        const Noise& noise, const VectorXd& xi,
                                        DiscoveryProblem::Prediction prediction, bool latent,
                                        bool force) const {
  const auto p = static_cast<Index>(hypothesis.free.size());
  const std::vector<int>& outputs = data_.outputOfSample(trials_[at]);
  noise.output.whiten(outputs, prediction.gamma);
  if (prediction.byNode.size() != 0) noise.output.whiten(outputs, prediction.byNode);
  Linear linear;
  linear.residuals = data_.measured(trials_[at]) - prediction.outputs;
  noise.output.whiten(outputs, linear.residuals);
  linear.gamma = prediction.gamma.leftCols(p);
  for (Index i = 0; i < p; ++i)
    linear.gamma.col(i) *= hypothesis.free[static_cast<std::size_t>(i)].slope(xi[i]);
  linear.extra = prediction.gamma.rightCols(prediction.gamma.cols() - p);
  linear.latent =
      latent && noise.latent > 0
          ? MatrixXd(noise.latent * (prediction.byNode * roots_[at].triangularView<Eigen::Lower>()))
          : MatrixXd(linear.residuals.size(), 0);
  if (force) linear.force = std::move(prediction.byNode);
  linear.outputs = std::move(prediction.outputs);
  linear.speeds = std::move(prediction.speeds);
  linear.course = std::move(prediction.course);
  linear.courseByNode = std::move(prediction.courseByNode);
  return linear;
}

std::unique_ptr<DiscoveryProblem::Simulation> Likelihood::simulated(std::size_t at,
                                                                    const Hypothesis& hypothesis,
                                                                    const Noise& noise,
                                                                    const Point& point) const {
  const VectorXd& eta = point.eta[at];
  return data_.simulated(trials_[at], point.values, latentForce(at, noise, eta),
                         wantedOf(hypothesis), eta.size() != 0);
}

Likelihood::Linear Likelihood::linearise(std::size_t at, const Fit& fit, const VectorXd& values,
                                         const std::vector<std::size_t>& extra, bool force) const {
  return linearise(at, fit.hypothesis, fit.noise, values, fit.xi, fit.eta[at], extra, force);
}

double Likelihood::simulationError(const VectorXd& values, const Whitening& noise) const {
  double sum = 0;
  for (const int trial : trials_) {
    VectorXd e = data_.measured(trial) - data_.outputs(trial, values, {});
    noise.whiten(data_.outputOfSample(trial), e);
    sum += e.squaredNorm();
  }
  return noise.sd(0) * std::sqrt(sum / static_cast<double>(samples()));
}

}  // namespace info::discover
