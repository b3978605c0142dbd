#include "output/resumable_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <optional>
#include <thread>

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
  EXPECT_THAT(contentOf(path),
              testing::MatchesRegex("# ..seed.:1,.names.:..a.,.b..,.limit.:0.1.\ndraw,x,y,checksum"
                                    "\n7,1,2,[0-9a-f]{8}\n3,,4,[0-9a-f]{8}\n"));
  const RowFile again = open();
  EXPECT_EQ(again.count(), 2u);
  EXPECT_EQ(again.row(3), ",4");
  EXPECT_EQ(again.row(7), "1,2");
  EXPECT_FALSE(again.contains(0));
  EXPECT_THROW(again.row(0), std::out_of_range);
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
      ASSERT_EQ(file.count(), complete < 2 ? 0 : complete - 2) << length;
      for (std::size_t i = 0; i < texts.size(); ++i) {
        if (!file.contains(i)) file.append(i, texts[i]);
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
  EXPECT_EQ(open(true).count(), 0u);
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

// Wherever one byte of a row is another one, the row counts as not computed, and the others stand.
TEST_F(RowFiles, ADamagedRowIsNotBelieved) {
  {
    RowFile file = open();
    file.append(10, "1.25,2");
    file.append(11, "3,4");
  }
  const std::string whole = contentOf(path);
  const std::size_t row = whole.find("10,1.25");
  for (std::size_t at = row; at < whole.find('\n', row); ++at) {
    std::string changed = whole;
    changed[at] = changed[at] == '7' ? '8' : '7';
    std::ofstream(path, std::ios::binary) << changed;
    {
      RowFile file = open();
      EXPECT_EQ(file.damaged(), 1u) << at;
      EXPECT_FALSE(file.contains(10)) << at;
      EXPECT_EQ(file.row(11), "3,4");
      file.append(10, "1.25,2");
    }
    EXPECT_EQ(open().row(10), "1.25,2");
  }
  for (const char* line : {"1,2", "x,1,2", ",1,2", "1 ,1,2", "1,2,3,4", ""}) {
    std::ofstream(path, std::ios::binary) << whole << line << '\n';
    const RowFile file = open();
    EXPECT_EQ(file.damaged(), 1u) << line;
    EXPECT_EQ(file.count(), 2u) << line;
  }
}

TEST_F(RowFiles, AFileWithoutChecksumsIsOfAnEarlierVersion) {
  const std::string old = "# " + settings.dump() + "\ndraw,x,y\n0,1,2\n";
  std::ofstream(path, std::ios::binary) << old;
  support::throwsSaying([&] { open(); }, "earlier version, whose rows have no checksum; --force");
  EXPECT_EQ(contentOf(path), old);
  EXPECT_EQ(open(true).count(), 0u);
}

// A row is longer than what is read at once.
TEST_F(RowFiles, ALongRowIsReadWhole) {
  const std::string text = std::string(9000, '1') + "," + std::string(3000, '2');
  RowFile file = open();
  file.append(0, text);
  file.append(1, "1,2");
  EXPECT_EQ(file.row(0), text);
  EXPECT_EQ(file.row(1), "1,2");
}

TEST_F(RowFiles, ASecondWriterIsKeptAway) {
  const RowFile first = open();
  support::throwsSaying([&] { open(); }, "is in use by another program");
}

// A killed program has its lock until the system has taken it away.
TEST_F(RowFiles, TheLockOfADyingWriterIsWaitedFor) {
  std::optional<RowFile> first(std::in_place, path, settings, columns, false);
  first->append(0, "1,2");
  std::thread death([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    first.reset();
  });
  EXPECT_EQ(open().row(0), "1,2");
  death.join();
}

TEST_F(RowFiles, WithoutAPathRowsAreKeptInMemoryAlone) {
  RowFile file({}, settings, columns, false);
  file.append(1, "2,3");
  file.remove();
  EXPECT_EQ(file.row(1), "2,3");
  EXPECT_TRUE(scratch.listing().empty());
}

}  // namespace
}  // namespace app
