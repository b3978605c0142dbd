// A pendulum without muscles that swings freely: what can be said of it does not depend on its
// mass.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bio/discovery/musculoskeletal_problem.h"
#include "bio/opensim/osim_file.h"
#include "info/discovery/discover.h"
#include "support/scratch_folder.h"

namespace bio::discover {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using testing::ElementsAre;

constexpr double rodLength = 0.6, frictionPerMass = 0.03;

/// A point mass on a rod.
Model freePendulum(double mass) {
  const support::ScratchFolder folder;
  return readOsim(folder.file(
      "pendulum.osim",
      "<OpenSimDocument Version=\"30000\"><Model name=\"pendulum\"><gravity>0 -9.81 0</gravity>"
      "<BodySet><objects><Body name=\"ground\"><mass>0</mass></Body><Body name=\"arm\"><mass>" +
          std::to_string(mass) + "</mass><mass_center>0 " + std::to_string(-rodLength) +
          " 0</mass_center><inertia_xx>0</inertia_xx><inertia_yy>0</inertia_yy><inertia_zz>0"
          "</inertia_zz><inertia_xy>0</inertia_xy><inertia_xz>0</inertia_xz><inertia_yz>0"
          "</inertia_yz><Joint><PinJoint name=\"pivot\"><parent_body>ground</parent_body>"
          "<CoordinateSet><objects><Coordinate name=\"swing\"><default_value>0</default_value>"
          "<range>-3 3</range></Coordinate></objects></CoordinateSet></PinJoint></Joint></Body>"
          "</objects></BodySet><ForceSet><objects/></ForceSet></Model></OpenSimDocument>"));
}

/// Its damped swing by RK4, in degrees' noise of 0.2; the same for any mass.
Trial freeSwing(double from, unsigned seed) {
  Trial trial;
  trial.file = "swing.csv";
  trial.times = VectorXd::LinSpaced(151, 0, 3);
  trial.excitations.resize(151, 0);
  trial.measured.push_back({ofCoordinate("swing"), trial.times, VectorXd(151)});
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise(0, 0.2 * std::acos(-1) / 180);
  const auto bend = [](double q, double speed) {
    return -9.81 / rodLength * std::sin(q) - frictionPerMass / (rodLength * rodLength) * speed;
  };
  double q = from, w = 0;
  const double h = 0.001;
  for (Index k = 0; k < 151; ++k) {
    trial.measured.front().values[k] = q + noise(generator);
    for (int i = 0; i < 20; ++i) {
      const double q1 = w, w1 = bend(q, w), q2 = w + h / 2 * w1, w2 = bend(q + h / 2 * q1, q2),
                   q3 = w + h / 2 * w2, w3 = bend(q + h / 2 * q2, q3), q4 = w + h * w3,
                   w4 = bend(q + h * q3, q4);
      q += h / 6 * (q1 + 2 * q2 + 2 * q3 + q4);
      w += h / 6 * (w1 + 2 * w2 + 2 * w3 + w4);
    }
  }
  return trial;
}

struct FoundInSwing {
  std::vector<std::string> names;
  double logBayesFactor = 0, value = 0, sd = 0;
  std::string sentence;
};

FoundInSwing foundInSwing(double mass) {
  MusculoskeletalProblemOptions options;
  options.simulation.step = 0.005;
  const MusculoskeletalProblem data(
      freePendulum(mass), SystemOptions{{{"swing"}, {}}, {}, {}}, "swing",
      {freeSwing(1.2, 1), freeSwing(0.7, 2), freeSwing(0.9, 3)}, options);
  info::discover::Options search;
  search.heldOut = {2};
  const info::discover::Verdict verdict = info::discover::run(data, search);
  FoundInSwing result;
  result.sentence = verdict.sentence;
  for (const auto& effect : verdict.effects) {
    result.names.push_back(data.candidates()[effect.candidate].id);
    result.logBayesFactor = effect.logBayesFactor;
    result.value = effect.estimates.front().value;
    result.sd = effect.estimates.front().sd;
  }
  return result;
}

TEST(FreeSwing, IsDampedWhateverThePendulumWeighs) {
  const FoundInSwing light = foundInSwing(0.1), heavy = foundInSwing(20);
  ASSERT_THAT(light.names, ElementsAre("visc")) << light.sentence;
  ASSERT_THAT(heavy.names, ElementsAre("visc")) << heavy.sentence;
  EXPECT_NEAR(heavy.logBayesFactor, light.logBayesFactor, 0.1);
  EXPECT_NEAR(light.value, 0.1 * frictionPerMass, 3 * light.sd);
  EXPECT_NEAR(heavy.value, 200 * light.value, 0.1 * heavy.sd);
  EXPECT_LT(light.sd, 0.1 * light.value);
}

// The energy is judged by the work that was done, of which there is none here.
TEST(FreeSwing, ReachesItsEndWithEveryIntegrator) {
  const MusculoskeletalSystem system(freePendulum(0.1), SystemOptions{{{"swing"}, {}}, {}, {}});
  SystemState start;
  start.q = VectorXd::Constant(1, 1.2);
  start.qDot = VectorXd::Zero(1);
  for (const Integrator integrator :
       {Integrator::variational, Integrator::rungeKutta4, Integrator::cvode}) {
    SimulationOptions options;
    options.integrator = integrator;
    options.step = 0.001;
    options.duration = 2;
    const Trajectory motion = simulate(system, {{0}, Eigen::MatrixXd::Zero(1, 0)}, start, options);
    EXPECT_EQ(motion.outcome, Outcome::completed) << motion.why;
    EXPECT_LT(energyError(system, motion), 1e-4 * 0.1 * 9.81 * rodLength);
  }
}

}  // namespace
}  // namespace bio::discover
