#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/run_program.h"
#include "support/scratch_folder.h"
#include "support/shipped_files.h"

// --figures and reproduce.sh, of the built program.
namespace {

namespace fs = std::filesystem;
using support::contentOf;
using support::model;
using support::ProgramResult;
using support::runFisherHill;
using support::runProgram;
using support::ScratchFolder;
using support::slow;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Figures are made where Debian's librsvg2-bin is installed, as ./start does.
class FigureFiles : public testing::Test {
 protected:
  void SetUp() override {
    if (runProgram({"sh", "-c", "command -v rsvg-convert"}).status != 0)
      GTEST_SKIP() << "rsvg-convert is not installed (librsvg2-bin)";
  }
  ProgramResult replay(std::vector<std::string> words) {
    words.insert(words.begin(), {"replay", model, slow});
    return runFisherHill(words);
  }
  const ScratchFolder scratch;
  const std::string figures = (scratch / "paper/figures").string(),
                    out = (scratch / "out").string();
};

TEST_F(FigureFiles, AreOfEveryFigureAndTable) {
  const ProgramResult result = replay({"--figures", figures});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("Figures: " + figures + "/figures.tex\n"));
  for (const char* name :
       {"simulated_elbow_flexion_and_measured_motion", "excitations", "activations",
        "tendon_forces", "moments", "moment_arms", "fibre_lengths", "energy"}) {
    EXPECT_TRUE(contentOf(figures + "/" + name + ".pdf").starts_with("%PDF-1.")) << name;
    EXPECT_THAT(contentOf(figures + "/" + name + ".svg"), HasSubstr("<svg ")) << name;
    EXPECT_THAT(contentOf(figures + "/figures.tex"), HasSubstr(std::string("{") + name + ".pdf}"));
  }
  EXPECT_THAT(contentOf(figures + "/numbers_of_this_result.csv"), HasSubstr("rms_error_deg,11.9"));
  EXPECT_THAT(contentOf(figures + "/numbers_of_this_result.tex"),
              HasSubstr("rms\\_error\\_deg & 11.9"));
  EXPECT_FALSE(fs::exists(out));
  EXPECT_THAT(scratch.listing(), Not(Contains(HasSubstr("unfinished"))));
}

TEST_F(FigureFiles, AreTheSameBytesEachTime) {
  ASSERT_EQ(replay({"--figures", figures}).status, 0);
  const std::string other = (scratch / "other").string();
  ASSERT_EQ(replay({"--figures", other}).status, 0);
  for (const auto& entry : fs::directory_iterator(figures)) {
    const std::string name = entry.path().filename();
    if (name.starts_with("numbers_of_this_result")) continue;  // they have times
    EXPECT_EQ(contentOf(entry.path()), contentOf(other + "/" + name)) << name;
  }
}

TEST_F(FigureFiles, ReplaceOlderOnesOnlyWithForceAndAsAWhole) {
  ASSERT_EQ(runFisherHill({"moment-arms", model, "--figures", figures}).status, 0);
  scratch.file("paper/figures/notes.txt", "mine");
  const auto before = scratch.listing();
  const ProgramResult refused = replay({"--figures", figures});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("--figures"), HasSubstr("figures.tex exists already; --force")));
  EXPECT_EQ(scratch.listing(), before);
  ASSERT_EQ(replay({"--figures", figures, "--out", out, "--force"}).status, 0);
  EXPECT_EQ(contentOf(figures + "/notes.txt"), "mine");
  const std::string list = contentOf(figures + "/figures.tex");
  for (const auto& entry : fs::directory_iterator(figures)) {
    const std::string name = entry.path().filename();
    if (name == "notes.txt" || name == "figures.tex") continue;
    EXPECT_THAT(list, HasSubstr("% file: " + name + "\n")) << "left of the older figures";
  }
}

TEST_F(FigureFiles, MayLieInTheFolderOfTheResult) {
  const std::string inside = out + "/figures";
  for (const char* again : {"", "--force"}) {
    std::vector<std::string> words = {"--out", out, "--figures", inside};
    if (*again) words.emplace_back(again);
    ASSERT_EQ(replay(words).status, 0);
    EXPECT_TRUE(fs::exists(inside + "/energy.pdf"));
    EXPECT_TRUE(fs::exists(out + "/report.html"));
    EXPECT_THAT(scratch.listing(), Not(Contains(HasSubstr("unfinished"))));
  }
}

TEST_F(FigureFiles, AreRefusedInOneLineAndLeaveNothing) {
  const std::string file = scratch.file("file", "");
  const auto before = scratch.listing();
  const std::vector<std::vector<std::string>> mistakes = {
      {"--figures", file},
      {"--figures", ""},
      {"--figures", file + "/below"},
      {"--figures", out, "--out", out},
      {"--figures", scratch.path().string() + "/./out", "--out", out},
      {"--figures", figures, "--out", file}};
  for (const auto& words : mistakes) {
    const ProgramResult result = replay(words);
    EXPECT_EQ(result.status, 2) << words[1];
    EXPECT_EQ(support::linesOf(result.err).size(), 1u) << result.err;
    EXPECT_EQ(scratch.listing(), before) << words[1];
  }
  // an input that has the name of a figure's table is not overwritten
  fs::copy_file(fs::path(FISHERHILL_SOURCE_DIR) / slow, scratch / "energy.svg");
  const ProgramResult result = runFisherHill({"replay", model, (scratch / "energy.svg").string(),
                                              "--figures", scratch.path().string(), "--force"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(contentOf(scratch / "energy.svg"), contentOf(fs::path(FISHERHILL_SOURCE_DIR) / slow));
}

TEST_F(FigureFiles, NeedTheConverterAndSaySo) {
  const std::string program = FISHERHILL_PROGRAM;
  const ProgramResult result = runProgram(
      {"/usr/bin/env", "PATH=/nowhere", program, "replay", model, slow, "--figures", figures},
      FISHERHILL_SOURCE_DIR);
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(
      result.err,
      HasSubstr("--figures: the program rsvg-convert is not there (Debian package librsvg2-bin)"));
  EXPECT_THAT(scratch.listing(), IsEmpty());
}

TEST_F(FigureFiles, HaveNoCommandsFromHostileNames) {
  std::string text = contentOf(fs::path(FISHERHILL_SOURCE_DIR) / model);
  const std::string hostile = "BRA&lt;/text&gt;&lt;script&gt;x_%$";
  for (std::size_t at = 0; (at = text.find("\"BRA\"", at)) != text.npos; at += hostile.size())
    text.replace(at + 1, 3, hostile);
  const std::string file = scratch.file("m.osim", text);
  const ProgramResult result =
      runFisherHill({"replay", file, slow, "--ignore-extra", "--figures", figures, "--out", out});
  ASSERT_EQ(result.status, 0) << result.err;
  for (const auto& entry : fs::directory_iterator(figures)) {
    if (entry.path().extension() == ".pdf") continue;
    EXPECT_THAT(contentOf(entry.path()), Not(HasSubstr("<script>"))) << entry.path();
  }
  EXPECT_THAT(contentOf(figures + "/activations.svg"),
              HasSubstr(">BRA&lt;/text&gt;&lt;script&gt;x_%$<"));
}

// --- reproduce.sh

class Reproduce : public testing::Test {
 protected:
  /// The script, run in a folder that has nothing to do with it.
  ProgramResult reproduce(const std::string& script, const std::string& argument = "") {
    const std::string program = "FISHERHILL=" + std::string(FISHERHILL_PROGRAM);
    fs::create_directories(scratch / "elsewhere");
    return runProgram({"/usr/bin/env", program, "sh", script, argument}, scratch / "elsewhere");
  }
  const ScratchFolder scratch;
  const std::string out = (scratch / "out").string();
};

TEST_F(Reproduce, RunsAgainFromAnotherFolderAndComparesTheNumbers) {
  ASSERT_EQ(
      runFisherHill({"replay", model, slow, "--out=" + out, "--initial", "elbow_flexion=34deg"})
          .status,
      0);
  ASSERT_TRUE((fs::status(out + "/reproduce.sh").permissions() & fs::perms::owner_exec) !=
              fs::perms::none);
  const ProgramResult result = reproduce(out + "/reproduce.sh", "new");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("reproduce.sh: 15 of 15 numbers agree to a millionth"));
  EXPECT_EQ(contentOf(scratch / "elsewhere/new/states.sto"), contentOf(out + "/states.sto"));
  // numbers that do not agree
  std::string summary = contentOf(out + "/summary.json");
  const std::size_t at = summary.find("\"final_time_s\": 4.5");
  ASSERT_NE(at, summary.npos);
  summary.replace(at, 19, "\"final_time_s\": 4.4");
  scratch.file("out/summary.json", summary);
  const ProgramResult differs = reproduce(out + "/reproduce.sh");
  EXPECT_EQ(differs.status, 1);
  EXPECT_THAT(differs.out, HasSubstr("was   \"final_time_s\": 4.4"));
}

TEST_F(Reproduce, FindsInputsOfAMovedProjectAndRefusesChangedOnes) {
  // names that a shell or sha256sum could take for something else
  const std::string name = "it's $HOME; `x` \\n -- a trial.sto";
  fs::create_directories(scratch / "project");
  fs::copy_file(fs::path(FISHERHILL_SOURCE_DIR) / slow, scratch / "project" / name);
  fs::copy_file(fs::path(FISHERHILL_SOURCE_DIR) / model, scratch / "project/m.osim");
  const std::string program = FISHERHILL_PROGRAM;
  ASSERT_EQ(runProgram({program, "replay", "m.osim", name, "--out", "results/a b", "--json"},
                       scratch / "project")
                .status,
            0);
  fs::rename(scratch / "project", scratch / "moved");
  const std::string script = (scratch / "moved/results/a b/reproduce.sh").string();
  EXPECT_EQ(reproduce(script).status, 0) << reproduce(script).err;
  scratch.file("moved/" + name, "changed");
  const ProgramResult changed = reproduce(script);
  EXPECT_EQ(changed.status, 1);
  EXPECT_THAT(changed.err, AllOf(HasSubstr("not the inputs of that run"), HasSubstr("FAILED")));
}

TEST_F(Reproduce, WarnsOfAnotherVersionAndNeedsTheProgram) {
  ASSERT_EQ(runFisherHill({"moment-arms", model, "--out", out}).status, 0);
  std::string script = contentOf(out + "/reproduce.sh");
  const std::size_t at = script.find("version='fisherhill ");
  ASSERT_NE(at, script.npos);
  script.insert(at + 20, "9");
  scratch.file("out/reproduce.sh", script);
  const ProgramResult other = reproduce(out + "/reproduce.sh");
  EXPECT_EQ(other.status, 0) << other.err;
  EXPECT_THAT(other.err, HasSubstr("warning: the result is of fisherhill 9"));
  const ProgramResult none =
      runProgram({"/usr/bin/env", "FISHERHILL=/nowhere/fisherhill", "sh", out + "/reproduce.sh"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("cannot start /nowhere/fisherhill"));
}

}  // namespace
