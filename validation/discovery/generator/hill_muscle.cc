#include "generator/hill_muscle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace hidden {
namespace {

constexpr double kShort = 0.15;                           // curvature of the shortening branch
constexpr double kLong = 0.13 * kShort / (kShort + 1.0);  // σ of the lengthening branch
constexpr double smallestActivation = 1e-3;

// v with A·f_v(v) + B·v = P for P ≥ 0, by Newton from v = 0. The left side is convex where the
// fibre shortens and concave where it lengthens, so from 0 the iteration is monotone.
double velocityFor(double P, double A, double B) {
  double v = 0;
  for (int iteration = 0; iteration < 200; ++iteration) {
    double f, slope;
    if (P < A) {
      const double rest = kShort - v;
      f = kShort * (1 + v) / rest;
      slope = kShort * (1 + kShort) / (rest * rest);
    } else {
      const double rest = v + kLong;
      f = (1.4 * v + kLong) / rest;
      slope = 0.4 * kLong / (rest * rest);
    }
    const double step = (P - A * f - B * v) / (A * slope + B);
    v += step;
    if (std::abs(step) <= 1e-15 * (1 + std::abs(v))) break;
  }
  return v;
}

}  // namespace

HillMuscle::Parts HillMuscle::parts(double activation, double fibre, double muscleTendon,
                                    double strength) const {
  const double thickness = fibreLength * std::sin(pennation);
  const double cosine = std::sqrt(1 - thickness * thickness / (fibre * fibre));
  const double strain = (muscleTendon - fibre * cosine - slackLength) / slackLength;
  const double l = fibre / fibreLength;
  Parts p;
  p.cosine = cosine;
  p.tendon = strain < 0 ? 0.0 : tendon.at(strain / tendonStretch);
  p.active = strength * std::max(activation, smallestActivation) * std::max(0.0, active.at(l));
  p.passive = passive.at(l);
  return p;
}

double HillMuscle::tendonForce(double fibre, double muscleTendon) const {
  return maxForce * parts(0, fibre, muscleTendon, 1).tendon;
}

double HillMuscle::fibreVelocity(double activation, double fibre, double muscleTendon,
                                 double strength) const {
  const Parts p = parts(activation, fibre, muscleTendon, strength);
  if (!std::isfinite(p.cosine)) return std::numeric_limits<double>::quiet_NaN();
  const double P = std::max(0.0, p.tendon / p.cosine - p.passive);
  return velocityFor(P, p.active, damping) * fibreLength / timeScale;
}

double HillMuscle::activationRate(double excitation, double activation) const {
  const double constant =
      excitation >= activation ? activation1 * excitation + activation2 : activation2;
  return (excitation - activation) * constant / timeScale;
}

double HillMuscle::restingFibre(double activation, double muscleTendon, double strength) const {
  const double thickness = fibreLength * std::sin(pennation);
  const double lowest = std::max(thickness * (1 + 1e-9), 1e-3 * fibreLength);
  const double highest = std::hypot(muscleTendon - slackLength, thickness);
  if (!(muscleTendon > slackLength && highest > lowest)) {
    throw std::runtime_error(name + ": shorter than its slack tendon");
  }
  // tendon minus fibre: falls through 0 at a stable length
  const auto surplus = [&](double fibre) {
    const Parts p = parts(activation, fibre, muscleTendon, strength);
    return p.tendon - (p.active + p.passive) * p.cosine;
  };
  constexpr int cells = 100;
  double best = std::numeric_limits<double>::quiet_NaN();
  double a = lowest, fa = surplus(a), fb = fa;
  for (int i = 1; i <= cells; ++i) {
    const double b = lowest + (highest - lowest) * i / cells;
    fb = surplus(b);
    if (fa > 0 && fb <= 0) {
      double left = a, right = b;
      for (int halving = 0; halving < 100; ++halving) {
        const double middle = (left + right) / 2;
        (surplus(middle) > 0 ? left : right) = middle;
      }
      if (!(std::abs(left - fibreLength) >= std::abs(best - fibreLength))) best = left;
    }
    a = b, fa = fb;
  }
  if (std::isfinite(best)) return best;
  if (fb >= 0 && fb < 1e-4) return highest;
  throw std::runtime_error(name + ": no fibre length balances the tendon");
}

}  // namespace hidden
