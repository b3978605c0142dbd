#include "bio/muscle/simulated_muscle.h"

#include <algorithm>
#include <cmath>

#include "bio/muscle/fibre_rest.h"
#include "bio/muscle/muscle_sensitivity.h"

namespace bio {
namespace {

FibreRateDerivatives asDerivatives(const muscles::FibreRate<double>& r) {
  return {r.fibreVelocity,  r.tendonForce,     r.dV_dActivation, r.dV_dFibreLength,
          r.dV_dPathLength, r.dF_dFibreLength, r.dF_dPathLength};
}

template <class Numbers>
PerMuscleNumber padded(const Numbers& numbers, double factor = 1) {
  static_assert(std::tuple_size_v<Numbers> <= mostMuscleNumbers);
  PerMuscleNumber all{};
  for (std::size_t i = 0; i < numbers.size(); ++i) all[i] = factor * numbers[i];
  return all;
}

StaticEquilibrium::Why whyOf(muscles::FibreRest::Why why) {
  using From = muscles::FibreRest::Why;
  switch (why) {
    case From::found:
    case From::held:
      return StaticEquilibrium::Why::found;
    case From::forceFree:
      return StaticEquilibrium::Why::forceFree;
    case From::tendonTooShort:
      return StaticEquilibrium::Why::tendonTooShort;
    case From::notBracketed:
      break;
  }
  return StaticEquilibrium::Why::notBracketed;
}

muscles::FibreRest asFibreRest(const StaticEquilibrium& rest, bool isHeld) {
  using Why = muscles::FibreRest::Why;
  const bool found = rest.why == StaticEquilibrium::Why::found;
  return {isHeld  ? Why::held
          : found ? Why::found
                  : Why::forceFree,
          rest.fibreLength, rest.tendonForce, rest.count};
}

template <class Muscle>
constexpr bool stepsByBalance = std::remove_cvref_t<Muscle>::Shape::stepsByBalance;

}  // namespace

SimulatedMuscle::SimulatedMuscle(const muscles::AnyMuscle& other) : other_(&other) {
  std::visit(
      [this](const auto& muscle) {
        perFibre_ = muscle.perFibre();
        hasFibreState_ = muscle.hasFibreState();
      },
      other);
}

double SimulatedMuscle::thickness() const {
  if (schutte_) return schutte_->thickness();
  return std::visit([](const auto& muscle) -> double { return muscle.thickness(); }, *other_);
}

PerMuscleNumber SimulatedMuscle::thicknessInNumbers() const {
  using muscles::common::optimalFibreLength;
  constexpr std::size_t pennation = muscles::common::pennation;
  // the places of both are those of Schutte's class
  static_assert(optimalFibreLength == static_cast<std::size_t>(MuscleQuantity::optimalFibreLength));
  static_assert(pennation == static_cast<std::size_t>(MuscleQuantity::pennation));
  PerMuscleNumber d{};
  const double w = thickness(), l0 = 1 / perFibre_;
  d[optimalFibreLength] = w / l0;
  d[pennation] = std::sqrt(std::max(0.0, l0 * l0 - w * w));
  return d;
}

double SimulatedMuscle::shortestFibre() const {
  if (!other_) return 0;
  return std::visit(
      []<class Shape>(const muscles::HillMuscle<Shape>& muscle) -> double {
        return muscle.hasFibreState() && muscles::holdsFibre<Shape> ? muscle.shortestFibre() : 0;
      },
      *other_);
}

FibreRateDerivatives SimulatedMuscle::otherRate(double activation, double fibreLength,
                                                double pathLength) const {
  const double shortest = mayBeHeld(fibreLength) ? shortestFibre() : 0;
  FibreRateDerivatives r = std::visit(
      [&](const auto& muscle) {
        return asDerivatives(
            muscle.fibreRate(activation, std::max(fibreLength, shortest), pathLength));
      },
      *other_);
  if (!(fibreLength <= shortest)) return r;
  if (fibreLength < shortest) r.dV_dFibreLength = r.dF_dFibreLength = 0;
  if (r.fibreVelocity <= 0) {
    r.fibreVelocity = r.dV_dActivation = r.dV_dFibreLength = r.dV_dMuscleTendonLength = 0;
  }
  return r;
}

FibreRateDerivatives SimulatedMuscle::otherRateNear(double activation, double fibreLength,
                                                    double pathLength, double fibreVelocity,
                                                    double h) const {
  return std::visit(
      [&](const auto& muscle) {
        return asDerivatives(
            muscle.rateNear(activation, fibreLength, pathLength, fibreVelocity, h));
      },
      *other_);
}

muscles::RigidRate<double> SimulatedMuscle::rigidRate(double activation, double pathLength,
                                                      double pathSpeed) const {
  return std::visit(
      [&](const auto& muscle) { return muscle.rigidRate(activation, pathLength, pathSpeed); },
      *other_);
}

double SimulatedMuscle::tendonForce(double activation, double fibreLength, double pathLength,
                                    double pathSpeed) const {
  if (schutte_) return schutte_->tendonForce(fibreLength, pathLength);
  if (!hasFibreState_) return rigidRate(activation, pathLength, pathSpeed).tendonForce;
  return std::visit(
      [&](const auto& muscle) -> double {
        return muscle.parameters().maxIsometricForce *
               muscle.shape().tendonForce(muscle.tendonStrain(fibreLength, pathLength)).value;
      },
      *other_);
}

StaticEquilibrium SimulatedMuscle::rest(double activation, double pathLength) const {
  if (schutte_) return staticEquilibrium(*schutte_, activation, pathLength);
  return std::visit(
      [&](const auto& muscle) -> StaticEquilibrium {
        const muscles::FibreRest rest = muscles::restingFibre(muscle, activation, pathLength);
        return {whyOf(rest.why), rest.fibreLength, rest.tendonForce, rest.count};
      },
      *other_);
}

SimulatedMuscle::RestSlopes SimulatedMuscle::restSlopes(double activation, double pathLength,
                                                        const StaticEquilibrium& rest) const {
  if (schutte_) {
    const EquilibriumDerivatives d =
        equilibriumDerivatives(*schutte_, activation, pathLength, rest);
    return {d.dl_dActivation, d.dl_dMuscleTendonLength, padded(d.dl_dQuantity)};
  }
  return std::visit(
      [&](const auto& muscle) -> RestSlopes {
        const auto d = muscles::restDerivatives(muscle, activation, pathLength,
                                                asFibreRest(rest, isHeld(rest.fibreLength)));
        return {d.dl_dActivation, d.dl_dPathLength, padded(d.dl_dNumber)};
      },
      *other_);
}

SimulatedMuscle::InNumbers SimulatedMuscle::inNumbers(double activation, double fibreLength,
                                                      double pathLength, double fibreVelocity,
                                                      SchuttePieces& last) const {
  if (schutte_) {
    const FibreParameterDerivatives d =
        fibreParameterDerivatives(*schutte_, activation, fibreLength, pathLength, last);
    return {padded(d.dV), padded(d.dF)};
  }
  return std::visit(
      [&](const auto& muscle) -> InNumbers {
        if constexpr (stepsByBalance<decltype(muscle)>) {
          const double per =
              -1 / muscle.fibreBalance(activation, fibreLength, pathLength, fibreVelocity)
                       .dR_dFibreVelocity;
          const auto d = muscles::fibreBalanceInNumbers(muscle, activation, fibreLength, pathLength,
                                                        fibreVelocity);
          return {padded(d.equation, per), padded(d.tendonForce)};
        } else {
          const auto d = muscles::fibreRateInNumbers(muscle, activation, fibreLength, pathLength);
          return {padded(d.equation), padded(d.tendonForce)};
        }
      },
      *other_);
}

PerMuscleNumber SimulatedMuscle::shortestInNumbers() const {
  return std::visit(
      []<class Shape>(const muscles::HillMuscle<Shape>& muscle) -> PerMuscleNumber {
        if constexpr (muscles::holdsFibre<Shape>) {
          return padded(muscles::shortestFibreInNumbers(muscle));
        } else {
          return {};
        }
      },
      *other_);
}

PerMuscleNumber SimulatedMuscle::rigidInNumbers(double activation, double pathLength,
                                                double pathSpeed) const {
  return std::visit(
      [&](const auto& muscle) {
        return padded(muscles::rigidForceInNumbers(muscle, activation, pathLength, pathSpeed));
      },
      *other_);
}

}  // namespace bio
