#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::HasSubstr;

const std::string shippedRaw = FISHERHILL_SOURCE_DIR "/emg_data/curl_slow_raw.csv";

TEST(EmgConfigCommand, WhatItWritesConvertsTheRecording) {
  const ScratchFolder scratch;
  const std::string config = (scratch / "c.toml").string();
  const ProgramResult written = runFisherHill({"emg", shippedRaw, "--write-config", config});
  ASSERT_EQ(written.status, 0) << written.err;
  EXPECT_THAT(written.out, HasSubstr("9 channels, 8 electrodes"));
  const std::string out = (scratch / "out").string();
  ASSERT_EQ(runFisherHill({"emg", shippedRaw, "--config", config, "--out", out}).status, 0);
  EXPECT_THAT(support::contentOf(out + "/excitations.sto"), HasSubstr("time\tTRIlong\tTRIlat"));
}

TEST(EmgConfigCommand, NothingIsOverwrittenAndMistakesAreOneLine) {
  const ScratchFolder scratch;
  const std::string config = scratch.file("c.toml", "mine");
  const auto fails = [&](const std::vector<std::string>& arguments, const std::string& message) {
    const ProgramResult result = runFisherHill(arguments);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  fails({"emg", shippedRaw, "--write-config", config, "--force"}, "is not overwritten");
  EXPECT_EQ(support::contentOf(config), "mine");
  const std::string other = (scratch / "other.toml").string();
  fails({"emg", shippedRaw, "--write-config", other, "--config", config}, "must be left out");
  fails({"emg", shippedRaw, "--write-config", other, "--out", (scratch / "o").string()},
        "--out and --figures must be left out");
  fails({"emg", shippedRaw, "--write-config", (scratch / "no/such/c.toml").string()},
        "cannot be written");
  EXPECT_FALSE(std::filesystem::exists(other));
}

TEST(EmgConfigCommand, TellsInJson) {
  const ScratchFolder scratch;
  const std::string config = (scratch / "c.toml").string();
  const ProgramResult written =
      runFisherHill({"emg", shippedRaw, "--write-config", config, "--json"});
  ASSERT_EQ(written.status, 0) << written.err;
  const auto json = nlohmann::json::parse(written.out);
  EXPECT_EQ(json["electrodes"], 8);
  EXPECT_EQ(json["is_complete"], true);
}

}  // namespace
