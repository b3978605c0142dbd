#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "bio/forces/body_forces.h"

namespace bio {
namespace {

/// OpenSim fades the damping of Blankevoort's ligament in over this strain.
constexpr double dampedFrom = 0.01;

/// How much of it acts at a strain, and its slope.
std::pair<double, double> dampedShare(double strain) {
  const double x = std::min(strain / dampedFrom, 1.0);
  return {x * x * x * (10 - x * (15 - 6 * x)),
          x < 1 ? 30 * x * x * (1 - x) * (1 - x) / dampedFrom : 0};
}

}  // namespace

ElasticPathLaw::ElasticPathLaw(const ElasticPath& path)
    : kind_(path.kind),
      restLength_(path.restLength),
      scale_(path.scale),
      damping_(path.damping),
      transition_(path.transitionStrain),
      curve_(path.curve) {
  if (!(restLength_ > 0)) {
    throw std::invalid_argument(
        fmt::format("'{}': rest length = {} m, must be > 0", path.name, restLength_));
  }
  if (kind_ == ElasticPathKind::blankevoort1991 && !(transition_ > 0)) {
    throw std::invalid_argument(
        fmt::format("'{}': transition strain = {}, must be > 0", path.name, transition_));
  }
}

PathTension ElasticPathLaw::tension(double length, double speed) const {
  const double stretch = length - restLength_;
  if (!(stretch > 0)) return {};
  if (kind_ == ElasticPathKind::spring) {
    const double damped = 1 + damping_ * speed;
    return {scale_ * stretch * damped, scale_ * damped, scale_ * stretch * damping_};
  }
  if (kind_ == ElasticPathKind::ligament) {
    const CurveValue y = curve_.evaluate(length / restLength_);
    return {scale_ * y.value, scale_ * y.slope / restLength_, 0};
  }
  const double strain = stretch / restLength_;
  PathTension tension;
  if (strain < transition_) {
    tension.force = scale_ * strain * strain / (2 * transition_);
    tension.dForce_dLength = scale_ * strain / (transition_ * restLength_);
  } else {
    tension.force = scale_ * (strain - transition_ / 2);
    tension.dForce_dLength = scale_ / restLength_;
  }
  if (speed > 0) {
    const auto [step, slope] = dampedShare(strain);
    const double rate = speed / restLength_;
    tension.force += damping_ * rate * step;
    tension.dForce_dLength += damping_ * rate * slope / restLength_;
    tension.dForce_dSpeed += damping_ * step / restLength_;
  }
  return tension;
}

std::array<double, 4> ElasticPathLaw::inNumbers(double length, double speed) const {
  const double stretch = length - restLength_;
  if (!(stretch > 0)) return {};
  if (kind_ == ElasticPathKind::spring) {
    const double damped = 1 + damping_ * speed;
    return {-scale_ * damped, stretch * damped, scale_ * stretch * speed, 0};
  }
  const double strain = stretch / restLength_;
  const double strainInRest = -length / (restLength_ * restLength_);
  if (kind_ == ElasticPathKind::ligament) {
    const CurveValue y = curve_.evaluate(length / restLength_);
    return {scale_ * y.slope * strainInRest, y.value, 0, 0};
  }
  std::array<double, 4> d{};
  if (strain < transition_) {
    d[1] = strain * strain / (2 * transition_);
    d[0] = scale_ * strain / transition_ * strainInRest;
    d[3] = -scale_ * d[1] / transition_;
  } else {
    d[1] = strain - transition_ / 2;
    d[0] = scale_ * strainInRest;
    d[3] = -scale_ / 2;
  }
  if (speed > 0) {
    const auto [step, slope] = dampedShare(strain);
    const double rate = speed / restLength_;
    d[2] = rate * step;
    d[0] += damping_ * rate * (slope * strainInRest - step / restLength_);
  }
  return d;
}

}  // namespace bio
