#include "info/discovery/nonparametric/unknown.h"

#include <cmath>
#include <numbers>

#include "discovery/nonparametric/symbolic.h"

namespace info::discover {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

void spectrum(const Likelihood& likelihood, const Fit& fit, Unknown& unknown) {
  double power = 0, count = 0, peak = -1;
  std::vector<double> density;
  const double step = 0.1;
  for (double f = step; f < 9; f += step) {
    double sum = 0;
    for (std::size_t t = 0; t < likelihood.trials().size(); ++t) {
      const auto& nodes = likelihood.data().latentTimes(likelihood.trials()[t]);
      const VectorXd d = likelihood.force(t, fit);
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
  for (std::size_t t = 0; t < likelihood.trials().size(); ++t) {
    const VectorXd d = likelihood.force(t, fit);
    power += d.squaredNorm();
    count += static_cast<double>(d.size());
  }
  unknown.forceSize = std::sqrt(power / count);
}

}  // namespace

Unknown describeUnknown(const Likelihood& likelihood, const Fit& fit) {
  Unknown unknown;
  spectrum(likelihood, fit, unknown);
  std::vector<std::vector<double>> times;
  std::vector<VectorXd> forces;
  for (std::size_t t = 0; t < likelihood.trials().size(); ++t) {
    times.push_back(likelihood.data().latentTimes(likelihood.trials()[t]));
    forces.push_back(likelihood.force(t, fit));
  }
  unknown.tie = timeTie(times, forces);
  findFormula(likelihood, fit, unknown);
  return unknown;
}

}  // namespace info::discover
