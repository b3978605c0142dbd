#include "bio/tables/recorded_file.h"

#include <gmock/gmock.h>

#include "support/scratch_folder.h"
#include "support/throws_saying.h"

namespace bio {
namespace {

using testing::ElementsAre;

TEST(RecordedFile, IsReadByItsName) {
  const support::ScratchFolder folder;
  const std::string file = folder.file("walk.TRC",
                                       "PathFileType\t4\t(X/Y/Z)\twalk.trc\n"
                                       "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n"
                                       "100\t100\t2\t2\tmm\n"
                                       "Frame#\tTime\tELBOW\t\t\tWRIST\t\t\n"
                                       "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
                                       "1\t0\t1\t2\t3\t\t\t\n"
                                       "2\t0.01\t4\t5\t6\t\t\t\n");
  EXPECT_TRUE(isRecordedFile(file));
  const RecordedFile read = readRecordedFile(file);
  ASSERT_TRUE(read.markers);
  EXPECT_THAT(read.markers->names, ElementsAre("ELBOW", "WRIST"));
  EXPECT_THAT(read.channels, testing::IsEmpty());
  EXPECT_THAT(read.remarks, testing::Contains("1 of 2 markers are never seen: WRIST"));
}

TEST(RecordedFile, IsOfAFormatThatItsNameSays) {
  for (const char* name : {"a.c3d", "a.XDF", "a.trc"}) EXPECT_TRUE(isRecordedFile(name)) << name;
  for (const char* name : {"a.sto", "c3d", "a"}) EXPECT_FALSE(isRecordedFile(name)) << name;
  support::throwsSaying([] { readRecordedFile("a.sto"); }, "a.sto: there is no such file");
}

}  // namespace
}  // namespace bio
