// The program on a recording made elsewhere, which lies beside the project.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "support/run_program.h"

namespace {

using support::ProgramResult;
using support::runFisherHill;
using testing::Contains;
using testing::HasSubstr;

TEST(RecordedEmgCommand, RunsOnTheGoniometerRecordingWithTheShippedConfiguration) {
  const std::string raw =
      std::string(FISHERHILL_SOURCE_DIR) + "/../shared/data/emg/goniometer/Carl_1.txt";
  const ProgramResult result =
      runFisherHill({"emg", raw, "--config", "emg_data/configs/goniometer.toml", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_THAT(json["muscles"], testing::ElementsAre("BIClong", "BICshort", "BRA", "BRD"));
  EXPECT_THAT(json["remarks"], Contains(HasSubstr("does not show how they share the load")));
  EXPECT_NEAR(json["measured_fraction_missing"], 0.013, 0.0005);
}

}  // namespace
