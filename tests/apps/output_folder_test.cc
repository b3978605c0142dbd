#include "output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <stdexcept>

#include "interruption.h"
#include "support/scratch_folder.h"

namespace app {
namespace {

using support::contentOf;
using support::ScratchFolder;
using testing::ElementsAre;
using testing::IsEmpty;

CommandContext contextWithOut(const std::filesystem::path& out) {
  CommandContext context;
  context.out = out;
  return context;
}

void writeText(OutputFolder& folder, const std::string& name, const std::string& text) {
  folder.write(name, [&](std::ostream& out) { out << text; });
}

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(OutputFolder, ShowsAllFilesAtOnceWhenCommitted) {
  const ScratchFolder scratch;
  OutputFolder folder(contextWithOut(scratch / "a/b"), {"states.sto"});
  writeText(folder, "states.sto", "one");
  writeText(folder, "forces.sto", "two");
  EXPECT_FALSE(std::filesystem::exists(folder.path("states.sto")));
  folder.commit();
  EXPECT_THAT(scratch.listing(), ElementsAre("a", "a/b", "a/b/forces.sto", "a/b/states.sto"));
  EXPECT_EQ(contentOf(scratch / "a/b/states.sto"), "one");
}

TEST(OutputFolder, LeavesNothingBehindWithoutCommit) {
  const ScratchFolder scratch;
  {
    OutputFolder folder(contextWithOut(scratch / "a/b"), {});
    writeText(folder, "states.sto", "one");
    EXPECT_THROW(folder.write("forces.sto",
                              [](std::ostream& out) {
                                out << "half";
                                throw std::domain_error("force is NaN");
                              }),
                 std::domain_error);
  }
  EXPECT_THAT(scratch.listing(), IsEmpty());
}

TEST(OutputFolder, KeepsOtherFilesAndTheOldResultWhenItFails) {
  const ScratchFolder scratch;
  scratch.file("notes.txt", "mine");
  scratch.file("states.sto", "old");
  CommandContext context = contextWithOut(scratch.path());
  context.force = true;
  {
    OutputFolder folder(context, {"states.sto"});
    writeText(folder, "states.sto", "new");
  }
  EXPECT_THAT(scratch.listing(), ElementsAre("notes.txt", "states.sto"));
  EXPECT_EQ(contentOf(scratch / "states.sto"), "old");
}

TEST(OutputFolder, OverwritesAResultOnlyByForce) {
  const ScratchFolder scratch;
  scratch.file("summary.json", "old");
  CommandContext context = contextWithOut(scratch.path());
  EXPECT_THAT(messageOf([&] { OutputFolder folder(context, {}); }),
              testing::AllOf(testing::HasSubstr("summary.json exists already"),
                             testing::HasSubstr("--force")));
  context.force = true;
  OutputFolder folder(context, {});
  writeText(folder, "summary.json", "new");
  folder.commit();
  EXPECT_EQ(contentOf(scratch / "summary.json"), "new");
}

TEST(OutputFolder, RefusesAPathThatIsNoFolder) {
  const ScratchFolder scratch;
  const std::string file = scratch.file("taken", "");
  EXPECT_THAT(messageOf([&] { OutputFolder(contextWithOut(file), {}); }),
              testing::HasSubstr("is not a folder"));
  EXPECT_THAT(messageOf([&] { OutputFolder(contextWithOut(file + "/below"), {}); }),
              testing::HasSubstr("taken/below: cannot be written to"));
  EXPECT_THAT(messageOf([&] { OutputFolder(contextWithOut(""), {}); }),
              testing::HasSubstr("name is empty"));
}

TEST(OutputFolder, AFileThatCannotBeWrittenIsNamed) {
  const ScratchFolder scratch;
  OutputFolder folder(contextWithOut(scratch.path()), {});
  EXPECT_THAT(messageOf([&] { writeText(folder, "missing/states.sto", "x"); }),
              testing::AllOf(testing::HasSubstr("missing/states.sto: cannot be written"),
                             testing::HasSubstr("No such file")));
}

TEST(OutputFolder, WithoutOutWritesNothing) {
  OutputFolder folder(CommandContext{}, {"states.sto"});
  bool called = false;
  folder.write("states.sto", [&](std::ostream&) { called = true; });
  folder.commit();
  EXPECT_FALSE(called);
  EXPECT_FALSE(folder.active());
  EXPECT_THAT(folder.files(), IsEmpty());
}

TEST(OutputFolderDeathTest, KeepsFinishedFilesAfterCtrlC) {
  const ScratchFolder scratch;
  const auto interruptedRun = [&] {
    catchInterruption();
    {
      OutputFolder folder(contextWithOut(scratch / "out"), {});
      writeText(folder, "compare.csv", "finished");
      try {
        folder.write("states.sto", [](std::ostream& out) {
          out << "half";
          std::raise(SIGINT);
          stopIfInterrupted();
        });
      } catch (const Interrupted&) {
      }
    }
    std::_Exit(130);
  };
  EXPECT_EXIT(interruptedRun(), testing::ExitedWithCode(130), "");
  EXPECT_THAT(scratch.listing(), ElementsAre("out", "out/compare.csv"));
  EXPECT_EQ(contentOf(scratch / "out/compare.csv"), "finished");
}

}  // namespace
}  // namespace app
