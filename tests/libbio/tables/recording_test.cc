#include "bio/tables/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "bio/tables/file_error.h"

namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

// A file of this test, removed with it.
class Recordings : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& name, const std::string& text) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  void fails(const std::string& path, const bio::RecordingLayout& layout, const std::string& text) {
    EXPECT_THAT([&] { bio::readRecording(path, layout); },
                ThrowsMessage<bio::FileError>(HasSubstr(text)));
  }

 private:
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                  (std::string("fisherhill_recording_") +
                                   testing::UnitTest::GetInstance()->current_test_info()->name());
};

bio::ColumnDeclaration column(int number, const std::string& name, double rate,
                              const std::string& unit) {
  bio::ColumnDeclaration out;
  out.number = number;
  out.name = name;
  out.rate = rate;
  out.unit = unit;
  return out;
}

const char* const trigno =
    "Application:, Trigno Discover (1.6.5)\r\nDate/Time:, 1\r\nCollection Length (seconds):, "
    "0.01\r\n"
    "wrist (11), , bicep (22)\r\nsensor mode: 609, , sensor mode: 40\r\n"
    "ACC X (G), GYRO X (deg/s), EMG 1 (mV)\r\n370.3704 Hz, 370.3704 Hz, 2148.1481 Hz\r\n"
    "1, 2, 0.5\r\n1.5, , -0.25\r\n, , 0.125\r\n";

TEST_F(Recordings, ReadsColumnsOfDifferentLengthAndRateWithoutAHeader) {
  const std::string path =
      file("a.txt", "12\t-2571\t31\t\r\n141\t-2570\t31\t\r\n24\t\t31\t\r\n99\t\t\t\r\n\t\t\t\r\n");
  EXPECT_EQ(bio::detectFormat(path), bio::RecordingFormat::columns);
  bio::RecordingLayout layout;
  layout.columns = {column(1, "biceps", 1000, "mV"), column(2, "angle", 50, "counts")};
  layout.columns[0].scale = 0.5;
  layout.columns[0].offset = 1;
  const bio::Recording r = bio::readRecording(path, layout);
  ASSERT_EQ(r.channels.size(), 2u);
  const bio::Channel& biceps = bio::findChannel(r, "biceps");
  EXPECT_EQ(biceps.values, Eigen::Vector4d(7, 71.5, 13, 50.5));
  EXPECT_EQ(biceps.rate, 1000);
  EXPECT_EQ(biceps.unit, "mV");
  EXPECT_DOUBLE_EQ(bio::endTime(biceps), 0.003);
  EXPECT_EQ(bio::findChannel(r, "angle").values, Eigen::Vector2d(-2571, -2570));
  EXPECT_THAT(r.remarks, testing::ElementsAre(HasSubstr("Column 3 is not declared")));
}

TEST_F(Recordings, KeepsAGapInsideAColumnAsNotMeasured) {
  bio::RecordingLayout layout;
  layout.columns = {column(2, "x", 10, "mV")};
  const bio::Recording r = bio::readRecording(file("a.txt", "1,5\n2,\n3,7\n"), layout);
  EXPECT_EQ(r.channels[0].values[0], 5);
  EXPECT_TRUE(std::isnan(r.channels[0].values[1]));
  EXPECT_EQ(r.channels[0].values[2], 7);
}

TEST_F(Recordings, ReadsColumnsSeparatedByAnyWhiteSpaceOrSemicolons) {
  bio::RecordingLayout layout;
  layout.columns = {column(2, "x", 10, "mV")};
  EXPECT_EQ(bio::readRecording(file("a.txt", "  1   5e-1\n  2  -7\n"), layout).channels[0].values,
            Eigen::Vector2d(0.5, -7));
  EXPECT_EQ(bio::readRecording(file("b.txt", "1;5\n2;+7\n"), layout).channels[0].values,
            Eigen::Vector2d(5, 7));
}

TEST_F(Recordings, ReadsATrignoExportWithARatePerColumn) {
  const std::string path = file("t.csv", trigno);
  EXPECT_EQ(bio::detectFormat(path), bio::RecordingFormat::trigno);
  const bio::Recording r = bio::readRecording(path);
  ASSERT_EQ(r.channels.size(), 2u);  // the gyroscope's one value is no signal
  const bio::Channel& emg = bio::findChannel(r, "bicep EMG 1");
  EXPECT_EQ(emg.values, Eigen::Vector3d(0.5, -0.25, 0.125));
  EXPECT_EQ(emg.rate, 2148.1481);
  EXPECT_EQ(emg.unit, "mV");
  EXPECT_EQ(bio::findChannel(r, "wrist ACC X").unit, "g");
  EXPECT_THAT(r.remarks, testing::ElementsAre(HasSubstr("GYRO X")));
}

TEST_F(Recordings, RenamesAndRescalesAHeadedColumnByItsHeader) {
  bio::RecordingLayout layout;
  bio::ColumnDeclaration emg;
  emg.header = "bicep EMG 1";
  emg.name = "biceps";
  emg.unit = "uV";
  emg.scale = 1000;
  layout.columns = {emg};
  const bio::Recording r = bio::readRecording(file("t.csv", trigno), layout);
  EXPECT_EQ(bio::findChannel(r, "biceps").values[0], 500);
  EXPECT_EQ(bio::findChannel(r, "biceps").unit, "uV");
  layout.columns[0].scale.reset();
  EXPECT_DOUBLE_EQ(
      bio::findChannel(bio::readRecording(file("t.csv", trigno), layout), "biceps").values[0],
      500);  // converted from the file's mV
  layout.columns[0].unit = "deg";
  fails(file("t.csv", trigno), layout, "declared unit 'deg', but the file says 'mV'");
  layout.columns[0].unit = "mV";
  layout.columns[0].rate = 1000;
  fails(file("t.csv", trigno), layout, "declared rate 1000 Hz, but the file says 2148.1481 Hz");
}

TEST_F(Recordings, ReadsATableWithUnitsInItsNamesAndASparserColumnAtItsOwnRate) {
  std::string text = "time,biceps_uV,elbow_flexion_deg\n";
  for (int i = 0; i < 9; ++i) {
    text += std::to_string(0.001 * i + 2) + "," + std::to_string(i) + "," +
            (i % 3 == 1 && i != 4 ? std::to_string(10 * i) : "") + "\n";
  }
  const std::string path = file("t.csv", text);
  EXPECT_EQ(bio::detectFormat(path), bio::RecordingFormat::table);
  const bio::Recording r = bio::readRecording(path);
  const bio::Channel& emg = bio::findChannel(r, "biceps_uV");
  EXPECT_EQ(emg.unit, "uV");
  EXPECT_EQ(emg.rate, 1000);
  EXPECT_DOUBLE_EQ(emg.startTime, 2);
  EXPECT_EQ(emg.values.size(), 9);
  // filled in rows 1 and 7 only
  const bio::Channel& angle = bio::findChannel(r, "elbow_flexion_deg");
  EXPECT_EQ(angle.unit, "deg");
  EXPECT_NEAR(angle.rate, 1000.0 / 6, 1e-9);
  EXPECT_DOUBLE_EQ(angle.startTime, 2.001);
  EXPECT_EQ(angle.values, Eigen::Vector2d(10, 70));
}

TEST_F(Recordings, ToleratesRoundedTimesButNotAMissingRow) {
  // 1481.4815 Hz printed to 0.1 ms: single intervals are off by up to 15 %
  std::string rounded = "time_s,e\n";
  std::string missing = "time_s,e\n";
  for (int i = 0; i < 400; ++i) {
    const std::string time = std::to_string(std::round(i / 1481.4815 * 1e4) / 1e4);
    rounded += time + ",1\n";
    if (i != 350) missing += time + ",1\n";
  }
  EXPECT_NEAR(bio::readRecording(file("rounded.csv", rounded)).channels[0].rate, 1481.4815, 0.3);
  // resampled, and told
  EXPECT_FALSE(bio::readRecording(file("missing.csv", missing)).warnings.empty());
  fails(file("one.csv", "time,e\n0,1\n"), {}, "has 1 rows");
}

TEST_F(Recordings, NamesFileLineAndColumnOfWhatItCannotRead) {
  bio::RecordingLayout layout;
  layout.columns = {column(1, "x", 10, "mV")};
  fails("/no/such/file.txt", layout, "/no/such/file.txt: there is no such file");
  fails(file("empty.txt", ""), layout, "empty.txt: is empty");
  fails(file("blank.txt", "\n \n"), layout, "only empty lines");
  fails(file("word.txt", "1\t2\n3\tx\n"), layout, "word.txt:2: column 2: 'x' is not a number");
  fails(file("nan.txt", "1\t2\nnan\t2\n"), layout, "nan.txt:2: column 1: 'nan'");
  fails(file("comma.txt", "1 2\n1,5 2\n"), layout, "comma.txt:2: column 1: '1,5'");
  fails(file("mixed.txt", "1,5\t2\n1.5\t2\n"), layout,
        "mixed.txt:2: column 1: '1.5' is not a number, must have a decimal comma");
  fails(file("thousands.txt", "1,500\t2\n1,750\t2\n"), layout,
        "'1,500' and all such numbers could have a decimal comma or a comma between thousands");
  EXPECT_EQ(
      bio::readRecording(file("decimal.txt", "1,5;2\n1,25;2\n"), layout).channels[0].values[1],
      1.25);
  fails(file("short.txt", "1\t2\n\t3\n"), layout, "column 1: has 1 values");
  fails(file("ok.txt", "1\t2\n1\t2\n"), {}, "no channel is declared");
  layout.columns = {column(3, "x", 10, "mV")};
  fails(file("two.txt", "1\t2\n3\t4\n"), layout,
        "column 3 is declared, but the file has column 1, column 2");
  layout.columns = {column(1, "x", 0, "mV")};
  fails(file("two.txt", "1\t2\n3\t4\n"), layout, "declared rate 0 Hz");
  layout.columns[0].rate.reset();
  fails(file("two.txt", "1\t2\n3\t4\n"), layout, "has no rate");
  layout.columns = {column(1, "x", 1, "mV"), column(2, "x", 1, "mV")};
  fails(file("two.txt", "1\t2\n3\t4\n"), layout, "two channels are called 'x'");
  layout.columns = {column(1, "x", 1, "mV")};
  layout.columns[0].scale = 0;
  fails(file("two.txt", "1\t2\n3\t4\n"), layout, "scale 0");
}

TEST_F(Recordings, NamesTheLineOfABrokenTrignoHeader) {
  std::string text = trigno;
  bio::RecordingLayout layout;
  layout.format = bio::RecordingFormat::trigno;
  text.replace(text.find("2148.1481 Hz"), 12, "fast");
  fails(file("rate.csv", text), layout, "rate.csv:7: column 3 'bicep EMG 1': rate 'fast'");
  text = trigno;
  text.replace(text.find("EMG 1 (mV)"), 10, "");
  fails(file("name.csv", text), layout, "name.csv:6: column 3");
  fails(file("cut.csv", "Application:, Trigno\n1 Hz\n"), layout, "has 2 lines");
}

TEST(Channels, AreFoundByNameOrTheNamesAreListed) {
  const bio::Recording r{
      "f.csv", bio::RecordingFormat::table, {{"a", "", 1, 0, {}}, {"b", "", 1, 0, {}}}, {}, {}};
  EXPECT_THAT([&] { bio::findChannel(r, "c"); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("f.csv: no channel 'c'; the file has 'a', 'b'")));
}

}  // namespace
