#include <gmock/gmock.h>

#include <cmath>

#include "bio/tables/file_error.h"
#include "bio/tables/marker_trajectories.h"
#include "bio/tables/recording.h"
#include "support/scratch_folder.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Trc : public testing::Test {
 protected:
  MarkerTrajectories read(const std::string& text) const {
    return readMarkers(folder_.file("a.trc", text));
  }
  std::string refusalOf(const std::string& text) const {
    return support::refusalIn<FileError>(folder_.path().string(), [&] { read(text); });
  }
  // The text with one part exchanged.
  static std::string with(std::string text, const std::string& part, const std::string& instead) {
    const auto at = text.find(part);
    EXPECT_NE(at, text.npos) << part;
    return text.replace(at, part.size(), instead);
  }
  support::ScratchFolder folder_;
};

const std::string walk =
    "PathFileType\t4\t(X/Y/Z)\twalk.trc\r\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\r\n"
    "100\t100\t3\t2\tmm\t100\r\n"
    "Frame#\tTime\tHEAD\t\t\tELBOW\t\t\t\r\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\r\n"
    "\r\n"
    "1\t0.50\t1000\t2000\t3000\t4\t5\t6\r\n"
    "2\t0.51\t1001\t2001\t3001\t\t\t\r\n"
    "3\t0.52\tnan\tNaN\tNAN\r\n";

TEST_F(Trc, ReadsMarkersUnitsAndGaps) {
  const MarkerTrajectories markers = read(walk);
  EXPECT_THAT(markers.names, ElementsAre("HEAD", "ELBOW"));
  EXPECT_EQ(markers.rate, 100);
  EXPECT_EQ(markers.times[2], 0.52);
  EXPECT_DOUBLE_EQ(positionsOf(markers, "HEAD")(1, 2), 3.001);
  EXPECT_DOUBLE_EQ(positionsOf(markers, "ELBOW")(0, 1), 0.005);
  EXPECT_EQ(markers.positions.array().isNaN().count(), 9);
  EXPECT_EQ(read(with(walk, "mm", "m")).positions(0, 0), 1000);
  // decimal commas
  EXPECT_DOUBLE_EQ(
      read(with(with(with(walk, "0.50", "0,50"), "0.51", "0,51"), "0.52", "0,52")).times[0], 0.5);
}

TEST_F(Trc, RefusesBrokenFilesInOneLine) {
  const auto refused = [&](const std::string& part, const std::string& instead,
                           const std::string& message) {
    EXPECT_THAT(refusalOf(with(walk, part, instead)), HasSubstr(message)) << instead;
  };
  EXPECT_THAT(refusalOf(""), HasSubstr("ends here, must have five header lines"));
  EXPECT_THAT(refusalOf("PathFileType\n"), HasSubstr("a.trc:1: ends here"));
  EXPECT_THAT(refusalOf(std::string("\xFF\xFEP\0", 4)), HasSubstr("is UTF-16, must be UTF-8"));
  EXPECT_THAT(refusalOf("PathFileType\n" + std::string(5, '\0')), HasSubstr("are no text"));
  refused("PathFileType", "Path", "a.trc:1: is no TRC file, must begin with PathFileType");
  refused("PathFileType\t", "PathFileType,", "a.trc:1: 'PathFileType' is not followed by a tab");
  refused("DataRate", "Rate", "a.trc:3: has no DataRate, must have one");
  refused("100\t100\t3", "0\t100\t3", "a.trc:3: DataRate = 0 Hz, must be > 0");
  refused("100\t100\t3", "fast\t100\t3", "a.trc:3: DataRate = 'fast', must be a number");
  refused("100\t100\t3", "inf\t100\t3", "a.trc:3: DataRate = inf, must be finite");
  refused("NumFrames", "Frames", "a.trc:3: has no NumFrames, must have one");
  refused("NumMarkers", "Markers", "a.trc:3: has no NumMarkers, must have one");
  refused("\t3\t2\t", "\t2.5\t2\t", "a.trc:3: NumFrames = 2.5, must be a whole number ≥ 1");
  refused("\t3\t2\t", "\t3\t0\t", "a.trc:3: NumMarkers = 0, must be a whole number ≥ 1");
  refused("\t3\t2\t", "\t4\t2\t", "3 frames, the header promises 4");
  refused("\t3\t2\t", "\t3\t3\t", "a.trc:4: 2 names of markers, the header promises 3");
  refused("Units", "Unit", "a.trc:3: has no Units, must have mm, cm or m");
  refused("mm", "feet", "a.trc:3: Units = 'feet', must be mm, cm or m");
  refused("Frame#", "Frames", "a.trc:4: begins with 'Frames', must begin with Frame# and Time");
  refused("ELBOW", "HEAD", "a.trc:4: second marker called 'HEAD', names must be unique");
  refused("HEAD\t\t\tELBOW", "HEAD\t\tELBOW\t",
          "a.trc:4: marker 'ELBOW' in column 5, must be above the first of its three columns");
  refused("HEAD\t", "\t", "a.trc:4: no marker in column 3, must have a name");
  refused("\t2000\t", "\tx\t", "a.trc:7: marker 'HEAD' = 'x', must be a number");
  refused("\t2000\t", "\tinf\t", "a.trc:7: marker 'HEAD' = inf, must be finite");
  refused("\t2000\t", "\t\t",
          "a.trc:7: marker 'HEAD' has 2 of 3 coordinates, must have all or none");
  refused("\t6\r", "\t6\t7\r", "a.trc:7: row has 9 cells, must have 8 for 2 markers");
  refused("3\t0.52\tnan\tNaN\tNAN", "3", "a.trc:9: row has 1 cells, must have 8 for 2 markers");
  refused("0.52", "0.55", "a.trc:9: Time = 0.55 s is 3 intervals away from equal spacing");
  refused("0.52", "0.51", "must be at most 0.25");
  refused("\n2\t", "\ntwo\t", "a.trc:8: Frame# = 'two', must be a number");
  refused("\t1000\t", "\t1.000,5\t", "must be a number without thousands separators");
}

TEST_F(Trc, IsARecordingOfItsPoints) {
  const Recording recording = readRecording(folder_.file("a.trc", walk));
  EXPECT_EQ(recording.format, RecordingFormat::trc);
  ASSERT_EQ(recording.channels.size(), 3u);
  EXPECT_THAT(recording.remarks,
              ElementsAre("1 of 2 points were never seen, or once, and were not read: ELBOW."));
  const Channel& head = findChannel(recording, "HEAD.x");
  EXPECT_EQ(head.unit, "m");
  EXPECT_EQ(head.startTime, readTrc(folder_ / "a.trc").times[0]);
}

// Lines that end early cannot ask for more cells than the file's size lets expect.
TEST_F(Trc, AShortFileCannotAskForMuchMemory) {
  std::string text =
      "PathFileType\nDataRate\tNumFrames\tNumMarkers\tUnits\n1\t20000\t20000\tm\n"
      "Frame#\tTime";
  for (int i = 0; i < 20000; ++i) text += "\t" + std::to_string(i) + "\t\t";
  text += "\n\n";
  for (int i = 0; i < 20000; ++i) text += "1\t" + std::to_string(i) + "\n";
  EXPECT_THAT(refusalOf(text), HasSubstr("most cells are missing, must have their separators"));
}

}  // namespace
}  // namespace bio
