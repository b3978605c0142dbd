#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/documents/shown_commands.h"
#include "support/run_program.h"

// Pages of the documentation site whose commands can be run; README's are in readme_test.
namespace {

using support::ScratchFolder;

const std::filesystem::path site = std::filesystem::path(FISHERHILL_SOURCE_DIR) / "docs/site";

/// A folder with the data that the pages use.
struct Place {
  Place() {
    for (const char* data : {"models", "emg_data"})
      std::filesystem::create_directory_symlink(std::filesystem::path(FISHERHILL_SOURCE_DIR) / data,
                                                scratch / data);
  }
  support::ProgramResult run(const std::string& command) const {
    const std::string path = "PATH='" + std::string(FISHERHILL_PROGRAM_FOLDER) + "':$PATH; ";
    return support::runProgram({"bash", "-c", path + command}, scratch.path());
  }

  ScratchFolder scratch;
};

// searches and studies, which take ten seconds or more, have tests of their own
bool isSlow(const std::string& command) {
  return command.starts_with("fisherhill discover ") || command.starts_with("fisherhill study ");
}

TEST(HowTo, EveryCommandWorks) {
  const Place place;
  int commands = 0;
  for (const std::string& command : documents::shellLines(site / "how_to.md")) {
    EXPECT_TRUE(command.starts_with("fisherhill ") || command.starts_with("sh out/")) << command;
    if (isSlow(command)) continue;
#ifndef FISHERHILL_HAS_VIEW
    if (command.starts_with("fisherhill render ")) continue;
#endif
    const auto result = place.run(command);
    EXPECT_EQ(result.status, 0) << command << result.err;
    ++commands;
  }
  EXPECT_GE(commands, 24);
}

TEST(Messages, AreWhatTheProgramSays) {
  const Place place;
  for (const std::string& command : documents::shellLines(site / "messages.md"))
    ASSERT_EQ(place.run(command).status, 0) << command;
  int shown = 0;
  for (const documents::ShownRun& run : documents::consoleRuns(site / "messages.md")) {
    const auto result = place.run(run.command);
    for (const std::string& line : run.output) {
      EXPECT_THAT("\n" + result.out + "\n" + result.err, testing::HasSubstr("\n" + line + "\n"))
          << run.command;
      ++shown;
    }
  }
  EXPECT_GE(shown, 10);
}

// Its discover and explore are those of the page; the search takes fifteen seconds.
TEST(FreeElbow, TourPrintsWhatItShows) {
  const Place place;
  for (const std::string& command : documents::shellLines(site / "free_elbow.md"))
    EXPECT_EQ(place.run(command).status, 0) << command;
  int shown = 0;
  for (const documents::ShownRun& run : documents::consoleRuns(site / "free_elbow.md")) {
    const auto result = place.run(run.command);
    EXPECT_EQ(result.status, 0) << run.command << result.err;
    for (const std::string& line : run.output) {
      EXPECT_THAT("\n" + result.out, testing::HasSubstr("\n" + line + "\n")) << run.command;
      ++shown;
    }
  }
  EXPECT_GE(shown, 6);
}

}  // namespace
