#include <gmock/gmock.h>

#include <algorithm>
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
  refused("100\t100\t3", "0\t100\t3", "a.trc:3: DataRate = 0 Hz, must be > 0");
  refused("100\t100\t3", "fast\t100\t3", "a.trc:3: DataRate = 'fast', must be a number");
  refused("100\t100\t3", "inf\t100\t3", "a.trc:3: DataRate = inf, must be finite");
  refused("Units", "Unit", "a.trc:3: has no Units, must have mm, cm or m");
  refused("mm", "ells", "a.trc:3: Units = 'ells', must be");
  refused("Frame#", "Sample", "a.trc:4: begins with 'Sample' and 'Time', must begin with Frame#");
  refused("Time", "x", "a.trc:4: begins with 'Frame#' and 'x', must begin with Frame# and Time");
  refused("HEAD\t\t\tELBOW", "\tHEAD\t\t",
          "a.trc:4: 1 names of markers for 6 columns of coordinates, must have one above every third");
  refused("\t2000\t", "\tx\t", "a.trc:7: marker 'HEAD', column 4 = 'x', must be a number");
  refused("\t2000\t", "\tinf\t", "a.trc:7: marker 'HEAD', column 4 = inf, must be finite");
  refused("3\t0.52\tnan\tNaN\tNAN", "3", "a.trc:9: row has 1 cells, must have a frame, a time");
  refused("0.52", "0.5149", "a.trc:9: Time = 0.5149 s is 0.51 intervals away from equal spacing");
  refused("0.52", "0.51", "must be at most 0.25");
  refused("\n2\t", "\ntwo\t", "a.trc:8: Frame# = 'two', must be a number");
  refused("\t1000\t", "\t1.000,5\t", "must be a number without thousands separators");
}

// What programs write that do not keep to each other's habits; by the order of the cells all say the
// same.
TEST_F(Trc, ReadsByTheOrderOfCells) {
  const MarkerTrajectories asIs = read(walk);
  const auto same = [&](const std::string& part, const std::string& instead,
                        const std::string& remark) {
    const MarkerTrajectories other = read(with(walk, part, instead));
    EXPECT_EQ(other.names, asIs.names) << instead;
    EXPECT_TRUE((other.positions.array().isNaN() == asIs.positions.array().isNaN()).all());
    EXPECT_TRUE(other.positions.array().isNaN().select(0, other.positions) ==
                asIs.positions.array().isNaN().select(0, asIs.positions))
        << instead;
    EXPECT_NEAR(other.rate, 100, 1e-9) << instead;
    if (remark.empty()) {
      EXPECT_THAT(other.remarks, testing::IsEmpty()) << instead;
    } else {
      EXPECT_THAT(other.remarks, ElementsAre(HasSubstr(remark))) << instead;
    }
  };
  same("PathFileType\t4\t(X/Y/Z)\twalk.trc", "PathFileType   4  (X/Y/Z) walk.trc", "");
  same("Time", "Times", "");
  same("Time\tHEAD\t\t\tELBOW", "Times\t\tHEAD\t\tELBOW", "");
  same("HEAD\t\t\tELBOW\t\t\t", "HEAD\tELBOW", "");
  same("\t\tX1\tY1\tZ1\tX2\tY2\tZ2\r\n", "X1\tY1\tZ1\tX2\tY2\tZ2\r\n", "");
  same("\t\tX1\tY1\tZ1\tX2\tY2\tZ2\r\n\r\n", "", "");
  same("Frame#", "\r\nFrame#", "");
  same("\t4\t5\t6\r", "\t4\t5\t6\t\t\r", "");
  same("DataRate", "datarate", "");
  same("DataRate", "Rate", "");  // CameraRate is there
  same("\t3\t2\t", "\t900\t2\t", "3 frames, NumFrames promises 900: all that are there were read");
  same("\t3\t2\t", "\t3\t7\t", "2 markers, NumMarkers promises 7: all that are there were read");
  same("\t3\t2\t", "\t2.5x\t2\t", "NumFrames = '2.5x' is no count");
  same("NumFrames", "Frames", "");
  same("100\t100\t3", "120\t120\t3", "DataRate = 120 Hz, but the times rise at 100 Hz");
  std::string commas = walk;
  std::replace(commas.begin(), commas.end(), '\t', ',');
  EXPECT_EQ(read(commas).names, asIs.names);
  EXPECT_EQ(read(commas).positions(1, 2), asIs.positions(1, 2));
  EXPECT_THAT(read(with(walk, "ELBOW", "HEAD")).names, ElementsAre("HEAD", "HEAD (2)"));
  EXPECT_THAT(read(with(walk, "HEAD\t", "\t")).names, ElementsAre("marker1", "ELBOW"));
}

TEST_F(Trc, CountsWhatIsMissingAsNotSeen) {
  const MarkerTrajectories half = read(with(walk, "\t2000\t", "\t\t"));
  EXPECT_TRUE(half.positions.row(0).head(3).array().isNaN().all());
  EXPECT_THAT(half.remarks, ElementsAre(HasSubstr("1 positions lack one or two of three")));
  const MarkerTrajectories dropped = read(with(walk, "0.52", "0.54"));
  ASSERT_EQ(dropped.positions.rows(), 5);
  EXPECT_NEAR(dropped.times[3], 0.53, 1e-12);
  EXPECT_TRUE(dropped.positions.row(3).array().isNaN().all());
  EXPECT_THAT(dropped.remarks, ElementsAre(HasSubstr("2 frames are missing between others")));
  const MarkerTrajectories timeless =
      read(with(with(with(walk, "0.50", "0"), "0.51", "0"), "0.52", "0"));
  EXPECT_NEAR(timeless.times[2], 0.02, 1e-12);
  EXPECT_THAT(timeless.remarks, ElementsAre(HasSubstr("taken from DataRate")));
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
