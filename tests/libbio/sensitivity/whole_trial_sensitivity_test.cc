// The complete list of parameters against differences, over whole trials: minutes, labelled slow.
#include <gtest/gtest.h>

#include "support/sensitivity_differences.h"
#include "support/shipped_elbow.h"

namespace bio {
namespace {

using fixtures::ShippedElbow;

class WholeTrialSensitivity : public ::testing::TestWithParam<std::pair<const char*, const char*>> {
};

TEST_P(WholeTrialSensitivity, MatchesDifferencesForEveryParameter) {
  const ShippedElbow elbow(GetParam().first, GetParam().second);
  SimulationOptions options;
  options.duration = 4.5;
  const fixtures::DiscoveryProblem d =
      fixtures::compareWithDifferences(elbow.system, ShippedElbow::options(), elbow.excitation,
                                       elbow.catalogue, elbow.catalogue.select({"all"}), options);
  fixtures::tell(d);
  EXPECT_GE(d.parameters, 285);
  EXPECT_LT(d.worst, 1e-5) << d.of;
}

INSTANTIATE_TEST_SUITE_P(Shipped, WholeTrialSensitivity,
                         ::testing::Values(std::pair("elbow8", "curl_slow"),
                                           std::pair("elbow8_passive", "curl_fast")));

}  // namespace
}  // namespace bio
