#include "row_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/scratch_folder.h"
#include "support/throws_saying.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;
using support::contentOf;

struct RowFiles : testing::Test {
  support::ScratchFolder scratch;
  Json settings = {{"seed", 1}, {"names", {"a", "b"}}, {"limit", 0.1}};
  std::vector<std::string> columns = {"draw", "x", "y"};
  std::filesystem::path path = scratch / "rows.csv";

  RowFile open(bool replace = false) { return {path, settings, columns, replace}; }
};

TEST_F(RowFiles, KeepsRowsInTheOrderOfTheirArrival) {
  {
    RowFile file = open();
    file.append(7, "1,2");
    file.append(3, ",4");
  }
  EXPECT_EQ(contentOf(path),
            "# {\"seed\":1,\"names\":[\"a\",\"b\"],\"limit\":0.1}\ndraw,x,y\n7,1,2\n3,,4\n");
  const RowFile again = open();
  EXPECT_EQ(again.rows(), (std::map<std::uint64_t, std::string>{{3, ",4"}, {7, "1,2"}}));
}

// A kill may end the file at any byte: complete rows are kept, the rest is dropped, and what is
// appended then makes the same table.
TEST_F(RowFiles, AFileCutOffAnywhereIsGoneOnWith) {
  const std::vector<std::string> texts = {"1,2", "3.5,", ",", "-7e-3,1"};
  {
    RowFile file = open();
    for (std::size_t i = 0; i < texts.size(); ++i) file.append(i, texts[i]);
  }
  const std::string whole = contentOf(path);
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    std::ofstream(path, std::ios::binary) << whole.substr(0, length);
    {
      RowFile file = open();
      std::size_t complete = 0, at = 0;
      while ((at = whole.find('\n', at)) < length) {
        ++complete;
        ++at;
      }
      ASSERT_EQ(file.rows().size(), complete < 2 ? 0 : complete - 2) << length;
      for (std::size_t i = 0; i < texts.size(); ++i) {
        if (!file.rows().contains(i)) file.append(i, texts[i]);
      }
    }
    ASSERT_EQ(contentOf(path), whole) << length;
  }
}

TEST_F(RowFiles, OtherSettingsAreRefusedByNameAndReplacedOnRequest) {
  {
    RowFile file = open();
    file.append(0, "1,2");
  }
  settings["seed"] = 2;
  support::throwsSaying([&] { open(); }, "other settings (seed is 1 there, 2 here); --force");
  EXPECT_NE(contentOf(path).find("0,1,2"), std::string::npos);
  EXPECT_TRUE(open(true).rows().empty());
  columns.push_back("z");
  support::throwsSaying([&] { open(); }, "other settings");
}

TEST_F(RowFiles, WhatIsNoSuchFileIsLeftAsItIs) {
  for (const char* content : {"time,x\n0,1\n", "# {\"seed\":\n", "# 3\n"}) {
    std::ofstream(path, std::ios::binary) << content;
    support::throwsSaying([&] { open(true); }, "is not the unfinished result of an ensemble");
    EXPECT_EQ(contentOf(path), content);
  }
}

TEST_F(RowFiles, ARowThatIsNoneNamesItsLine) {
  {
    RowFile file = open();
    file.append(0, "1,2");
  }
  for (const char* row : {"1,2", "x,1,2", ",1,2", "1 ,1,2", "1,2,3,4", ""}) {
    const std::string before = contentOf(path);
    std::ofstream(path, std::ios::binary | std::ios::app) << row << '\n';
    support::throwsSaying([&] { open(); }, "line 4 is not a row");
    std::ofstream(path, std::ios::binary) << before;
  }
}

TEST_F(RowFiles, ASecondWriterIsKeptAway) {
  const RowFile first = open();
  support::throwsSaying([&] { open(); }, "another program is at work on it");
}

TEST_F(RowFiles, WithoutAPathRowsAreKeptInMemoryAlone) {
  RowFile file({}, settings, columns, false);
  file.append(1, "2,3");
  file.remove();
  EXPECT_EQ(file.rows().at(1), "2,3");
  EXPECT_TRUE(scratch.listing().empty());
}

}  // namespace
}  // namespace app
