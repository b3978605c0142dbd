#include "bio/tables/table_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "bio/tables/file_error.h"
#include "support/scratch_folder.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class TableFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    return folder_.file(name, text);
  }
  // The one line with which reading the text fails, without the folder.
  std::string messageOf(const std::string& name, const std::string& text,
                        TableKind kind = TableKind::timeSeries) const {
    try {
      readTable(write(name, text), kind);
    } catch (const FileError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      EXPECT_TRUE(what.starts_with(folder_.path().string())) << what;
      return what.substr(folder_.path().string().size() + 1);
    }
    return "read without complaint";
  }
  support::ScratchFolder folder_;
};

const std::string header = "trial\nversion=1\nnRows=2\nnColumns=3\ninDegrees=no\nendheader\n";

TEST_F(TableFile, ReadsAStorageFileAndItsHeader) {
  const Table table =
      readTable(write("a.sto",
                      "trial\nversion=1\nnRows=2\nnColumns=3\ninDegrees=yes\nsubject=7\nendheader\n"
                      "time\tBRA\telbow_flexion\n0.0\t0.1\t\n1e-2\t+0.2\tNaN\n"));
  EXPECT_EQ(table.name, "trial");
  EXPECT_TRUE(table.inDegrees);
  EXPECT_EQ(table.metadata.at("subject"), "7");
  EXPECT_THAT(table.columns, ElementsAre("time", "BRA", "elbow_flexion"));
  EXPECT_EQ(table.values(1, 0), 0.01);
  EXPECT_EQ(table.values(1, 1), 0.2);
  EXPECT_TRUE(std::isnan(table.values(0, 2)));
  EXPECT_TRUE(std::isnan(table.values(1, 2)));
  EXPECT_EQ(timesOf(table)(1), 0.01);
}

TEST_F(TableFile, ReadsCommasQuotesAndWindowsLines) {
  const Table table =
      readTable(write("a.csv", "\xEF\xBB\xBF\"time\", BRA\r\n0, 0.5\r\n1,\r\n\r\n"));
  EXPECT_THAT(table.columns, ElementsAre("time", "BRA"));
  EXPECT_EQ(table.values(0, 1), 0.5);
  EXPECT_TRUE(std::isnan(table.values(1, 1)));
}

// A name that begins with a space would be read back without it.
TEST_F(TableFile, ByteOrderMarksAtTheStartAreNoPartOfANameAndAreNotWritten) {
  const std::string mark = "\xEF\xBB\xBF", rows = "endheader\ntime\tBRA\n0\t0.5\n";
  EXPECT_EQ(readTable(write("a.sto", mark + mark + "trial\n" + rows)).name, "trial");
  EXPECT_THAT(messageOf("b.sto", mark + mark + rows), HasSubstr("read without complaint"));
  for (const char* name : {"c.sto", "c.csv"}) {
    Table table = readTable(write("d.sto", "trial\n" + rows));
    table.name = mark + "endheader";
    EXPECT_THROW(writeTable(table, folder_ / name), FileError);
    table.name = "trial";
    table.columns[0] = mark + "time";
    EXPECT_THROW(writeTable(table, folder_ / name), FileError);
  }
}

TEST_F(TableFile, NamesHaveNoSpaceAtTheirEnds) {
  const Table table = readTable(write("t.csv", "\"time\",\"  heart rate \"\n0,70\n"));
  EXPECT_THAT(table.columns, ElementsAre("time", "heart rate"));
  Table other = table;
  other.columns[1] = " heart rate";
  EXPECT_THROW(writeTable(other, folder_.path() / "o.sto"), FileError);
  writeTable(table, folder_.path() / "o.sto");
  EXPECT_EQ(readTable(folder_.path() / "o.sto").columns, table.columns);
}

TEST_F(TableFile, ReadsOldMotionFilesSeparatedBySpaces) {
  const Table table = readTable(write(
      "a.mot",
      "curl\ndatacolumns 2\ndatarows 2\nrange 0 1\nendheader\n time  BRA \n 0.0  1\n 1.0  2\n"));
  EXPECT_EQ(table.values(1, 1), 2);
  EXPECT_EQ(table.metadata.at("range"), "0 1");
}

TEST_F(TableFile, NeedsNoTimeWhereNoneIsAskedFor) {
  EXPECT_EQ(readTable(write("a.csv", "q,r\n1,2\n1,3\n"), TableKind::any).values(1, 1), 3);
}

TEST_F(TableFile, GivesBackEveryNumberItWrote) {
  Table table;
  table.name = "states";
  table.inDegrees = true;
  table.metadata = {{"subject", "7"}};
  table.columns = {"time", "/jointset/elbow/elbow_flexion/value"};
  table.values.resize(3, 2);
  table.values << 0, 1.0 / 3, 0.1, std::numeric_limits<double>::denorm_min(), 0.2, -1e300;
  for (const char* name : {"b.sto", "b.csv"}) {
    writeTable(table, folder_ / name);
    const Table again = readTable(folder_ / name);
    EXPECT_EQ(again.columns, table.columns);
    EXPECT_EQ(again.values, table.values) << name;
  }
  const Table sto = readTable(folder_ / "b.sto");
  EXPECT_EQ(sto.name, "states");
  EXPECT_TRUE(sto.inDegrees);
  EXPECT_EQ(sto.metadata.at("subject"), "7");
}

TEST_F(TableFile, KeepsNotMeasuredCellsNotMeasured) {
  Table table;
  table.columns = {"time", "q"};
  table.values.resize(1, 2);
  table.values << 0, std::nan("");
  for (const char* name : {"b.sto", "b.csv"}) {
    writeTable(table, folder_ / name);
    EXPECT_TRUE(std::isnan(readTable(folder_ / name).values(0, 1)));
  }
}

TEST_F(TableFile, LeavesTheOldFileWhenItCannotWrite) {
  write("b.csv", "old");
  Table table;
  table.columns = {"time", "q"};
  table.values.resize(1, 2);
  table.values << 0, std::numeric_limits<double>::infinity();
  EXPECT_THROW(writeTable(table, folder_ / "b.csv"), FileError);
  EXPECT_THROW(writeTable(table, folder_ / "missing" / "b.csv"), FileError);
  EXPECT_EQ(support::contentOf(folder_ / "b.csv"), "old");
  EXPECT_THAT(folder_.listing(), ElementsAre("b.csv"));
}

TEST_F(TableFile, NamesAColumnThatIsNotThere) {
  const Table table = readTable(write("a.csv", "time,BRA\n0,1\n"));
  support::throwsSaying([&] { columnIndex(table, "BRD"); },
                        "the table has no column 'BRD' (it has: time, BRA)");
}

TEST_F(TableFile, SaysInOneLineWhatIsWrong) {
  EXPECT_EQ(messageOf("a.csv", "time,BRA\n0,1\n1,x\n"),
            "a.csv:3: column 'BRA': value = 'x', must be a number");
  EXPECT_EQ(messageOf("a.csv", "time,BRA\n0,1 2\n"),
            "a.csv:2: column 'BRA': value = '1 2', must be a number");
  EXPECT_EQ(messageOf("a.csv", "time,BRA\n0,inf\n"),
            "a.csv:2: column 'BRA': value = inf, must be finite, or empty for not measured");
  EXPECT_EQ(messageOf("a.csv", "time,BRA\n0,1\n0,2\n"),
            "a.csv:3: time = 0 s after 0 s, must rise strictly");
  EXPECT_EQ(messageOf("a.csv", "time,BRA\n0,1\n,2\n"), "a.csv:3: time = '', must be a number");
  EXPECT_EQ(messageOf("a.csv", "time,BRA\n0,1\nnan,2\n"),
            "a.csv:3: time = 'nan', must be a number");
  EXPECT_EQ(messageOf("a.csv", "t,BRA\n0,1\n"),
            "a.csv:1: has no column 'time', must have one, in s or with its unit, 'time [ms]'");
  EXPECT_EQ(messageOf("a.csv", "time,BRA,BRA\n0,1,2\n"),
            "a.csv:1: second column called 'BRA', names must be unique");
  EXPECT_EQ(messageOf("a.csv", "time,,BRA\n0,1,2\n"),
            "a.csv:1: column 2 has no name, must have one");
  EXPECT_EQ(messageOf("a.csv", "time,BRA\n0,1\n1\n"),
            "a.csv:3: row has 1 cells, must have 2 as there are columns");
  EXPECT_EQ(messageOf("a.csv", "time,BRA\n0,1,7\n"),
            "a.csv:2: row has 3 cells, must have 2 as there are columns");
  EXPECT_EQ(messageOf("a.csv", "time,BRA\n"), "a.csv:1: holds no rows, must hold at least one");
  EXPECT_EQ(messageOf("a.csv", " \n"), "a.csv: is empty, must be a table");
  EXPECT_EQ(messageOf("a.csv", ""), "a.csv: is empty, must be a table");
  EXPECT_EQ(messageOf("a.sto", header + "time\tA\tB\n0\t1\t2\n"),
            "a.sto:8: 1 rows, the header promises 2");
  EXPECT_EQ(messageOf("a.sto", header + "time\tA\n0\t1\n"),
            "a.sto:7: 2 column names, the header promises 3");
  EXPECT_EQ(messageOf("a.sto", "trial\ntime\tA\n0\t1\n"),
            "a.sto:3: the header has no line 'endheader', must end with one");
  EXPECT_EQ(messageOf("a.sto", "trial\nnRows=many\nendheader\n"),
            "a.sto:2: header: nRows = 'many', must be a whole number ≥ 0");
  EXPECT_EQ(messageOf("a.sto", "trial\ninDegrees=maybe\nendheader\n"),
            "a.sto:2: header: inDegrees = 'maybe', must be yes or no");
  EXPECT_EQ(messageOf("a.sto", "trial\nDataType=Vec3\nendheader\n"),
            "a.sto:2: header: DataType = 'Vec3', must be double");
  EXPECT_EQ(messageOf("a.sto", "trial\nendheader\n"),
            "a.sto:2: holds no column names, must hold a row of them");
  EXPECT_THAT([&] { readTable(folder_ / "none.csv"); },
              testing::ThrowsMessage<FileError>(HasSubstr("none.csv: there is no such file")));
  EXPECT_THAT([&] { readTable(folder_.path()); },
              testing::ThrowsMessage<FileError>(HasSubstr("is a directory, must be a file")));
}

TEST_F(TableFile, ReadsTablesAsLaboratoriesWriteThem) {
  for (const char* text :
       {"time;BRA;note\n0,00;0,1;7\n0,25;0,2;\n",                          // decimal commas
        "sep=;\r\ntime;BRA;note\r\n0.00;0.1;7\r\n0.25;0.2;\r\n",           // Excel's first line
        "time\tBRA\tnote\n0,00\t0,1\t7\n0,25\t0,2\t\n",                    // between tabs
        "\xEF\xBB\xBFTime,BRA,note\n0,0.1,7\n0.25,0.2,\n",                 // byte order mark
        "TIME,BRA,note\r0,0.1,7\r0.25,0.2,\r",                             // old line ends
        "time [ms];BRA;note\n0;0,1;7\n250;0,2;\n\n\n",                     // unit, blank lines
        "Time_ms,BRA,note,,\n0,0.1,7,,\n250,0.2,,,\n,,,,\n,,,,\n",         // blank cells
        "BRA,time (s),note\n0.1,0,7\n0.2,0.25,\n",                         // any place
        "\"Time,us\";\"BRA\";\"note\"\n\"0,0\";\"0,1\";7\n250000;0,2;\n",  // quoted commas
        "X[s],BRA,note\n0,0.1,7\n0.25,0.2,\n"}) {                          // Delsys
    const Table table = readTable(write("l.csv", text));
    EXPECT_EQ(timesOf(table)(0), 0) << text;
    EXPECT_EQ(timesOf(table)(1), 0.25) << text;
    EXPECT_EQ(table.values.rows(), 2) << text;
    EXPECT_EQ(table.values(1, columnIndex(table, "BRA")), 0.2) << text;
    EXPECT_EQ(table.values(0, columnIndex(table, "note")), 7) << text;
    EXPECT_TRUE(std::isnan(table.values(1, columnIndex(table, "note")))) << text;
  }
  // the plain name wins, others stay what they are
  EXPECT_THAT(readTable(write("t.csv", "Time,time\n5,0\n5,1\n")).columns,
              ElementsAre("Time", "time"));
  EXPECT_EQ(readTable(write("m.csv", "time (min),BRA\n0,1\n0.5,1\n")).values(1, 0), 30);
}

TEST_F(TableFile, SaysWhatToDoWithTablesThatAreOdd) {
  const auto refused = [&](const std::string& text, const std::string& line) {
    EXPECT_EQ(messageOf("a.csv", text), "a.csv" + line) << text;
  };
  refused(std::string("\xFF\xFEt\0i\0", 6),
          ": is UTF-16, must be UTF-8 (save it as CSV UTF-8, or: iconv -f UTF-16 -t UTF-8)");
  refused(std::string("\0t\0i\0m", 6),
          ": is UTF-16, must be UTF-8 (save it as CSV UTF-8, or: iconv -f UTF-16 -t UTF-8)");
  refused(std::string("time,B\n0,\0", 10),
          ": holds bytes that are no text, must be a table in UTF-8");
  refused(
      "time,BRA\n0,00,0,1\n",
      ":2: row has 4 cells, must have 2 as there are columns (decimal commas need semicolons or "
      "tabs between cells)");
  refused("time,BRA\n0,\"0,1\"\n",
          ":2: column 'BRA': value = '0,1', must have a decimal point (decimal commas need "
          "semicolons or tabs between cells)");
  refused("time;BRA\n0,5;0.1\n",
          ":2: column 'BRA': value = '0.1', must have a decimal comma as the cells before");
  refused("time;BRA\n0.5;0,1\n",
          ":2: column 'BRA': value = '0,1', must have a decimal point as the cells before");
  refused("time;F\n0;1.234,5\n",
          ":2: column 'F': value = '1.234,5', must be a number without thousands separators");
  refused("time;F\n0;1,234,567\n",
          ":2: column 'F': value = '1,234,567', must be a number without thousands separators");
  refused("time;F\n0;7\n1;1,234\n2;12,345\n",
          ":3: '1,234' and all such numbers could have a decimal comma or a comma between "
          "thousands, must be written with a decimal point or other digits");
  refused("time;a,b\n0,1;2\n",
          ":1: commas, semicolons or tabs could separate the names, must be one of them (quote "
          "names that hold another)");
  refused("time [frames],F\n0,1\n",
          ":1: column 'time [frames]': unit 'frames', must be s, ms, us or min for a time");
  refused("Time,time_ms\n0,1\n", ":1: 'Time' and 'time_ms' are times, must be one");
  refused("time,F\ns,N\n0,1\n",
          ":2: 's' and every other cell is no number, must be one (a second row of names or units? "
          "delete it and write units into the names, 'time [ms]')");
  refused("time,F,\n0,1,\n1,1,5\n", ":3: column 3 has values but no name, must have one");
  refused("time,F\n0,1\n,\n1,1\n", ":3: time = '', must be a number");
}

}  // namespace
}  // namespace bio
