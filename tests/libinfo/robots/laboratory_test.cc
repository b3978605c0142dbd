#include "robots/laboratory.h"

#include <gmock/gmock.h>

#include <cmath>

#include "info/dynamics/integrate.h"
#include "info/estimation/monte_carlo.h"
#include "robots/laboratory_plants.h"
#include "robots/suspended_mass.h"

namespace {

using namespace info;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using testing::HasSubstr;

const Vector2d pendulumTruth(0.11, 0.18), massTruth(0.124, 0.5);

// The hand-derived plane equations are the second way: another formulation, another step.
TEST(Laboratory, WithoutEffectsIsTheModel) {
  const CartMotion lively = cosineMotion(0.03, 1.3, 5, 30, 4);
  const PlannedExperiment pendulum = doublePendulumExperiment(lively);
  RandomStream random(3, 0);
  const MatrixXd exact = pendulum.predictor.outputs(pendulumTruth);
  const MatrixXd noise = drawNoise(pendulum.covariance, exact.cols(), random);
  EXPECT_GT(exact.cwiseAbs().maxCoeff(), 0.3);
  EXPECT_LT(
      (measureDoublePendulum(lively, pendulumTruth, {}, 3) - exact - noise).cwiseAbs().maxCoeff(),
      2e-6);

  const PlannedExperiment mass = suspendedMassExperiment(suspendedMassLively());
  EXPECT_LT((measureSuspendedMass(suspendedMassLively(), massTruth, {}, 3) -
             mass.predictor.outputs(massTruth) -
             [&] {
               RandomStream again(3, 0);
               return drawNoise(mass.covariance, 500, again);
             }())
                .cwiseAbs()
                .maxCoeff(),
            1e-6);
}

TEST(Laboratory, ShiftsTheReadingByEveryEffect) {
  const CartMotion motion = cosineMotion(0.15, 1.3, 5, 30, 4);
  const MatrixXd plain = measureDoublePendulum(motion, pendulumTruth, {}, 1);
  const MatrixXd force = measureSuspendedMass(suspendedMassLively(), massTruth, {}, 1);
  for (const LaboratoryEffects& one : {LaboratoryEffects{.outOfPlane = 0.1},
                                       {.dryFriction = 1e-4},
                                       {.controlLag = 0.02},
                                       {.controlNoise = 0.2},
                                       {.sensorCurvature = 0.05},
                                       {.sensorStep = 0.01}}) {
    EXPECT_GT((measureDoublePendulum(motion, pendulumTruth, one, 1) - plain).norm(), 1e-3);
    EXPECT_GT((measureSuspendedMass(suspendedMassLively(), massTruth, one, 1) - force).norm(),
              1e-3);
  }
}

/// Energy of the tilting double pendulum, from positions and velocities alone: rods as two ends.
double energy(const TiltingDoublePendulum& plant, const Vector<double, 6>& x, double m1) {
  // positions of a point at s along a link from a pivot, in space; by central difference in time
  const auto link = [&](double t, bool second, double s) {
    const double a = x[0] + t * x[3], b = x[1] + t * x[4], eta = x[2] + t * x[5];
    const double along = second ? plant.pivots * std::sin(a) + s * std::sin(b) : s * std::sin(a);
    const double depth = second ? plant.pivots * std::cos(a) + s * std::cos(b) : s * std::cos(a);
    return Eigen::Vector3d(along, depth * std::sin(eta), -depth * std::cos(eta));
  };
  const auto ofLink = [&](double mass, bool second, double com, double gyration) {
    // a rod has the inertia of two half masses at ± √(I/m) from the centre of mass
    double sum = 0;
    for (double side : {-1.0, 1.0}) {
      const double s = com + side * std::sqrt(gyration), t = 1e-5;
      const Eigen::Vector3d v = (link(t, second, s) - link(-t, second, s)) / (2 * t);
      sum += 0.5 * mass * (0.5 * v.squaredNorm() + plant.gravity * link(0, second, s)[2]);
    }
    return sum;
  };
  return ofLink(m1, false, plant.com1, plant.gyration1) +
         ofLink(plant.mass2, true, plant.com2, plant.gyration2);
}

TEST(TiltingDoublePendulum, KeepsItsEnergyWithoutFriction) {
  const TiltingDoublePendulum plant;
  Vector<double, 6> x;
  x << 0.6, -0.4, 0.5, 1.0, -2.0, 1.5;
  const Vector2d theta(0.11, 0);
  const double before = energy(plant, x, 0.11);
  const Rk4<TiltingDoublePendulum> map{plant, 1e-3};
  const Vector<double, 1> still = Vector<double, 1>::Zero();
  for (int k = 0; k < 3000; ++k) x = map.step(x, still, still, theta);
  EXPECT_GT(std::abs(x[2] - 0.5), 0.05);
  EXPECT_NEAR(energy(plant, x, 0.11), before, 1e-8);
}

TEST(TiltingDoublePendulum, LosesEnergyToBothFrictionsAsTheirMomentsSay) {
  TiltingDoublePendulum plant;
  plant.dryFriction = 2e-4;
  Vector<double, 6> x;
  x << 0.3, -0.2, 0.1, 1.0, -1.5, 0.5;
  const double c = 0.18e-3, rate2 = x[4] - x[3], h = 1e-4;
  const auto share = [&](double w) { return w * w / std::hypot(w, plant.slowRate); };
  const double loss =
      c * (x[3] * x[3] + rate2 * rate2) + plant.dryFriction * (share(x[3]) + share(rate2));
  const Vector<double, 1> still = Vector<double, 1>::Zero();
  const Vector2d theta(0.11, 0.18);
  const auto moved = [&](double by) {
    return energy(plant, Rk4<TiltingDoublePendulum>{plant, by}.step(x, still, still, theta), 0.11);
  };
  EXPECT_NEAR((moved(h) - moved(-h)) / (2 * h), -loss, 1e-6 * loss + 1e-9);
}

TEST(SphericalSuspendedMass, KeepsEnergyLengthAndMomentumAboutTheVertical) {
  const SphericalSuspendedMass plant;
  const Vector2d theta(0.124, 0.5);
  Vector<double, 6> x;
  x << std::sin(0.5), 0, -std::cos(0.5), 0, 1.3, 0;
  const auto energyOf = [&](const Vector<double, 6>& s) {
    return 0.5 * 0.25 * s.tail<3>().squaredNorm() + 9.81 * 0.5 * s[2];
  };
  const double before = energyOf(x), turning = x[0] * x[4] - x[1] * x[3];
  const Rk4<SphericalSuspendedMass> map{plant, 1e-3};
  const Vector<double, 1> still = Vector<double, 1>::Zero();
  for (int k = 0; k < 4000; ++k) x = map.step(x, still, still, theta);
  EXPECT_NEAR(energyOf(x), before, 1e-8);
  EXPECT_NEAR(x[0] * x[4] - x[1] * x[3], turning, 1e-9);
  EXPECT_NEAR(x.head<3>().norm(), 1, 1e-9);
}

// On a cone the string's force carries the weight: F cos = m g, ω² = g/(ℓ cos).
TEST(SphericalSuspendedMass, PullsAsAConicalPendulum) {
  const SphericalSuspendedMass plant;
  const Vector2d theta(0.124, 0.5);
  const double angle = 0.4, omega = std::sqrt(9.81 / (0.5 * std::cos(angle)));
  Vector<double, 6> x;
  x << std::sin(angle), 0, -std::cos(angle), 0, omega * std::sin(angle), 0;
  const Vector<double, 1> still = Vector<double, 1>::Zero();
  EXPECT_NEAR(plant.g(x, still, theta)[0], 0.124 * 9.81 / std::cos(angle), 1e-12);
  EXPECT_NEAR(plant.f(x, still, theta)[5], 0, 1e-12);
  // friction slows it by its moment over m ℓ²: n̈ loses τ/(mℓ²)
  SphericalSuspendedMass rubbing;
  rubbing.dryFriction = 1e-3;
  rubbing.slowRate = 1e-9;
  EXPECT_NEAR(rubbing.f(x, still, theta)[4], -1e-3 / (0.124 * 0.25), 1e-9);
}

TEST(LaboratoryAcceleration, LagsAsAFirstOrderSystemDoes) {
  CartMotion step{std::vector<double>(61, 2.0), 0.01, 1};
  const auto lagged = laboratoryAcceleration(step, {.controlLag = 0.1}, 1, 4);
  ASSERT_EQ(lagged.size(), 241u);
  for (std::size_t k : {0UL, 4UL, 100UL, 240UL})
    EXPECT_NEAR(lagged[k], 2 * (1 - std::exp(-0.0025 * double(k) / 0.1)), 1e-12);
  // a ramp is followed with a delay of the lag
  for (std::size_t k = 0; k < 61; ++k) step.acceleration[k] = 0.03 * double(k);
  EXPECT_NEAR(laboratoryAcceleration(step, {.controlLag = 0.02}, 1, 4).back(), 3 * (0.6 - 0.02),
              1e-9);
  EXPECT_EQ(laboratoryAcceleration(step, {}, 1, 1), step.acceleration);
}

TEST(LaboratoryAcceleration, HasNoiseOfTheSizeAskedFor) {
  const CartMotion still{std::vector<double>(4001, 0.0), 0.01, 1};
  const auto noisy = laboratoryAcceleration(still, {.controlNoise = 0.3}, 5, 2);
  double square = 0;
  for (double a : noisy) square += a * a;
  EXPECT_NEAR(std::sqrt(square / double(noisy.size())), 0.3, 0.01);
  EXPECT_EQ(noisy[10], noisy[11]);
  EXPECT_NE(noisy[11], noisy[12]);
  EXPECT_EQ(noisy, laboratoryAcceleration(still, {.controlNoise = 0.3}, 5, 2));
  EXPECT_NE(noisy, laboratoryAcceleration(still, {.controlNoise = 0.3}, 6, 2));
}

TEST(SensorReading, CurvesAndSteps) {
  EXPECT_DOUBLE_EQ(sensorReading(3, 0, 3, {.sensorCurvature = 0.02}), 3.06);
  EXPECT_DOUBLE_EQ(sensorReading(-1.5, 0, 3, {.sensorCurvature = 0.02}), -1.5 * 1.005);
  EXPECT_DOUBLE_EQ(sensorReading(1.26, 0.01, 3, {.sensorStep = 0.25}), 1.25);
  EXPECT_DOUBLE_EQ(sensorReading(1.2, 0.18, 3, {.sensorStep = 0.25}), 1.5);
  EXPECT_DOUBLE_EQ(sensorReading(1.2, 0.1, 3, {}), 1.3);
}

TEST(Laboratory, NamesTheEffectThatIsOutOfItsRange) {
  const auto fails = [](LaboratoryEffects effects, const char* words) {
    try {
      measureSuspendedMass(suspendedMassStart(), massTruth, effects, 1);
      ADD_FAILURE() << words;
    } catch (const std::domain_error& e) {
      EXPECT_THAT(e.what(), HasSubstr(words));
    }
  };
  fails({.outOfPlane = 2}, "angle out of the plane: 2 rad");
  fails({.dryFriction = -1e-4}, "dry friction: -0.0001 N m");
  fails({.controlLag = NAN}, "control lag: nan s");
  fails({.controlNoise = -1}, "control noise: -1 m/s²");
  fails({.sensorCurvature = 0.4}, "sensor curvature: 0.4");
  fails({.sensorStep = -0.1}, "sensor step: -0.1");
}

}  // namespace
