#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

// Files that are none, files that a result must not replace, and the end that a signal makes.
namespace {

namespace fs = std::filesystem;
using support::model;
using support::ProgramResult;
using support::ScratchFolder;
using testing::HasSubstr;

constexpr const char* threeRows = "time,BIClong\n0,0.1\n0.1,0.2\n0.2,0.1\n";

/// `fisherhill` by way of a shell, which a redirection needs; ended after 20 s.
ProgramResult inShell(const std::string& line) {
  return support::runProgram(
      {"timeout", "--foreground", "20", "bash", "-c", line, FISHERHILL_PROGRAM},
      FISHERHILL_SOURCE_DIR);
}

TEST(InputFiles, PipesAndDevicesAreRefusedAtOnce) {
  const ScratchFolder scratch;
  const std::string pipe = (scratch / "trial.sto").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& command : std::vector<std::string>{
           "replay " + model + " ", "check " + model + " ", "sensitivity " + model + " ",
           "moment-arms ", "emg emg_data/curl_slow_raw.csv --config "}) {
    const ProgramResult fromPipe = inShell("exec \"$0\" " + command + pipe);
    EXPECT_EQ(fromPipe.status, 2) << command;
    EXPECT_THAT(fromPipe.err, HasSubstr(pipe + ": is a pipe, must be a regular file")) << command;
    for (const char* device : {"/dev/zero", "/dev/urandom"}) {
      const ProgramResult result = inShell("exec \"$0\" " + command + device);
      EXPECT_EQ(result.status, 2) << command;
      EXPECT_THAT(result.err,
                  HasSubstr(std::string(device) + ": is a device, must be a regular file"));
    }
  }
}

TEST(InputFiles, AResultNeverTakesTheirPlaceUnderWhateverName) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
  ASSERT_EQ(
      support::runFisherHill({"replay", model, scratch.file("trial.csv", threeRows), "--out", out})
          .status,
      0);
  fs::copy_file(fs::path(FISHERHILL_SOURCE_DIR) / support::slow, scratch / "out/forces.sto",
                fs::copy_options::overwrite_existing);
  const std::string trial = (scratch / "out/forces.sto").string();
  const std::string before = support::contentOf(trial);
  fs::create_hard_link(trial, scratch / "hard.sto");
  fs::create_symlink(trial, scratch / "soft.sto");
  for (const std::string& name :
       {trial, (scratch / "hard.sto").string(), (scratch / "soft.sto").string()}) {
    const ProgramResult result =
        support::runFisherHill({"replay", model, name, "--out", out, "--force"});
    EXPECT_EQ(result.status, 2) << name;
    EXPECT_EQ(result.err, "fisherhill replay: " + name +
                              ": is an input and would be overwritten; choose another --out\n");
    EXPECT_EQ(support::contentOf(trial), before);
  }
}

TEST(Signals, OneEndsAReplayOfATrialThatBeginsLongBeforeZero) {
  const ScratchFolder scratch;
  const std::string trial =
      scratch.file("early.csv", "time,BIClong\n-3.2,0.1\n-2.1,0.2\n-1.05,0.1\n0,0.3\n");
  const ProgramResult result = support::runProgram(
      {"timeout", "--foreground", "20", FISHERHILL_PROGRAM, "replay", model, trial, "--json"},
      FISHERHILL_SOURCE_DIR);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NEAR(nlohmann::json::parse(result.out)["final_time_s"].get<double>(), 0, 1e-9);
}

TEST(StandardStreams, MayBeClosed) {
  const ScratchFolder scratch;
  const std::string trial = scratch.file("trial.csv", threeRows);
  for (const std::string closed : {"<&-", ">&-", "2>&-", "<&- >&- 2>&-"}) {
    const std::string out = (scratch / "out").string();
    const ProgramResult result = inShell("exec \"$0\" replay " + model + " " + trial + " --out " +
                                         out + " --force " + closed);
    EXPECT_EQ(result.status, 0) << closed << result.err;
    // nothing that is printed has landed in a file
    EXPECT_THAT(support::contentOf(out + "/states.sto"), testing::StartsWith("states\n")) << closed;
    EXPECT_EQ(nlohmann::json::parse(support::contentOf(out + "/summary.json"))["subcommand"],
              "replay");
    const ProgramResult wrong = inShell("exec \"$0\" replay " + closed);
    EXPECT_EQ(wrong.status, 2) << closed;
  }
  EXPECT_EQ(inShell("exec \"$0\" replay " + model + " " + trial + " 2>/dev/full").status, 0);
  EXPECT_EQ(inShell("exec \"$0\" replay " + model + " none.sto 2>/dev/full").status, 2);
}

}  // namespace
