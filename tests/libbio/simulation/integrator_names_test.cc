#include "bio/simulation/integrator_names.h"

#include <gtest/gtest.h>

namespace bio {
namespace {

TEST(SimulationNames, NameEveryIntegratorAndItsUsualStep) {
  EXPECT_EQ(integratorNamed("vi"), Integrator::variational);
  EXPECT_EQ(integratorNamed("vi-left"), Integrator::variationalLeft);
  EXPECT_EQ(integratorNamed("vi-adaptive"), Integrator::variationalAdaptive);
  EXPECT_EQ(integratorNamed("rk4"), Integrator::rungeKutta4);
  EXPECT_EQ(integratorNamed("cvode"), Integrator::cvode);
  EXPECT_EQ(integratorNamed("euler"), std::nullopt);
  for (const char* text : {"vi", "vi-left", "vi-adaptive", "rk4", "cvode"}) {
    EXPECT_STREQ(name(integratorNamed(text).value()), text);
    EXPECT_EQ(defaultStep(integratorNamed(text).value()), std::string(text) == "rk4" ? 2e-4 : 0.01);
  }
}

TEST(SimulationNames, NameEveryOutcome) {
  EXPECT_STREQ(name(Outcome::completed), "ok");
  EXPECT_STREQ(name(Outcome::unstable), "unstable");
  EXPECT_STREQ(name(Outcome::noSolution), "no solution");
  EXPECT_STREQ(name(Outcome::stopped), "stopped");
}

}  // namespace
}  // namespace bio
