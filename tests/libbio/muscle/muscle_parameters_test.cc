#include "bio/muscle/muscle_parameters.h"

#include <gtest/gtest.h>

#include "support/shipped_elbow.h"

namespace bio {
namespace {

/// The first six quantities through the scalar type: the second way.
using D = info::Dual<6>;

struct Point {
  double activation, fibre, length;  ///< act, ℓ/ℓ0, ε-like shift of ℓ_MT
};

/// Shortening, lengthening, slack-free but weak, and stretched.
const Point points[] = {{0.4, 0.9, 0.02},
                        {0.2, 1.1, 0.028},
                        {0.05, 1.35, 0.03},
                        {0.8, 0.7, 0.012},
                        {0.01, 1.45, 0.036}};

double lengthAt(const SchutteMuscle<double>& muscle, const Point& point) {
  const double l = point.fibre * muscle.quantities().optimalFibreLength;
  return muscle.projectedFibreLength(l) +
         (1 + point.length) * muscle.quantities().tendonSlackLength;
}

TEST(MuscleParameters, DerivativesAgreeWithTheScalarType) {
  const fixtures::ShippedElbow elbow;
  for (const SystemMuscle& m : elbow.system.muscles()) {
    const SchutteQuantities<double>& p = m.muscle.schutte().quantities();
    const SchutteQuantities<D> q{D(p.maxIsometricForce, 6, 0), D(p.optimalFibreLength, 6, 1),
                                 D(p.tendonSlackLength, 6, 2), D(p.pennation, 6, 3),
                                 D(p.timeScale, 6, 5),         D(p.damping, 6, 4)};
    const SchutteMuscle<D> dual(q, m.muscle.schutte().curves(), m.muscle.schutte().options());
    for (const Point& point : points) {
      const double l = point.fibre * p.optimalFibreLength;
      const double L = lengthAt(m.muscle.schutte(), point);
      const FibreRate<D> rate = dual.fibreVelocity(D(point.activation), D(l), D(L));
      const FibreParameterDerivatives d =
          fibreParameterDerivatives(m.muscle.schutte(), point.activation, l, L);
      for (std::size_t k = 0; k < 6; ++k) {
        const double V = rate.fibreVelocity.derivatives()[static_cast<Eigen::Index>(k)];
        const double F = rate.tendonForce.derivatives()[static_cast<Eigen::Index>(k)];
        EXPECT_NEAR(d.dV[k], V, 1e-11 * (1 + std::abs(V))) << m.name << " quantity " << k;
        EXPECT_NEAR(d.dF[k], F, 1e-11 * (1 + std::abs(F))) << m.name << " quantity " << k;
      }
    }
  }
}

TEST(MuscleParameters, CurveScalesAgreeWithScaledCurves) {
  const fixtures::ShippedElbow elbow;
  const SchutteParameters& base = *findMuscle(elbow.model, "BIClong").schutte;
  const auto scaled = [&](MuscleQuantity quantity, double s) {
    SchutteParameters p = base;
    if (quantity == MuscleQuantity::tendonStrainScale) {
      for (double& x : p.tendonForceLength.x) x *= s;
    } else if (quantity == MuscleQuantity::activeForceScale) {
      for (double& y : p.activeForceLength.y) y *= s;
    } else if (quantity == MuscleQuantity::activeForceWidth) {
      for (double& x : p.activeForceLength.x) x = 1 + s * (x - 1);
    } else {
      for (double& y : p.passiveForceLength->y) y *= s;
    }
    return p;
  };
  const SchutteCurves baseCurves(base);
  const SchutteMuscle<double> muscle(schutteQuantities(base), baseCurves);
  for (const auto quantity :
       {MuscleQuantity::tendonStrainScale, MuscleQuantity::activeForceScale,
        MuscleQuantity::activeForceWidth, MuscleQuantity::passiveForceScale}) {
    for (const Point& point : points) {
      const double l = point.fibre * base.optimalFibreLength;
      const double L = lengthAt(muscle, point);
      const auto rateAt = [&](double s) {
        const SchutteCurves curves(scaled(quantity, s));
        const SchutteMuscle<double> other(schutteQuantities(base), curves);
        return other.fibreVelocity(point.activation, l, L);
      };
      const double h = 1e-6;
      const auto plus = rateAt(1 + h), minus = rateAt(1 - h);
      const FibreParameterDerivatives d = fibreParameterDerivatives(muscle, point.activation, l, L);
      const auto k = static_cast<std::size_t>(quantity);
      const double V = (plus.fibreVelocity - minus.fibreVelocity) / (2 * h);
      const double F = (plus.tendonForce - minus.tendonForce) / (2 * h);
      EXPECT_NEAR(d.dV[k], V, 1e-7 * (1 + std::abs(V))) << k << " at " << point.fibre;
      EXPECT_NEAR(d.dF[k], F, 1e-6 * (1 + std::abs(F))) << k << " at " << point.fibre;
    }
  }
}

TEST(MuscleParameters, AStrongerMuscleIsNoFaster) {
  const fixtures::ShippedElbow elbow;
  const SchutteMuscle<double>& muscle = elbow.system.muscles()[6].muscle.schutte();
  const double l = 0.95 * muscle.quantities().optimalFibreLength;
  const double L = lengthAt(muscle, points[0]);
  const auto d = fibreParameterDerivatives(muscle, 0.3, l, L);
  const auto F0 = static_cast<std::size_t>(MuscleQuantity::maxIsometricForce);
  EXPECT_EQ(d.dV[F0], 0);
  EXPECT_DOUBLE_EQ(d.dF[F0] * muscle.quantities().maxIsometricForce, muscle.tendonForce(l, L));
}

TEST(MuscleParameters, AFibreAtRestFollowsWhatHoldsIt) {
  const fixtures::ShippedElbow elbow;
  for (const std::string name : {"TRIlong", "BRA", "ANC"}) {
    const SchutteParameters base = *findMuscle(elbow.model, name).schutte;
    const SchutteCurves curves(base);
    const auto restAt = [&](const SchutteParameters& p, double activation, double L) {
      return staticEquilibrium(SchutteMuscle<double>(schutteQuantities(p), curves), activation, L);
    };
    const double L = base.tendonSlackLength * 1.01 + base.optimalFibreLength;
    const double act = 0.3;
    const SchutteMuscle<double> muscle(schutteQuantities(base), curves);
    const StaticEquilibrium rest = restAt(base, act, L);
    ASSERT_TRUE(rest.isUsable());
    const EquilibriumDerivatives d = equilibriumDerivatives(muscle, act, L, rest);
    const auto slope = [&](auto&& lengthAtShift, double h) {
      return (lengthAtShift(h) - lengthAtShift(-h)) / (2 * h);
    };
    EXPECT_NEAR(d.dl_dMuscleTendonLength,
                slope([&](double h) { return restAt(base, act, L + h).fibreLength; }, 1e-6), 1e-6);
    EXPECT_NEAR(d.dl_dActivation,
                slope([&](double h) { return restAt(base, act + h, L).fibreLength; }, 1e-5), 1e-6);
    const std::pair<MuscleQuantity, double SchutteParameters::*> members[] = {
        {MuscleQuantity::optimalFibreLength, &SchutteParameters::optimalFibreLength},
        {MuscleQuantity::tendonSlackLength, &SchutteParameters::tendonSlackLength}};
    for (const auto& [quantity, member] : members) {
      const double difference = slope(
          [&](double h) {
            SchutteParameters p = base;
            p.*member += h;
            return restAt(p, act, L).fibreLength;
          },
          1e-6);
      EXPECT_NEAR(d.dl_dQuantity[static_cast<std::size_t>(quantity)], difference, 1e-6) << name;
    }
  }
}

TEST(MuscleParameters, AFibreBesideASlackTendonFollowsItsLength) {
  // so short that neither pulls
  const fixtures::ShippedElbow elbow;
  const SchutteMuscle<double>& muscle = elbow.system.muscles()[3].muscle.schutte();
  ASSERT_EQ(elbow.system.muscles()[3].name, "ANC");
  const auto restAt = [&](double L) { return staticEquilibrium(muscle, 0.01, L); };
  const SchutteQuantities<double>& p = muscle.quantities();
  const double L = p.tendonSlackLength + 0.297 * p.optimalFibreLength;
  const StaticEquilibrium rest = restAt(L);
  ASSERT_LT(rest.tendonForce, 1e-6);
  const EquilibriumDerivatives d = equilibriumDerivatives(muscle, 0.01, L, rest);
  const double h = 1e-7;
  const double difference = (restAt(L).fibreLength - restAt(L - h).fibreLength) / h;
  EXPECT_NEAR(d.dl_dMuscleTendonLength, difference, 1e-6);
  EXPECT_EQ(d.dl_dActivation, 0);
}

}  // namespace
}  // namespace bio
