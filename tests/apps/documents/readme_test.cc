#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "apps/documents/shown_commands.h"
#include "support/run_program.h"
#include "support/scratch_folder.h"

namespace {

using documents::consoleRuns;
using documents::shellLines;
using documents::ShownRun;
using support::contentOf;
using support::ScratchFolder;

const std::filesystem::path source = FISHERHILL_SOURCE_DIR;

/// Commands that build or install: they cannot run inside a test of what they built. CI runs them.
bool isRunByCi(const std::string& line) {
  return line.starts_with("./start") || line.starts_with("cmake ") || line.starts_with("ctest ");
}

/// tests/python/pip_install runs them.
bool isRunByPipTest(const std::string& line) {
  return line.starts_with("/usr/bin/python3 -m venv ") || line.starts_with("v/bin/pip ");
}

TEST(Readme, EveryCommandOfTheProgramWorks) {
  const ScratchFolder scratch;
  for (const char* data : {"models", "emg_data"}) {
    if (std::filesystem::exists(source / data)) {
      std::filesystem::create_directory_symlink(source / data, scratch / data);
    }
  }
  std::string script = "set -eux\nPATH='" + std::string(FISHERHILL_PROGRAM_FOLDER) + "':$PATH\n";
  int commands = 0;
  for (const std::string& line : shellLines(source / "README.md")) {
    if (isRunByCi(line) || isRunByPipTest(line) || line.starts_with("export PATH=")) continue;
    EXPECT_THAT(line, testing::StartsWith("fisherhill ")) << "nobody runs this command";
    script += line + "\n";
    ++commands;
  }
  EXPECT_GT(commands, 0);
  const support::ProgramResult result = support::runProgram({"bash", "-c", script}, scratch.path());
  EXPECT_EQ(result.status, 0) << result.err << result.out;
}

TEST(Readme, TourPrintsWhatItShows) {
  const ScratchFolder scratch;
  for (const char* data : {"models", "emg_data"}) {
    std::filesystem::create_directory_symlink(source / data, scratch / data);
  }
  const std::string path = "PATH='" + std::string(FISHERHILL_PROGRAM_FOLDER) + "':$PATH; ";
  int shown = 0;
  for (const ShownRun& run : consoleRuns(source / "README.md")) {
    // takes ten seconds; DiscoverCommand.NamesTheDamping… is the same command, and replays and
    // explores what it has written
    if (run.command.starts_with("fisherhill discover ")) continue;
    if (run.command.starts_with("fisherhill replay out/discover/")) continue;
    if (run.command.find("--verdict out/discover") != std::string::npos) continue;
#ifndef FISHERHILL_HAS_VIEW
    if (run.command.starts_with("fisherhill render ")) continue;
#endif
    const auto result = support::runProgram({"bash", "-c", path + run.command}, scratch.path());
    EXPECT_EQ(result.status, 0) << run.command << result.err;
    for (const std::string& line : run.output) {
      EXPECT_THAT("\n" + result.out, testing::HasSubstr("\n" + line + "\n")) << run.command;
      ++shown;
    }
  }
  EXPECT_GT(shown, 9);  // fewer where nothing is rendered
}

TEST(Readme, ItsTestCommandIsWhatCiRuns) {
  const std::vector<std::string> lines = shellLines(source / "README.md");
  const std::string ci = contentOf(source / ".ci/run");
  int found = 0;
  for (const std::string& line : lines) {
    if (!line.starts_with("./start")) continue;
    EXPECT_THAT(ci, testing::HasSubstr("\n" + line + " --yes\n"));
    ++found;
  }
  EXPECT_EQ(found, 2);
}

TEST(Readme, ItsPipCommandsAreWhatTheirTestRuns) {
  const std::string test = contentOf(source / "tests/python/pip_install");
  int found = 0;
  for (const std::string& line : shellLines(source / "README.md")) {
    if (!isRunByPipTest(line)) continue;
    // the program and the last word name the environment, which is elsewhere in the test
    const std::size_t begin = line.find(' ');
    EXPECT_THAT(test, testing::HasSubstr(line.substr(begin, line.rfind(' ') + 1 - begin)));
    ++found;
  }
  EXPECT_EQ(found, 2);
}

TEST(Readme, ListsExactlyTheSubcommandsThereAre) {
  const std::string readme = contentOf(source / "README.md");
  const std::string help = support::runFisherHill({"--help"}).out;
  std::istringstream text(help.substr(help.find("Subcommands:")));
  std::string line;
  std::getline(text, line);
  std::size_t subcommands = 0;
  while (std::getline(text, line) && line.starts_with("  ")) {
    if (line.starts_with("   ")) continue;
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    EXPECT_NE(readme.find("| `fisherhill " + name), readme.npos) << name << " has no row";
    ++subcommands;
  }
  std::size_t rows = 0;
  for (std::size_t at = 0; (at = readme.find("\n| `fisherhill ", at)) != readme.npos; ++at) ++rows;
  EXPECT_EQ(rows, subcommands) << "rows of the table, subcommands";
}

TEST(Version, IsTheSameInTheProgramTheBuildAndTheCitation) {
  const std::string version = support::runFisherHill({"--version"}).out;
  const std::string number = version.substr(version.find(' ') + 1, version.size() - 12);
  EXPECT_EQ(version, "fisherhill " + number + "\n");
  EXPECT_THAT(contentOf(source / "CMakeLists.txt"), testing::HasSubstr("VERSION " + number + " "));
  EXPECT_THAT(contentOf(source / "CITATION.cff"),
              testing::HasSubstr("\nversion: " + number + "\n"));
}

TEST(Contributing, ItsCommandsAreWhatCiRuns) {
  const std::string ci = contentOf(source / ".ci/run");
  const std::vector<std::string> lines = shellLines(source / "CONTRIBUTING.md");
  for (const std::string& line : lines) EXPECT_THAT(ci, testing::HasSubstr("\n" + line));
  EXPECT_EQ(lines.size(), 3u);
}

TEST(Start, RunsTheReadmesFirstResult) {
  const std::vector<std::string> lines = shellLines(source / "README.md");
  const auto first = std::find_if(lines.begin(), lines.end(), [](const std::string& line) {
    return line.starts_with("fisherhill ");
  });
  ASSERT_NE(first, lines.end());
  EXPECT_THAT(contentOf(source / "start"), testing::HasSubstr("/" + *first + "\n"));
}

TEST(Start, RefusesWhatItDoesNotKnow) {
  const auto result = support::runProgram({(source / "start").string(), "everything"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, testing::HasSubstr("unknown argument 'everything'"));
}

/// A repository whose `start` only notes its arguments, with the script that times it.
class TimedFirstCommands : public testing::Test {
 protected:
  support::ProgramResult timed(std::vector<std::string> options) {
    options.insert(options.begin(), (folder / "bench/first_commands.sh").string());
    return support::runProgram(options);
  }
  /// @param start its lines, in which $NOTES is the file of notes
  void commit(const std::string& start) {
    std::filesystem::create_directories(folder / "bench");
    std::filesystem::copy_file(source / "bench/first_commands.sh",
                               folder / "bench/first_commands.sh");
    folder.file("start", "#!/bin/sh\nNOTES=" + notes + "\n" + start);
    std::filesystem::permissions(folder / "start", std::filesystem::perms::owner_all);
    const std::string git = "cd '" + folder.path().string() +
                            "' && git init --quiet && git add . && git -c user.name=a -c "
                            "user.email=a@b.c commit --quiet --message=start";
    ASSERT_EQ(support::runProgram({"sh", "-c", git}).status, 0);
  }

  ScratchFolder folder, elsewhere;
  const std::string notes = (elsewhere / "notes").string();
};

TEST_F(TimedFirstCommands, RunInNewClonesWithoutCcacheAndTheMedianIsALineOfTheReadme) {
  // the second command finds what the first has built, which begins with nothing
  commit(
      "if [ $1 = test ]; then test -e built; else test ! -e built && touch built; fi &&\n"
      "echo \"$* $CCACHE_DISABLE\" >> $NOTES\n");
  const auto result = timed({});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out,
              testing::ContainsRegex("3: ./start [0-9.]+ s, ./start test [0-9.]+ s\nOn [0-9]+ "
                                     "cores, run in this order, the first command takes 0 s and "
                                     "the second 0 s [(]medians of 3, 20[0-9-]+[)][.]\n$"));
  EXPECT_EQ(contentOf(notes),
            "--yes 1\ntest --yes 1\n--yes 1\ntest --yes 1\n--yes 1\ntest --yes 1\n");
  const std::string words = "On two cores, run in this order, the first command takes";
  EXPECT_THAT(
      std::regex_replace(contentOf(source / "README.md"), std::regex("\n"), " "),
      testing::AllOf(testing::HasSubstr(words), testing::HasSubstr("bench/first_commands.sh")));
}

TEST_F(TimedFirstCommands, TheMedianIsTheMiddleOneAndAnotherCommandMayStandForStart) {
  commit("exit 1\n");
  const std::string other = elsewhere.file("other", "#!/bin/sh\necho $1 >> " + notes +
                                                        "\ntest $1 = test || sleep $(wc -l < " +
                                                        notes + " | tr 135 102)\n");  // 1, 0, 2 s
  std::filesystem::permissions(other, std::filesystem::perms::owner_all);
  const auto result = timed({"--start", other});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr("the first command takes 1 s and the second 0 s"));
}

TEST_F(TimedFirstCommands, EndWithTheLastLinesOfACommandThatFails) {
  commit("echo out of wood; exit 4\n");
  const auto result = timed({"--times", "1"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, testing::AllOf(testing::HasSubstr("out of wood\n"),
                                         testing::HasSubstr("./start --yes failed")));
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--times", "0"}, {"--times"}, {"--repeat", "2"}}) {
    const auto refused = timed(wrong);
    EXPECT_EQ(refused.status, 2);
    EXPECT_EQ(support::linesOf(refused.err).size(), 1u) << refused.err;
  }
}

TEST(Start, NamesAPackageForEveryLibraryThatIsLookedFor) {
  const std::string launcher = contentOf(source / "start");
  const std::string cmake = contentOf(source / "CMakeLists.txt");
  const std::vector<std::pair<std::string, std::string>> packages = {
      {"Eigen3", "libeigen3-dev"},
      {"SUNDIALS", "libsundials-dev"},
      {"TBB", "libtbb-dev"},
      {"fmt", "libfmt-dev"},
      {"Simbody", "libsimbody-dev"},
      {"tinyxml2", "libtinyxml2-dev"},
      {"CLI11", "libcli11-dev"},
      {"OpenSSL", "libssl-dev"},
      {"GTest", "libgtest-dev"},
      {"benchmark", "libbenchmark-dev"},
      {"valijson", "libvalijson-dev"},
      {"toml11", "libtoml11-dev"},
      {"nlohmann_json", "nlohmann-json3-dev"},
      {"Threads", "g++"},
      {"VTK", "libvtk9-dev"},
      {"X11", "libx11-dev"},
      {"MPI", "libopenmpi-dev"}};
  std::size_t at = 0;
  while ((at = cmake.find("find_package(", at)) != cmake.npos) {
    at += std::string_view("find_package(").size();
    const std::string library = cmake.substr(at, cmake.find_first_of(" )", at) - at);
    const auto known = std::find_if(packages.begin(), packages.end(),
                                    [&](const auto& pair) { return pair.first == library; });
    ASSERT_NE(known, packages.end()) << library << ": which Debian package brings it?";
    EXPECT_THAT(launcher, testing::HasSubstr(known->second)) << library;
  }
}

}  // namespace
