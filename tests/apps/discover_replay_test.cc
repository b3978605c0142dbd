#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "support/replays.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::contentOf;
using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;

// What `discover` writes is what it scored: its files are replayed, trial by trial.
void expectOneNumber(const std::string& set) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string(), data = "emg_data/" + set;
  const ProgramResult result =
      runFisherHill({"discover", "models/elbow8.osim", data + "/train_1.sto", data + "/train_2.sto",
                     data + "/train_3.sto", "--hold-out", data + "/held_out.sto", "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto verdict = nlohmann::json::parse(contentOf(out + "/verdict.json"));
  ASSERT_EQ(verdict["trials"].size(), 4U);
  EXPECT_EQ(verdict["trials"][3]["role"], "held_out");
  EXPECT_THAT(result.err, testing::Not(testing::HasSubstr("the search itself had")));
  ASSERT_TRUE(verdict["model"].is_string()) << verdict["sentence"];
  support::expectReplaysAgree(out + "/" + verdict["model"].get<std::string>(), verdict["trials"]);
  EXPECT_NEAR(verdict["gap"]["train"]["rmse_after_deg"].get<double>(),
              support::pooled(verdict["trials"], "train"), 0.02);
  EXPECT_NEAR(verdict["gap"]["held_out"]["rmse_after_deg"].get<double>(),
              support::pooled(verdict["trials"], "held_out"), 1e-9);
}

TEST(DiscoverReplay, HiddenA) {
  expectOneNumber("hidden_a");
}
TEST(DiscoverReplay, HiddenB) {
  expectOneNumber("hidden_b");
}
TEST(DiscoverReplay, HiddenC) {
  expectOneNumber("hidden_c");
}

}  // namespace
