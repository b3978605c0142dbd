#include <gmock/gmock.h>

#include <cmath>

#include "bio/tables/file_error.h"
#include "bio/tables/recording.h"
#include "support/scratch_folder.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

class Exports : public testing::Test {
 protected:
  Recording read(const std::string& text) const {
    return readRecording(folder_.file("a.csv", text));
  }
  std::string refusalOf(const std::string& text, RecordingFormat format) const {
    RecordingLayout layout;
    layout.format = format;
    return support::refusalIn<FileError>(
        folder_.path().string(), [&] { readRecording(folder_.file("a.csv", text), layout); });
  }
  static std::string with(std::string text, const std::string& part, const std::string& instead) {
    const auto at = text.find(part);
    EXPECT_NE(at, text.npos) << part;
    return text.replace(at, part.size(), instead);
  }
  support::ScratchFolder folder_;
};

// Made by hand after the layout of the program's exports: two signals of different rates, the
// slower one with one sample less than the last row of the other.
const std::string emgworks =
    "Label: Biceps: EMG 1 Sampling frequency: 2000 Number of points: 5 start: 0 Unit: V Domain "
    "Unit: s\n"
    "Label: Biceps: Acc 1.X Sampling frequency: 1000 Unit: g Domain Unit: s\n"
    "X[s],\"Biceps: EMG 1 [V]\",X[s],\"Biceps: Acc 1.X [g]\"\n"
    "0,0.5,0.1,1\n0.0005,-0.25,0.101,2\n0.001,0.125,0.102,\n0.0015,1,,\n0.002,2,,\n";

TEST_F(Exports, EmgworksGivesEverySignalItsTimes) {
  const Recording r = read(emgworks);
  EXPECT_EQ(r.format, RecordingFormat::emgworks);
  ASSERT_EQ(r.channels.size(), 2u);
  const Channel& emg = findChannel(r, "Biceps: EMG 1");
  EXPECT_EQ(emg.unit, "V");
  EXPECT_EQ(emg.rate, 2000);
  EXPECT_EQ(emg.startTime, 0);
  ASSERT_EQ(emg.values.size(), 5);
  EXPECT_EQ(emg.values[1], -0.25);
  const Channel& acc = findChannel(r, "Biceps: Acc 1.X");
  EXPECT_EQ(acc.unit, "g");
  EXPECT_EQ(acc.rate, 1000);
  EXPECT_EQ(acc.startTime, 0.1);
  EXPECT_EQ(acc.values, Eigen::Vector2d(1, 2));
  // decimal commas between semicolons
  std::string german = emgworks.substr(emgworks.find("X[s]"));
  for (char& c : german) c = c == ',' ? ';' : c == '.' ? ',' : c;
  german = with(german, "Acc 1,X", "Acc 1.X");
  EXPECT_EQ(findChannel(read(german), "Biceps: EMG 1").values[1], -0.25);
}

TEST_F(Exports, EmgworksTimesMayBeMilliseconds) {
  const Recording seconds = read(emgworks);
  std::string text;
  for (std::size_t at = 0; at < emgworks.size(); ++at) {
    const bool isUnit = emgworks.compare(at, 4, "X[s]") == 0;
    text += isUnit ? "X[ms]" : emgworks.substr(at, 1);
    if (isUnit) at += 3;
  }
  const Recording milliseconds = read(text);
  for (std::size_t k = 0; k < seconds.channels.size(); ++k) {
    EXPECT_NEAR(milliseconds.channels[k].rate, 1000 * seconds.channels[k].rate,
                1e-9 * milliseconds.channels[k].rate);
    EXPECT_NEAR(milliseconds.channels[k].startTime, seconds.channels[k].startTime / 1000, 1e-12);
  }
}

TEST_F(Exports, BrokenEmgworksFilesAreToldInOneLine) {
  const auto refused = [&](const std::string& part, const std::string& instead,
                           const std::string& message) {
    EXPECT_THAT(refusalOf(with(emgworks, part, instead), RecordingFormat::emgworks),
                HasSubstr(message));
  };
  refused("X[s],\"Biceps: EMG 1 [V]\",X[s]", "t,EMG,t", "has no line of names, an EMGworks export");
  refused("0.0005,-0.25", "0.0005,x",
          "a.csv:5: column 2 'Biceps: EMG 1 [V]': 'x' must be a number");
  refused("0.0005,", ",", "a.csv:5: column 2 'Biceps: EMG 1 [V]': has a value but no time");
  refused("0.0005,-0.25,0.101", "0.0005,-0.25,",
          "a.csv:5: column 4 'Biceps: Acc 1.X [g]': has a value but no time");
  refused("0.002,2,,", "0.002,2,,,7", "a.csv:8: has 5 cells, must have at most 4");
  refused("0.002,2", "0.002,inf", "must be finite");
  EXPECT_THAT(refusalOf(emgworks.substr(0, emgworks.find("\n0,")), RecordingFormat::emgworks),
              HasSubstr("ends with its names, must hold rows"));
  for (const char* rows : {"\n\n\n", "\n  \n,,,\n", "\n,,,\r\n,,\r\n"}) {
    EXPECT_THAT(
        refusalOf(emgworks.substr(0, emgworks.find("\n0,")) + rows, RecordingFormat::emgworks),
        HasSubstr("ends with its names, must hold rows"));
  }
}

// Made by hand after the layout of the program's exports.
const std::string noraxon =
    "\"Type\",\"Noraxon MR3\"\n\"Name\",\"Curls\"\n\n"
    "\"Time,s\",\"Activity\",\"Marker\",\"BICEPS BR. RT, \xC2\xB5V\",\"Ultium EMG.Sync, "
    "On\",\"Knee (deg)\"\n"
    "0.0000,Curls,,1.5,0,10\n0.0005,Curls,,-2.5,0,\n0.0010,Curls,start,3,1,11\n"
    "0.0015,Curls,,4,1,\n";

TEST_F(Exports, NoraxonColumnsHaveUnitsBehindACommaAndTextsAreLeftOut) {
  const Recording r = read(noraxon);
  EXPECT_EQ(r.format, RecordingFormat::noraxon);
  ASSERT_EQ(r.channels.size(), 3u);
  const Channel& emg = findChannel(r, "BICEPS BR. RT");
  EXPECT_EQ(emg.unit, "uV");
  EXPECT_EQ(emg.rate, 2000);
  EXPECT_EQ(emg.values, Eigen::Vector4d(1.5, -2.5, 3, 4));
  EXPECT_EQ(findChannel(r, "Knee").rate, 1000);
  EXPECT_EQ(findChannel(r, "Knee").unit, "deg");
  EXPECT_THAT(r.remarks, ElementsAre("Column 'Activity' holds texts and was not read.",
                                     "Column 'Marker' holds texts and was not read."));
  // tabs, decimal commas, milliseconds
  const std::string other = "Time,ms\tVMO RT, uV\tAngle\n0\t1,5\t1\n0,5\t2,25\t2\n1\t3\t3,5\n";
  const Recording tabs = read(other);
  EXPECT_EQ(tabs.format, RecordingFormat::noraxon);
  EXPECT_EQ(findChannel(tabs, "VMO RT").values[1], 2.25);
  EXPECT_EQ(findChannel(tabs, "VMO RT").rate, 2000);
  EXPECT_EQ(findChannel(tabs, "Angle").values[2], 3.5);
}

TEST_F(Exports, BrokenNoraxonFilesAreToldInOneLine) {
  const auto refused = [&](const std::string& part, const std::string& instead,
                           const std::string& message) {
    EXPECT_THAT(refusalOf(with(noraxon, part, instead), RecordingFormat::noraxon),
                HasSubstr(message));
  };
  refused("\"Time,s\"", "\"t\"", "has no line of names, a Noraxon export has a time");
  refused("1.5,0,10", "x,0,10",
          "a.csv:5: column 4 'BICEPS BR. RT, \xC2\xB5V': 'x' must be a number");
  refused("\n0.0010,", "\n,", "a.csv:7: column 1 'Time,s': is empty, must be in every row");
  refused("\n0.0010,", "\n0.0017,", "must rise strictly");
  refused(",4,1,\n", ",4,1,,8\n", "a.csv:8: has 7 cells, must have at most 6");
  refused(",4,1,", ",nan,1,", "must be");
}

// What other readers take stays theirs.
TEST_F(Exports, OtherTablesAreNotTakenForExports) {
  EXPECT_EQ(read("X[s],biceps [mV]\n0,1\n0.5,2\n").format, RecordingFormat::table);
  EXPECT_EQ(read("time,biceps_uV\n0,1\n0.5,2\n").format, RecordingFormat::table);
  EXPECT_EQ(read("Time,s;biceps_uV\n0;1\n0,5;2\n").format, RecordingFormat::table);
}

}  // namespace
}  // namespace bio
