#include "bio/tables/table_text.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bio/tables/file_error.h"
#include "support/scratch_folder.h"

namespace bio {
namespace {

TEST(TableText, IsWhatIsWritten) {
  Table table;
  table.columns = {"time", "BRA"};
  table.values.resize(2, 2);
  table.values << 0, 0.1, 0.01, std::nan("");
  table.metadata["known_mass_in_hand_kg"] = "1";
  const support::ScratchFolder scratch;
  for (const char* name : {"a.sto", "a.csv"}) {
    const auto file = scratch / name;
    writeTable(table, file);
    EXPECT_EQ(tableText(table, file), support::contentOf(file));
  }
  EXPECT_EQ(tableText(table, "a.csv"), "time,BRA\n0,0.1\n0.01,\n");
  table.columns.pop_back();
  EXPECT_THROW(tableText(table, "a.csv"), FileError);
}

}  // namespace
}  // namespace bio
