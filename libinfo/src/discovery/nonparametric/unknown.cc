#include "info/discovery/nonparametric/unknown.h"

#include <cmath>
#include <numbers>

#include "discovery/judgement/node_states.h"
#include "discovery/nonparametric/symbolic.h"

namespace info::discover {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// The axis with the most certain force: the largest Σ (d/its standard deviation)².
std::size_t strongestAxis(const Likelihood& likelihood, const Fit& fit) {
  const std::size_t numAxes = likelihood.data().axes().size();
  if (numAxes == 1) return 0;
  VectorXd evidence = VectorXd::Zero(static_cast<Index>(numAxes));
  for (std::size_t t = 0; t < likelihood.trials().size(); ++t) {
    const VectorXd sd = likelihood.forceSd(t, fit).cwiseMax(1e-9);
    const VectorXd ratio = likelihood.force(t, fit).cwiseQuotient(sd);
    for (std::size_t axis = 0; axis < numAxes; ++axis)
      evidence[static_cast<Index>(axis)] += onAxis(ratio, axis, numAxes).squaredNorm();
  }
  Index strongest = 0;
  evidence.maxCoeff(&strongest);
  return static_cast<std::size_t>(strongest);
}

std::vector<VectorXd> forcesOn(std::size_t axis, const Likelihood& likelihood, const Fit& fit) {
  std::vector<VectorXd> forces;
  for (std::size_t t = 0; t < likelihood.trials().size(); ++t)
    forces.emplace_back(onAxis(likelihood.force(t, fit), axis, likelihood.data().axes().size()));
  return forces;
}

void spectrum(const Likelihood& likelihood, const Fit& fit,
              const std::vector<std::vector<double>>& times, const std::vector<VectorXd>& forces,
              Unknown& unknown) {
  double peak = -1;
  std::vector<double> density;
  const double step = 0.1;
  for (double f = step; f < 9; f += step) {
    double sum = 0;
    for (std::size_t t = 0; t < forces.size(); ++t) {
      const std::vector<double>& nodes = times[t];
      const VectorXd& d = forces[t];
      double cosine = 0, sine = 0;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double x = 2 * std::numbers::pi * f * nodes[i];
        const double r = d[static_cast<Index>(i)] - d.mean();
        cosine += r * std::cos(x);
        sine += r * std::sin(x);
      }
      sum += cosine * cosine + sine * sine;
    }
    // relative to the spectrum of the force's prior, 1/[(1 + (2πfℓ)²)(1 + (2πfτ)²)]
    const double slow = 2 * std::numbers::pi * f * fit.noise.latentTime;
    const double lag = 2 * std::numbers::pi * f * likelihood.data().latentLag();
    sum *= (1 + slow * slow) * (1 + lag * lag);
    density.push_back(sum);
    if (sum > peak) {
      peak = sum;
      unknown.peakFrequency = f;
    }
  }
  double total = 0, near = 0;
  for (std::size_t i = 0; i < density.size(); ++i) {
    total += density[i];
    if (std::abs(step * static_cast<double>(i + 1) - unknown.peakFrequency) < 0.55)
      near += density[i];
  }
  unknown.peakShare = total > 0 ? near / total : 0;
  unknown.forceSize = rootMeanSquare(forces);
}

}  // namespace

RemainingForce strongestForce(const Likelihood& likelihood, const Fit& fit) {
  const std::size_t axis = strongestAxis(likelihood, fit);
  return {axis, rootMeanSquare(forcesOn(axis, likelihood, fit))};
}

Unknown describeUnknown(const Likelihood& likelihood, const Fit& fit) {
  Unknown unknown;
  unknown.axis = strongestAxis(likelihood, fit);
  const std::vector<VectorXd> forces = forcesOn(unknown.axis, likelihood, fit);
  std::vector<std::vector<double>> times;
  for (const int trial : likelihood.trials()) times.push_back(nodeTimes(likelihood.data(), trial));
  spectrum(likelihood, fit, times, forces, unknown);
  unknown.tie = timeTie(times, forces);
  findFormula(likelihood, fit, unknown);
  return unknown;
}

}  // namespace info::discover
