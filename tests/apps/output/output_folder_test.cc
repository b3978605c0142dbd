#include "output/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

#include "output/interruption.h"
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

// Whoever looks finds the older result or the new one: the folders are exchanged in one step.
TEST(OutputFolder, ExchangesAnOlderResultAsAWhole) {
  const ScratchFolder scratch;
  std::filesystem::create_directories(scratch / "out/mine");
  scratch.file("out/states.sto", "old");
  scratch.file("out/with_effect.osim", "old");
  scratch.file("out/mine/notes.txt", "the user's");
  const auto before = std::filesystem::hard_link_count(scratch / "out/mine/notes.txt");
  CommandContext context = contextWithOut(scratch / "out");
  context.force = true;
  {
    OutputFolder folder(context, {"states.sto", "with_effect.osim"});
    writeText(folder, "states.sto", "new");
    EXPECT_EQ(folder.hashOf("states.sto"),
              "11507a0e2f5e69d5dfa40a62a1bd7b6ee57e6bcd85c67c9b8431b36fff21c437");
    folder.commit();
  }
  EXPECT_THAT(scratch.listing(),
              ElementsAre("out", "out/mine", "out/mine/notes.txt", "out/states.sto"));
  EXPECT_EQ(contentOf(scratch / "out/states.sto"), "new");
  EXPECT_EQ(contentOf(scratch / "out/mine/notes.txt"), "the user's");
  EXPECT_EQ(std::filesystem::hard_link_count(scratch / "out/mine/notes.txt"), before);
}

TEST(OutputFolder, RefusesAFolderWhereAFileIsWritten) {
  const ScratchFolder scratch;
  std::filesystem::create_directories(scratch / "out/report.html");
  CommandContext context = contextWithOut(scratch / "out");
  context.force = true;
  EXPECT_THAT(messageOf([&] { OutputFolder(context, {"states.sto"}); }),
              testing::HasSubstr("report.html is a folder, a file of this name is written"));
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

/// A program that has written a file and half of another one into the folder, and waits.
class HalfWriter {
 public:
  explicit HalfWriter(const std::filesystem::path& out) {
    int ready[2];
    if (pipe(ready) != 0) throw std::runtime_error("no pipe");
    child_ = fork();
    if (child_ == 0) {
      OutputFolder folder(contextWithOut(out), {});
      writeText(folder, "states.sto", "whole");
      folder.write("forces.sto", [&](std::ostream& stream) {
        stream << "half" << std::flush;
        (void)!::write(ready[1], "x", 1);
        for (;;) pause();
      });
    }
    char one;
    (void)!::read(ready[0], &one, 1);
    close(ready[0]);
    close(ready[1]);
  }
  ~HalfWriter() { kill(); }

  void kill() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    child_ = 0;
  }

 private:
  pid_t child_ = 0;
};

TEST(OutputFolder, ClearsAwayWhatAKilledProgramHasLeftAndNothingOfALivingOne) {
  const ScratchFolder scratch;
  scratch.file("notes.txt", "mine");
  scratch.file(".unfinished-elsewhere-17-states.sto", "another machine's");
  scratch.file(".unfinished-elsewhere-17", "");
  scratch.file(".unfinished-notes", "mine");
  const auto others = scratch.listing();
  HalfWriter dead(scratch.path());
  dead.kill();
  EXPECT_EQ(scratch.listing().size(), others.size() + 3);  // its mark and two files
  HalfWriter alive(scratch.path());  // it has opened the folder, so the dead one's are gone
  const auto withTheLiving = scratch.listing();
  EXPECT_EQ(withTheLiving.size(), others.size() + 3);
  { OutputFolder folder(contextWithOut(scratch.path()), {}); }
  EXPECT_EQ(scratch.listing(), withTheLiving);
  alive.kill();
  { OutputFolder folder(contextWithOut(scratch.path()), {}); }
  EXPECT_EQ(scratch.listing(), others);
  EXPECT_EQ(contentOf(scratch / "notes.txt"), "mine");
}

TEST(OutputFolder, TakesOnlyRegularFilesForLeftovers) {
  const ScratchFolder scratch;
  HalfWriter dead(scratch.path());
  dead.kill();
  std::string mark;
  for (const std::string& name : scratch.listing()) {
    if (mark.empty() || name.size() < mark.size()) mark = name;
  }
  scratch.file("precious", "mine");
  const auto isThere = [&](const std::string& name) {
    return std::filesystem::exists(std::filesystem::symlink_status(scratch / name));
  };
  std::filesystem::create_symlink(scratch / "precious", scratch / (mark + "-link"));
  std::filesystem::create_directory(scratch / (mark + "-folder"));
  { OutputFolder folder(contextWithOut(scratch.path()), {}); }
  EXPECT_FALSE(isThere(mark));
  // a mark that is only a link to somebody's file is none
  std::filesystem::create_symlink(scratch / "precious", scratch / mark);
  scratch.file(mark + "-states.sto", "kept with it");
  { OutputFolder folder(contextWithOut(scratch.path()), {}); }
  for (const std::string& name :
       {mark, mark + "-states.sto", mark + "-folder", mark + "-link", std::string("precious")}) {
    EXPECT_TRUE(isThere(name)) << name;
  }
}

TEST(OutputFolder, TwoAtWorkInOneFolderKeepApart) {
  const ScratchFolder scratch;
  const HalfWriter other(scratch.path());
  const auto before = scratch.listing();
  CommandContext context = contextWithOut(scratch.path());
  {
    OutputFolder folder(context, {});
    writeText(folder, "states.sto", "mine");
    folder.commit();
  }
  auto after = before;
  after.push_back("states.sto");
  EXPECT_EQ(scratch.listing(), after);
  EXPECT_EQ(contentOf(scratch / "states.sto"), "mine");
}

}  // namespace
}  // namespace app
