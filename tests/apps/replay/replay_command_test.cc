#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

namespace {

using support::ProgramResult;
using support::runFisherHill;
using support::ScratchFolder;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr const char* straightLine = "apart: the excitation between them is taken as a straight";

TEST(ReplayCommand, RemarksOnRowsThatDoNotShowTheExcitation) {
  const ScratchFolder scratch;
  const auto warningsOf = [&](double interval, double excitation) {
    const std::string trial = scratch.file(
        "trial.csv",
        fmt::format("time,BRA\n0,0.1\n{},{}\n{},0.1\n", interval, excitation, 2 * interval));
    const ProgramResult replayed = runFisherHill({"replay", support::model, trial, "--json"});
    const ProgramResult checked = runFisherHill({"check", support::model, trial, "--json"});
    EXPECT_EQ(replayed.status, 0) << replayed.err;
    EXPECT_EQ(checked.status, 0) << checked.err;
    EXPECT_EQ(checked.out.find(straightLine) == std::string::npos,
              replayed.err.find(straightLine) == std::string::npos);
    return nlohmann::json::parse(replayed.out)["warnings"];
  };
  EXPECT_THAT(
      warningsOf(0.25, 0.12),
      Contains(AllOf(HasSubstr("trial.csv: time: rows are up to 0.25 s apart: the excitation"),
                     HasSubstr("at 20 Hz or more"))));
  EXPECT_THAT(warningsOf(0.1, 0.12), Not(Contains(HasSubstr(straightLine))));
  EXPECT_THAT(warningsOf(0.25, 0.1), Not(Contains(HasSubstr(straightLine))));
}

}  // namespace
