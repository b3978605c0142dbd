#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <regex>
#include <set>

#include "support/scratch_folder.h"

// The rules of the architecture that can be read off the source tree.
namespace {

namespace fs = std::filesystem;
using support::contentOf;

const fs::path sourceTree = FISHERHILL_SOURCE_DIR;

/// Every source file below a folder, with its path from the top.
std::vector<std::string> sourcesBelow(const std::string& folder) {
  std::vector<std::string> files;
  EXPECT_TRUE(fs::is_directory(sourceTree / folder)) << "no folder " << folder;
  if (!fs::exists(sourceTree / folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(sourceTree / folder)) {
    const std::string extension = entry.path().extension();
    if (extension == ".h" || extension == ".cc") {
      files.push_back(fs::relative(entry.path(), sourceTree).string());
    }
  }
  return files;
}

const std::vector<std::string> folders = {"libinfo",    "libbio", "apps",  "tests",
                                          "validation", "bench",  "python"};

void expectIncludesOnly(const std::string& pattern,
                        const std::function<bool(const std::string&)>& mayInclude) {
  const std::regex include("#include [<\"](" + pattern + ")");
  for (const std::string& folder : folders) {
    for (const std::string& file : sourcesBelow(folder)) {
      const std::string text = contentOf(sourceTree / file);
      std::smatch match;
      if (!mayInclude(file) && std::regex_search(text, match, include)) {
        ADD_FAILURE() << file << " includes " << match[1];
      }
    }
  }
}

TEST(SourceTree, LibinfoKnowsNoBiology) {
  expectIncludesOnly("bio/|Simbody|SimTK|tinyxml2", [](const std::string& file) {
    return !file.starts_with("libinfo/") && !file.starts_with("tests/libinfo/");
  });
}

TEST(SourceTree, SimbodyIsHiddenInTheSkeleton) {
  expectIncludesOnly("Simbody|SimTK", [](const std::string& file) {
    return file.starts_with("libbio/src/") || file.starts_with("tests/");
  });
}

TEST(SourceTree, OnlyTheViewKnowsVtk) {
  expectIncludesOnly("vtk", [](const std::string& file) {
    return file.starts_with("libbio/view/") || file.starts_with("tests/libbio/view");
  });
}

TEST(SourceTree, OnlyTheProgramReadsCommandLines) {
  expectIncludesOnly("CLI/", [](const std::string& file) {
    return file.starts_with("apps/") || file.starts_with("tests/apps/");
  });
}

TEST(SourceTree, EveryPublicHeaderIsInItsLibrarysHeaderFileSet) {
  for (const std::string top : {"libinfo/", "libinfo/robots/", "libbio/"}) {
    const std::string cmake = contentOf(sourceTree / top / "CMakeLists.txt");
    for (const std::string& header : sourcesBelow(top + "include")) {
      EXPECT_THAT(cmake, testing::HasSubstr("  " + header.substr(top.size()) + "\n"));
    }
  }
}

TEST(SourceTree, EveryTestProgramIsBuilt) {
  for (const std::string& file : sourcesBelow("tests")) {
    if (!file.ends_with("_test.cc")) continue;
    fs::path lists = fs::path(file).parent_path();
    while (!fs::exists(sourceTree / lists / "CMakeLists.txt")) lists = lists.parent_path();
    EXPECT_THAT(contentOf(sourceTree / lists / "CMakeLists.txt"),
                testing::HasSubstr(fs::path(file).stem().string()));
  }
}

TEST(SourceTree, NoFolderIsADrawerForAnything) {
  const std::set<std::string> drawers = {"utils", "util", "common", "misc",
                                         "core",  "base", "helpers"};
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(sourceTree / folder)) {
      if (entry.is_directory()) {
        EXPECT_EQ(drawers.count(entry.path().filename()), 0u) << entry.path();
      }
    }
  }
}

TEST(SourceTree, NoFolderHoldsMoreThanThirtyFiles) {
  for (const std::string& folder : folders) {
    std::map<fs::path, int> files;
    for (const std::string& file : sourcesBelow(folder)) ++files[fs::path(file).parent_path()];
    EXPECT_FALSE(files.empty()) << folder;
    for (const auto& [place, number] : files) EXPECT_LE(number, 30) << place;
  }
}

TEST(SourceTree, CmakeNamesEveryFile) {
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(sourceTree / folder)) {
      if (entry.path().filename() != "CMakeLists.txt") continue;
      EXPECT_THAT(contentOf(entry.path()), testing::Not(testing::HasSubstr("file(GLOB")));
    }
  }
}

}  // namespace
