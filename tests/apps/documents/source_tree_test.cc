#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include "support/run_program.h"
#include "support/scratch_folder.h"

// The rules of the architecture that can be read off the source tree.
namespace {

namespace fs = std::filesystem;
using support::contentOf;

const fs::path sourceTree = FISHERHILL_SOURCE_DIR;

/// Every entry below a folder. A folder that is not there, or is empty, fails the test.
std::vector<fs::directory_entry> entriesBelow(const std::string& folder) {
  std::vector<fs::directory_entry> entries;
  if (fs::is_directory(sourceTree / folder)) {
    for (const auto& entry : fs::recursive_directory_iterator(sourceTree / folder)) {
      entries.push_back(entry);
    }
  }
  EXPECT_FALSE(entries.empty()) << "nothing in folder " << folder;
  return entries;
}

/// Every source file below a folder, with its path from the top. A folder without any fails the
/// test.
std::vector<std::string> sourcesBelow(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : entriesBelow(folder)) {
    const std::string extension = entry.path().extension();
    if (extension == ".h" || extension == ".cc") {
      files.push_back(fs::relative(entry.path(), sourceTree).string());
    }
  }
  EXPECT_FALSE(files.empty()) << "no source in folder " << folder;
  return files;
}

const std::vector<std::string> folders = {"libinfo",    "libbio", "apps",  "tests",
                                          "validation", "bench",  "python"};

/// Every source file that includes a header whose name begins with the pattern. A pattern that
/// matches nowhere fails the test.
std::vector<std::string> filesThatInclude(const std::string& pattern) {
  const std::regex include("#include [<\"](" + pattern + ")");
  std::vector<std::string> files;
  for (const std::string& folder : folders) {
    for (const std::string& file : sourcesBelow(folder)) {
      if (std::regex_search(contentOf(sourceTree / file), include)) files.push_back(file);
    }
  }
  EXPECT_FALSE(files.empty()) << "nothing includes " << pattern;
  return files;
}

bool isBelow(const std::string& file, const std::vector<std::string>& places) {
  return std::any_of(places.begin(), places.end(),
                     [&](const std::string& place) { return file.starts_with(place + "/"); });
}

void expectIncludedOnlyBelow(const std::vector<std::string>& places, const std::string& pattern) {
  for (const std::string& place : places) sourcesBelow(place);
  for (const std::string& file : filesThatInclude(pattern)) {
    EXPECT_TRUE(isBelow(file, places)) << file << " includes " << pattern;
  }
}

TEST(SourceTree, LibinfoKnowsNoBiology) {
  const std::vector<std::string> places = {"libinfo", "tests/libinfo"};
  for (const std::string& place : places) sourcesBelow(place);
  const std::string pattern = "bio/|Simbody|SimTK|tinyxml2";
  for (const std::string& file : filesThatInclude(pattern)) {
    EXPECT_FALSE(isBelow(file, places)) << file << " includes " << pattern;
  }
  // nor do its names, comments and messages: "moment" and "joint" are mechanics, these are not
  const std::regex words(
      "muscle|tendon|elbow|forearm|biceps|triceps|fibre|sarcomere|skelet|anatom|physiolog|opensim|"
      "\\bemg|\\blimb|\\bbone",
      std::regex::icase);
  EXPECT_TRUE(std::regex_search(std::string("what a MusclePath is"), words));
  EXPECT_FALSE(std::regex_search(std::string("climb trombone self-adjoint"), words));
  for (const std::string& file : sourcesBelow("libinfo")) {
    std::smatch found;
    const std::string text = contentOf(sourceTree / file);
    EXPECT_FALSE(std::regex_search(text, found, words)) << file << " says " << found.str();
  }
  // mechanics belong to Lagrangian systems and robots; the sentences of verdicts are the exception
  const std::regex mechanics(
      "\\bangles?\\b|moment arm|torque|mechanic|\\bjoint (angle|damping|friction|moment|stiffness)",
      std::regex::icase);
  EXPECT_TRUE(std::regex_search(std::string("a limit angle"), mechanics));
  EXPECT_TRUE(std::regex_search(std::string("viscous joint damping"), mechanics));
  EXPECT_FALSE(std::regex_search(std::string("a triangle, a joint fit"), mechanics));
  const std::vector<std::string> mechanical = {"libinfo/robots", "libinfo/include/info/dynamics",
                                               "libinfo/src/dynamics"};
  for (const std::string& file : sourcesBelow("libinfo")) {
    if (isBelow(file, mechanical) || file.ends_with("/verdict_sentence.cc")) continue;
    std::smatch found;
    const std::string text = contentOf(sourceTree / file);
    EXPECT_FALSE(std::regex_search(text, found, mechanics)) << file << " says " << found.str();
  }
}

TEST(SourceTree, SimbodyIsOnlyASecondWay) {
  expectIncludedOnlyBelow({"validation/second_ways"}, "Simbody|SimTK");
}

TEST(SourceTree, OnlyTheViewKnowsVtk) {
  expectIncludedOnlyBelow({"libbio/view", "tests/libbio/view"}, "vtk");
}

TEST(SourceTree, OnlyTheProgramReadsCommandLines) {
  expectIncludedOnlyBelow({"apps", "tests/apps"}, "CLI/");
}

TEST(SourceTree, EveryPublicHeaderIsInItsLibrarysHeaderFileSet) {
  for (const std::string top : {"libinfo/", "libinfo/robots/", "libbio/"}) {
    const std::string cmake = contentOf(sourceTree / top / "CMakeLists.txt") +
                              contentOf(sourceTree / top / "public_headers.cmake");
    for (const std::string& header : sourcesBelow(top + "include")) {
      EXPECT_THAT(cmake, testing::HasSubstr("  " + header.substr(top.size()) + "\n"));
    }
  }
}

/// Words of a CMakeLists.txt, comments left out: file names stand as whole words.
std::set<std::string> wordsOf(const fs::path& cmake) {
  const std::string text = std::regex_replace(contentOf(cmake), std::regex("#[^\n]*"), "");
  const std::regex word("[^\\s();<>:\"]+");
  return {std::sregex_token_iterator(text.begin(), text.end(), word), {}};
}

TEST(SourceTree, EveryTestProgramIsBuilt) {
  int programs = 0;
  for (const std::string& file : sourcesBelow("tests")) {
    if (!file.ends_with("_test.cc")) continue;
    fs::path lists = fs::path(file).parent_path();
    while (!fs::exists(sourceTree / lists / "CMakeLists.txt")) lists = lists.parent_path();
    const std::set<std::string> words = wordsOf(sourceTree / lists / "CMakeLists.txt");
    const fs::path named = fs::path(file).lexically_relative(lists);
    // by its name, or as the one file of the program that is called as it is
    const bool isProgram = !named.has_parent_path() && words.contains(named.stem().string());
    EXPECT_TRUE(isProgram || words.contains(named.string()))
        << file << " is not in " << lists.string() << "/CMakeLists.txt";
    ++programs;
  }
  EXPECT_GT(programs, 100);
}

TEST(SourceTree, NoFolderIsADrawerForAnything) {
  const std::set<std::string> drawers = {"utils", "util", "common", "misc",
                                         "core",  "base", "helpers"};
  for (const std::string& folder : folders) {
    for (const auto& entry : entriesBelow(folder)) {
      if (entry.is_directory()) {
        EXPECT_EQ(drawers.count(entry.path().filename()), 0u) << entry.path();
      }
    }
  }
}

TEST(SourceTree, NoDocstringIsARiddleWithoutASubject) {
  const std::regex riddle("\n *///<? (Of|The same)\\b");
  EXPECT_TRUE(std::regex_search(std::string("\n  /// Of each output."), riddle));
  EXPECT_TRUE(std::regex_search(std::string("\n/// The same, faster."), riddle));
  EXPECT_FALSE(std::regex_search(std::string("\n/// Offset of each output."), riddle));
  for (const std::string folder : {"libinfo", "libbio", "apps", "python"}) {
    for (const std::string& file : sourcesBelow(folder)) {
      std::smatch found;
      const std::string text = "\n" + contentOf(sourceTree / file);
      EXPECT_FALSE(std::regex_search(text, found, riddle)) << file << ":" << found.str();
    }
  }
}

/// A source text without its comments and strings.
std::string codeOf(const std::string& text) {
  return std::regex_replace(text, std::regex("//[^\n]*|\"([^\"\\\\\n]|\\\\.)*\""), "");
}

TEST(SourceTree, RetiredWordsDoNotComeBackAsNamesInCode) {
  const std::vector<std::string> retired = {"armOptions", "hasOnlyAngles", "outputSd", "radian"};
  EXPECT_EQ(codeOf("int a;  // radian\nf(\"radian // \\\" radian\");"), "int a;  \nf();");
  std::string anyRetired = "\\b(";
  for (const std::string& word : retired) anyRetired += word + "|";
  anyRetired.back() = ')';
  const std::regex words(anyRetired + "\\b");
  EXPECT_TRUE(std::regex_search("if (" + retired.front() + "(trials))", words));
  EXPECT_FALSE(std::regex_search("measures" + retired.front(), words));
  for (const std::string folder : {"libinfo", "libbio", "apps"}) {
    for (const std::string& file : sourcesBelow(folder)) {
      std::smatch found;
      const std::string code = codeOf(contentOf(sourceTree / file));
      EXPECT_FALSE(std::regex_search(code, found, words)) << file << " names " << found.str();
    }
  }
}

TEST(SourceTree, NoFolderHoldsMoreThanThirtyFiles) {
  for (const std::string& folder : folders) {
    std::map<fs::path, int> files;
    for (const std::string& file : sourcesBelow(folder)) ++files[fs::path(file).parent_path()];
    for (const auto& [place, number] : files) EXPECT_LE(number, 30) << place;
  }
}

TEST(SourceTree, NoFileIsLongerThan400LinesAndNoFunctionThan100) {
  if (!fs::exists("/usr/bin/python3")) GTEST_SKIP() << "structure_report needs Python";
  const auto result =
      support::runProgram({(sourceTree / "tests/structure_report").string()}, sourceTree);
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr("0 files of over 400 lines"));
  EXPECT_THAT(result.out, testing::HasSubstr("0 functions of over 100 lines"));
}

TEST(SourceTree, ALongFileALongFunctionAndACrowdedFolderAreReported) {
  if (!fs::exists("/usr/bin/python3")) GTEST_SKIP() << "structure_report needs Python";
  const support::ScratchFolder scratch;
  for (const std::string& folder : folders) {
    fs::create_directory(scratch / folder);
    scratch.file(folder + "/good.cc", "int f() {\n  return 1;\n}\n");
  }
  const auto statusWith = [&](const std::string& file, const std::string& text) {
    if (!file.empty()) scratch.file(file, text);
    const int status =
        support::runProgram(
            {(sourceTree / "tests/structure_report").string(), scratch.path().string()}, sourceTree)
            .status;
    if (!file.empty()) fs::remove(scratch / file);
    return status;
  };
  const auto lines = [](int number) {
    std::string text;
    for (int i = 0; i < number; ++i) text += "  int a;\n";
    return text;
  };
  EXPECT_EQ(statusWith("", ""), 0);
  EXPECT_EQ(statusWith("apps/long.cc", "struct A {\n" + lines(398) + "};\n"), 0);
  EXPECT_EQ(statusWith("apps/long.cc", "struct A {\n" + lines(399) + "};\n"), 1);
  EXPECT_EQ(statusWith("apps/long.cc", "void f() {\n" + lines(98) + "}\n"), 0);
  EXPECT_EQ(statusWith("apps/long.cc", "void f() {\n" + lines(99) + "}\n"), 1);
  for (int i = 0; i < 30; ++i) scratch.file("apps/f" + std::to_string(i) + ".h", "");
  EXPECT_EQ(statusWith("", ""), 1);
}

support::ProgramResult folderOrder(const fs::path& tree) {
  return support::runProgram({(sourceTree / "tests/folder_order").string(), tree.string()},
                             sourceTree);
}

TEST(SourceTree, FoldersFormTheOrderOfContributing) {
  if (!fs::exists("/usr/bin/python3")) GTEST_SKIP() << "folder_order needs Python";
  const auto result = folderOrder(sourceTree);
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_EQ(result.out, "0 faults\n");
}

TEST(SourceTree, AnIncludeUpwardsAndAFolderOutsideTheOrderAreReported) {
  if (!fs::exists("/usr/bin/python3")) GTEST_SKIP() << "folder_order needs Python";
  const support::ScratchFolder scratch;
  const auto put = [&](const std::string& name, const std::string& text) {
    fs::create_directories((scratch / name).parent_path());
    scratch.file(name, text);
  };
  const auto faultsWith = [&](const std::string& name, const std::string& text) {
    put(name, text);
    const auto result = folderOrder(scratch.path());
    fs::remove(scratch / name);
    EXPECT_EQ(result.status, 1) << name;
    return result.out;
  };
  put("CONTRIBUTING.md",
      "- `libinfo`: `low`, `high`, `robots`\n- `libbio`: `low`, `high`, `view`\n"
      "- `apps`: `low`, `high`\n");
  put("libinfo/include/info/low/a.h", "");
  put("libinfo/include/info/high/a.h", "#include \"info/low/a.h\"\n#include \"info/high/b.h\"\n");
  put("libinfo/include/info/ground.h", "");
  put("libinfo/src/low/c.cc", "#include \"info/ground.h\"\n");
  put("libinfo/robots/src/a.cc", "#include \"info/high/a.h\"\n");
  put("libbio/include/bio/low/a.h", "");
  put("libbio/include/bio/high/a.h", "#include <bio/low/a.h>\n");
  put("libbio/src/low/b.h", "#include \"model.h\"\n");
  put("libbio/view/a.h", "#include \"bio/high/a.h\"\n");
  put("apps/low/a.h", "");
  put("apps/high/a.h", "#include \"low/a.h\"\n#include <vector>\n");
  EXPECT_EQ(folderOrder(scratch.path()).out, "0 faults\n");
  EXPECT_EQ(faultsWith("libinfo/src/low/b.cc", "#include \"info/high/a.h\"\n"),
            "libinfo/src/low/b.cc: info/high/a.h points up, from low to high\n1 faults\n");
  EXPECT_EQ(faultsWith("libinfo/src/version.cc", "#include \"info/low/a.h\"\n"),
            "libinfo/src/version.cc: info/low/a.h points up, from libinfo to low\n1 faults\n");
  EXPECT_EQ(faultsWith("libbio/src/low/a.cc", "#include <bio/high/a.h>\n"),
            "libbio/src/low/a.cc: bio/high/a.h points up, from low to high\n1 faults\n");
  EXPECT_EQ(faultsWith("libbio/src/high/a.cc", "#include \"view/a.h\"\n"),
            "libbio/src/high/a.cc: view/a.h points up, from high to view\n1 faults\n");
  EXPECT_EQ(faultsWith("apps/low/a.cc", "#include \"../high/a.h\"\n"),
            "apps/low/a.cc: ../high/a.h points up, from low to high\n1 faults\n");
  EXPECT_EQ(faultsWith("apps/new/a.cc", ""),
            "apps/new/a.cc: folder new is not in the order of CONTRIBUTING.md\n1 faults\n");
  fs::remove(scratch / "apps/high/a.h");
  EXPECT_EQ(folderOrder(scratch.path()).out,
            "apps: no files in folder high, which the order of CONTRIBUTING.md names\n1 faults\n");
}

TEST(SourceTree, CmakeNamesEveryFileButEffectsAndThoseOfTheProgram) {
  const std::map<std::string, std::string> found = {
      {"apps", "RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} */*.cc)"},
      {"libbio", " src/discovery/effects/*.cc)"}};
  for (const std::string& folder : folders) {
    int lists = 0;
    for (const auto& entry : entriesBelow(folder)) {
      if (entry.path().filename() != "CMakeLists.txt") continue;
      const std::string text = contentOf(entry.path());
      const std::size_t at = text.find("file(GLOB");
      const auto allowed = found.find(fs::relative(entry.path().parent_path(), sourceTree));
      if (allowed != found.end()) {
        const std::string line = text.substr(at, text.find('\n', at) - at);
        EXPECT_THAT(line, testing::HasSubstr(" CONFIGURE_DEPENDS "));
        EXPECT_TRUE(line.ends_with(allowed->second)) << line;
        EXPECT_EQ(text.find("file(GLOB", at + 1), text.npos) << folder;
      } else {
        EXPECT_EQ(at, text.npos) << entry.path();
      }
      ++lists;
    }
    EXPECT_GT(lists, 0) << folder;
  }
}

// The fuzzed programs link a list of readers of their own, last in `.ci/run`: what it lacks shows
// up an hour later there.
TEST(SourceTree, FuzzedReadersNameEveryReaderOfModelsAndRecordings) {
  const std::string listed = contentOf(sourceTree / "tests/fuzz/CMakeLists.txt");
  int readers = 0;
  for (const std::string folder : {"opensim", "tables/formats", "robot_description"})
    for (const auto& entry : fs::directory_iterator(sourceTree / "libbio/src" / folder))
      if (entry.path().extension() == ".cc") {
        EXPECT_THAT(listed, testing::HasSubstr(folder + "/" + entry.path().filename().string()));
        ++readers;
      }
  EXPECT_GT(readers, 40);
}

}  // namespace
