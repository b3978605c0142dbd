#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>

#include "bio/muscle/schutte_muscle.h"
#include "support/elbow_curves.h"

// Random muscles at random lengths and activations: static equilibrium is found and balances, or is
// said not to exist. The second opinion is a scan of 1024 fibre lengths for a place where the force
// on the fibre (equilibriumResidual at rest) falls through zero.
//     random_muscles COUNT SEED
namespace {

using Why = bio::StaticEquilibrium::Why;

struct Case {
  bio::SchutteQuantities<double> quantities;
  double activation, length;
};

Case randomCase(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto between = [&](double low, double high) {
    return low * std::pow(high / low, unit(random));
  };
  Case c{{between(1, 2e4), between(5e-3, 0.6), 0, 0, between(0.01, 1), between(1e-3, 1)},
         unit(random),
         0};
  c.quantities.tendonSlackLength = c.quantities.optimalFibreLength * between(0.1, 15);
  c.quantities.pennation = unit(random) < 0.2 ? 0 : 1.5 * unit(random) * unit(random);
  if (unit(random) < 0.1) c.activation = unit(random) < 0.5 ? 0 : 1;
  c.length = c.quantities.tendonSlackLength * between(0.9, 1.2) +
             c.quantities.optimalFibreLength * 2 * unit(random);
  return c;
}

// Where the scan sees the force on the fibre fall through zero; NaN if nowhere.
double scannedRest(const bio::SchutteMuscle<double>& muscle, const Case& c) {
  const double optimal = c.quantities.optimalFibreLength;
  const double low = std::max(muscle.thickness(), 1e-6 * optimal) * (1 + 1e-9);
  const double high = std::hypot(c.length - c.quantities.tendonSlackLength, muscle.thickness());
  double last = 0, rest = std::nan("");
  for (int i = 0; i <= 1024; ++i) {
    const double fibre = low + (high - low) * i / 1024;
    const double force = muscle.equilibriumResidual(c.activation, fibre, c.length, 0);
    if (i > 0 && last > 0 && force <= 0) rest = fibre;
    last = force;
  }
  return rest;
}

}  // namespace

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::atol(argv[1]) : 100'000;
  std::mt19937_64 random(argc > 2 ? static_cast<std::uint64_t>(std::atoll(argv[2])) : 1);
  const bio::SchutteCurves curves(support::elbowCurves());
  std::map<Why, long> ends;
  long unbalanced = 0, missed = 0, several = 0;
  double worst = 0;
  for (long i = 0; i < count; ++i) {
    const Case c = randomCase(random);
    const bio::SchutteMuscle<double> muscle(c.quantities, curves);
    const bio::StaticEquilibrium rest = staticEquilibrium(muscle, c.activation, c.length);
    ++ends[rest.why];
    several += rest.count > 1;
    if (rest.isUsable()) {
      const double force = muscle.equilibriumResidual(c.activation, rest.fibreLength, c.length, 0) /
                           c.quantities.maxIsometricForce;
      // Free of force: to within the ripple of the curves that the header states.
      const double bound = rest.why == Why::found ? 1e-9 : 1e-4;
      if (rest.why == Why::found) worst = std::max(worst, std::abs(force));
      if (std::abs(force) <= bound) continue;
      ++unbalanced;
    } else if (std::isfinite(scannedRest(muscle, c))) {
      ++missed;
    } else {
      continue;
    }
    fmt::print("F0 = {} N, ℓ0 = {} m, ℓs = {} m, α0 = {}, B = {}, activation {}, length {} m: {}\n",
               c.quantities.maxIsometricForce, c.quantities.optimalFibreLength,
               c.quantities.tendonSlackLength, c.quantities.pennation, c.quantities.damping,
               c.activation, c.length, describe(rest.why));
  }
  fmt::print("{} muscles, largest force left over {:.1e} F0, {} with several rests\n", count, worst,
             several);
  for (const auto& [why, times] : ends) fmt::print("{:>8}  {}\n", times, describe(why));
  fmt::print("{:>8}  not balanced\n{:>8}  said to have no rest, but the scan sees one\n",
             unbalanced, missed);
  return unbalanced + missed == 0 && ends[Why::found] > count / 2 ? 0 : 1;
}
