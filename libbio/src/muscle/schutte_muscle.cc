#include "bio/muscle/schutte_muscle.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "bio/muscle/bracketed_root.h"
#include "muscle/schutte_law.h"

namespace bio {
namespace {

void requireRule(bool holds, const char* quantity, double value, const char* unit,
                 const char* rule) {
  if (!holds) {
    throw std::invalid_argument(
        fmt::format("{} is {} {}, must be {}", quantity, value, unit, rule));
  }
}

// F̂_T − (A + f_PE) cos α: falls through 0 where the fibre rests stably.
double forceDifference(const SchutteMuscle<double>& muscle, double activation, double fibreLength,
                       double muscleTendonLength) {
  const double l = fibreLength * muscle.perFibre();
  const double projected =
      fibreLength > muscle.thickness() ? muscle.projectedFibreLength(fibreLength) : 0.0;
  const double strain = (muscleTendonLength - projected) * muscle.perTendon() - 1;
  const double act = std::max(activation, muscle.options().activationFloor);
  const double fibre = act * muscle.activeForceLength(l) + muscle.passiveForceLength(l);
  return muscle.normalisedTendonForce(strain) - fibre * projected / fibreLength;
}

}  // namespace

SchutteCurves::SchutteCurves(const SchutteParameters& parameters)
    : tendonForce(parameters.tendonForceLength), activeForce(parameters.activeForceLength) {
  if (parameters.passiveForceLength) passiveForce.emplace(*parameters.passiveForceLength);
}

SchutteQuantities<double> schutteQuantities(const SchutteParameters& p) {
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  requireRule(positive(p.maxIsometricForce), "maximal isometric force", p.maxIsometricForce, "N",
              "positive and finite");
  requireRule(positive(p.optimalFibreLength), "optimal fibre length", p.optimalFibreLength, "m",
              "positive and finite");
  requireRule(positive(p.tendonSlackLength), "tendon slack length", p.tendonSlackLength, "m",
              "positive and finite");
  requireRule(p.pennation >= 0 && p.pennation < std::numbers::pi / 2, "pennation", p.pennation,
              "rad", "at least 0 and below π/2");
  requireRule(positive(p.timeScale), "time scale", p.timeScale, "s", "positive and finite");
  requireRule(positive(p.damping), "fibre damping", p.damping, "F0·t_s/ℓ0", "positive and finite");
  return {p.maxIsometricForce, p.optimalFibreLength, p.tendonSlackLength,
          p.pennation,         p.timeScale,          p.damping};
}

FibreRateDerivatives fibreRateDerivatives(const SchutteMuscle<double>& muscle, double activation,
                                          double fibreLength, double muscleTendonLength) {
  SchuttePieces last;
  return fibreRateDerivatives(muscle, activation, fibreLength, muscleTendonLength, last);
}

FibreRateDerivatives fibreRateDerivatives(const SchutteMuscle<double>& muscle, double activation,
                                          double fibreLength, double muscleTendonLength,
                                          SchuttePieces& last) {
  const schutte::ForceBalance<double> f =
      schutte::forceBalance(muscle, activation, fibreLength, muscleTendonLength, last);
  return schutte::assemble<FibreRateDerivatives>(
      muscle, f, schutte::velocity(f.P, f.A, muscle.quantities().damping));
}

MuscleForces muscleForces(const SchutteMuscle<double>& muscle, double activation,
                          double fibreLength, double muscleTendonLength, double fibreVelocity,
                          double muscleTendonVelocity) {
  const double force = muscle.quantities().maxIsometricForce;
  const double l = fibreLength * muscle.perFibre();
  const double v = fibreVelocity / muscle.speedScale();
  const double act = std::max(activation, muscle.options().activationFloor);
  const double kappa = fibreLength / muscle.projectedFibreLength(fibreLength);
  MuscleForces result{};
  result.tendonForce = muscle.tendonForce(fibreLength, muscleTendonLength);
  result.activeForce = force * act * muscle.activeForceLength(l) * schutte::forceVelocity(v);
  result.passiveForce = force * muscle.passiveForceLength(l);
  result.dampingForce = force * muscle.quantities().damping * v;
  result.pennation = std::asin(muscle.thickness() / fibreLength);
  result.tendonStrain = muscle.tendonStrain(fibreLength, muscleTendonLength);
  result.muscleTendonPower = result.tendonForce * muscleTendonVelocity;
  result.activePower = result.activeForce * fibreVelocity;
  result.passivePower = result.passiveForce * fibreVelocity;
  result.dampingPower = result.dampingForce * fibreVelocity;
  // d(ℓ cos α)/dt = ℓ̇/cos α, because the thickness is constant.
  result.tendonPower = result.tendonForce * (muscleTendonVelocity - kappa * fibreVelocity);
  return result;
}

StaticEquilibrium staticEquilibrium(const SchutteMuscle<double>& muscle, double activation,
                                    double muscleTendonLength) {
  requireRule(std::isfinite(activation), "activation", activation, "", "finite");
  requireRule(std::isfinite(muscleTendonLength), "muscle–tendon length", muscleTendonLength, "m",
              "finite");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double slackLength = muscle.quantities().tendonSlackLength;
  if (muscleTendonLength <= slackLength) {
    return {StaticEquilibrium::Why::tendonTooShort, nan, nan, 0};
  }

  // Between the shortest fibre, where the tendon pulls and the fibre cannot, and the fibre that
  // leaves the tendon slack, look for every place where the difference falls through zero.
  const double optimal = muscle.quantities().optimalFibreLength;
  const double lower = std::max(muscle.thickness(), 1e-6 * optimal);
  const double upper = std::hypot(muscleTendonLength - slackLength, muscle.thickness());
  const auto difference = [&](double fibreLength) {
    return forceDifference(muscle, activation, fibreLength, muscleTendonLength);
  };
  constexpr int cells = 64;
  StaticEquilibrium result{StaticEquilibrium::Why::notBracketed, nan, nan, 0};
  double a = lower, fa = difference(lower);
  for (int i = 1; i <= cells; ++i) {
    const double b = i == cells ? upper : lower + (upper - lower) * i / cells;
    const double fb = difference(b);
    if (fa > 0 && fb <= 0 && b > a) {
      const double root =
          fb == 0 ? b : muscles::bracketedRoot(difference, a, fa, b, fb, 1e-15 * optimal);
      ++result.count;
      if (result.count == 1 || std::abs(root - optimal) < std::abs(result.fibreLength - optimal)) {
        result.fibreLength = root;
      }
    }
    a = b, fa = fb;
  }
  if (result.count > 0) {
    result.tendonForce = muscle.tendonForce(result.fibreLength, muscleTendonLength);
    const bool loaded = result.tendonForce > 0;
    result.why = loaded ? StaticEquilibrium::Why::found : StaticEquilibrium::Why::forceFree;
  } else if (fa >= 0 && fa < 1e-4) {
    // The fibre does not pull where the tendon goes slack: they part without force.
    result = {StaticEquilibrium::Why::forceFree, upper, 0, 0};
  }
  return result;
}

const char* describe(StaticEquilibrium::Why why) {
  switch (why) {
    case StaticEquilibrium::Why::found:
      return "fibre and tendon force balance";
    case StaticEquilibrium::Why::forceFree:
      return "neither fibre nor tendon carries force; the tendon is just slack";
    case StaticEquilibrium::Why::tendonTooShort:
      return "the muscle is shorter than its slack tendon, so nothing holds the fibre";
    case StaticEquilibrium::Why::notBracketed:
      return "no fibre length balances the tendon";
  }
  return "";
}

}  // namespace bio
