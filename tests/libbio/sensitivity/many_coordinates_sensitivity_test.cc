#include <gtest/gtest.h>

#include "libbio/simulation/arm_of_seven.h"
#include "support/sensitivity_differences.h"

namespace bio {
namespace {

using fixtures::ArmOfSeven;

// Of every kind: muscle, path point, wrap object, mass, passive force, start.
TEST(ManyCoordinates, SensitivitiesMatchDifferencesOnAnArmOfSeven) {
  const ArmOfSeven c(0.2);
  const Eigen::VectorXd speeds = Eigen::VectorXd::LinSpaced(7, -0.6, 0.7);
  const ParameterCatalogue catalogue(c.model, c.system, {c.start.q, speeds});
  const auto wanted = catalogue.select(
      {"BIClong.max_isometric_force", "BIClong.point9.x", "BIClong.point10.y", "BRD.point3.z",
       "TRI.radius", "TRI.rotation.x", "TRI.translation.y", "hand.mass", "radius.mass_center.x",
       "humerus.mass", "hand.inertia.yy", "hold_elv_angle.*", "initial.*"});
  SimulationOptions options;
  options.duration = 0.12;
  const fixtures::DiscoveryProblem d = fixtures::compareWithDifferences(
      c.system, c.options, c.excitation, catalogue, wanted, options);
  fixtures::tell(d);
  EXPECT_GT(d.parameters, 25);
  EXPECT_GT(d.compared, 300);
  EXPECT_LT(d.worst, 1e-5) << d.of;
}

TEST(ManyCoordinates, SensitivitiesOverLengthFunctionsMatchDifferences) {
  for (const auto& free : {ArmOfSeven::coordinates(), std::vector<std::string>{"elbow_flexion"}}) {
    const ArmOfSeven c(0.2, free, false, ArmOfSeven::modelWithFunctions());
    const auto n = static_cast<Eigen::Index>(free.size());
    const ParameterCatalogue catalogue(c.model, c.system,
                                       {c.start.q, Eigen::VectorXd::LinSpaced(n, -0.6, 0.7)});
    const auto wanted =
        catalogue.select({"BIClong.max_isometric_force", "BRD.tendon_slack_length",
                          "BRD.optimal_fiber_length", "TRI.radius", "hand.mass", "initial.*"});
    SimulationOptions options;
    options.duration = 0.12;
    const fixtures::DiscoveryProblem d = fixtures::compareWithDifferences(
        c.system, c.options, c.excitation, catalogue, wanted, options);
    fixtures::tell(d);
    EXPECT_GT(d.compared, 30);
    EXPECT_LT(d.worst, 1e-5) << d.of;
  }
}

}  // namespace
}  // namespace bio
